// Conics against worked examples of textbooks, and against each other.
#include <cmath>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <dspace/Error.h>
#include <dspace/trajectories/Orbit.h>

namespace dspace {
namespace {

constexpr double Vallado = 398600.4418e9; // [m^3/s^2]
constexpr double Curtis = 398600e9;

// D. Vallado, "Fundamentals of Astrodynamics and Applications", 4th ed., example 2-5.
TEST(Orbit, ElementsOfVallado25) {
  const OrbitalElements e = ElementsOf(
      {{6524834.0, 6862875.0, 6448296.0}, {4901.327, 5533.756, -1976.341}}, Vallado, "test");
  EXPECT_NEAR(e.semiLatusRectum, 11067.790e3, 10.0);
  EXPECT_NEAR(e.SemiMajorAxis(), 36127.343e3, 100.0);
  EXPECT_NEAR(e.eccentricity, 0.832853, 1e-6);
  EXPECT_NEAR(e.inclination_deg, 87.870, 1e-3);
  EXPECT_NEAR(e.ascendingNode_deg, 227.898, 1e-3);
  EXPECT_NEAR(e.periapsisArgument_deg, 53.38, 6e-3);
  EXPECT_NEAR(e.trueAnomaly_deg, 92.335, 1e-3);
}

// Example 2-6, the way back.
TEST(Orbit, StateOfVallado26) {
  const State s = StateOf({Vallado, 11067.790e3, 0.83285, 87.87, 227.89, 53.38, 92.335}, "test");
  EXPECT_LT((s.position - Eigen::Vector3d(6525344.0, 6861535.0, 6449125.0)).norm(), 100.0)
      << s.position.transpose();
  EXPECT_LT((s.velocity - Eigen::Vector3d(4902.276, 5533.124, -1975.709)).norm(), 0.1)
      << s.velocity.transpose();
}

// H. Curtis, "Orbital Mechanics for Engineering Students", example 4.3.
TEST(Orbit, ElementsOfCurtis43) {
  const OrbitalElements e =
      ElementsOf({{-6045e3, -3490e3, 2500e3}, {-3457.0, 6618.0, 2533.0}}, Curtis, "test");
  EXPECT_NEAR(std::sqrt(e.semiLatusRectum * Curtis), 58311.7e6, 0.1e6);
  EXPECT_NEAR(e.inclination_deg, 153.249, 1e-3);
  EXPECT_NEAR(e.ascendingNode_deg, 255.279, 1e-3);
  EXPECT_NEAR(e.eccentricity, 0.171212, 1e-6);
  EXPECT_NEAR(e.periapsisArgument_deg, 20.0683, 1e-4);
  EXPECT_NEAR(e.trueAnomaly_deg, 28.4456, 1e-4);
  EXPECT_NEAR(e.SemiMajorAxis(), 8788.1e3, 0.1e3);
}

// Vallado, example 2-4: 40 minutes on an ellipse.
TEST(Orbit, PropagatesVallado24) {
  const State s = Propagate({{1131340.0, -2282343.0, 6672423.0}, {-5643.05, 4303.33, 2428.79}},
                            Vallado, 2400.0, "test");
  EXPECT_LT((s.position - Eigen::Vector3d(-4219752.7, 4363029.2, -3958766.6)).norm(), 1.0)
      << s.position.transpose();
  EXPECT_LT((s.velocity - Eigen::Vector3d(3689.866, -1916.735, -6112.511)).norm(), 1e-3)
      << s.velocity.transpose();
}

// Curtis, example 3.7: an hour on a hyperbola.
TEST(Orbit, PropagatesCurtis37) {
  const State s =
      Propagate({{7000e3, -12124e3, 0.0}, {2667.9, 4621.0, 0.0}}, Curtis, 3600.0, "test");
  EXPECT_LT((s.position - Eigen::Vector3d(-3297.8e3, 7413.4e3, 0.0)).norm(), 100.0)
      << s.position.transpose();
  EXPECT_LT((s.velocity - Eigen::Vector3d(-8297.6, -964.05, 0.0)).norm(), 0.1)
      << s.velocity.transpose();
}

// Six hours from the perigee of a parabola, by Barker's equation in closed form.
TEST(Orbit, PropagatesAParabola) {
  const double perigee = 2.0 * Curtis / 1e8;
  const State s = Propagate({{perigee, 0.0, 0.0}, {0.0, 10e3, 0.0}}, Curtis, 6.0 * 3600.0, "test");
  // Barker's equation, closed: M = tan(v/2)/2 + tan^3(v/2)/6.
  const double m = Curtis * Curtis * 21600.0 / std::pow(perigee * 10e3, 3);
  const double w = std::cbrt(3.0 * m + std::sqrt(9.0 * m * m + 1.0));
  const double v = 2.0 * std::atan(w - 1.0 / w);
  EXPECT_NEAR(std::atan2(s.position.y(), s.position.x()), v, 1e-9);
  EXPECT_EQ(ElementsOf(s, Curtis, "test").eccentricity, 1.0);
  EXPECT_TRUE(std::isinf(ElementsOf(s, Curtis, "test").SemiMajorAxis()));
}

// Curtis, example 3.5: a hyperbola with 15 km/s at 300 km height.
TEST(Orbit, HyperbolaOfCurtis35) {
  const double perigee = (6378.0 + 300.0) * 1e3;
  const State at{{perigee, 0.0, 0.0}, {0.0, 15e3, 0.0}};
  OrbitalElements e = ElementsOf(at, Curtis, "test");
  e.trueAnomaly_deg = 100.0;
  EXPECT_NEAR(StateOf(e, "test").position.norm(), 48497e3, 1e3);
  const State first = Propagate(at, Curtis, 4141.4, "test");
  EXPECT_NEAR(std::atan2(first.position.y(), first.position.x()) * 180.0 / M_PI, 100.0, 1e-3);
  const State later = Propagate(at, Curtis, 4141.4 + 3 * 3600.0, "test");
  EXPECT_NEAR(later.position.norm(), 163180e3, 10e3);
  EXPECT_NEAR(later.velocity.norm(), 10510.0, 5.0);
}

// Kepler's equations of ellipse and hyperbola judge the propagation: the mean anomaly grows evenly.
TEST(Orbit, MeanAnomalyGrowsEvenly) {
  for (const double eccentricity : {0.0, 1e-9, 0.3, 0.95, 0.999999, 1.000001, 1.2, 8.0}) {
    OrbitalElements e{Vallado, 1.3e7, eccentricity, 40.0, 70.0, 110.0, 20.0};
    const State start = StateOf(e, "test");
    const double a = std::abs(e.SemiMajorAxis());
    const double rate = std::sqrt(Vallado / (a * a * a)) * 180.0 / M_PI; // [deg/s]
    for (const double dt : {-86400.0, -600.0, 1e-3, 900.0, 30000.0, 3e6}) {
      const State after = Propagate(start, Vallado, dt, "test");
      const OrbitalElements then = ElementsOf(after, Vallado, "test");
      if (eccentricity > 1e-8) {
        const double grown = then.MeanAnomaly_deg() - e.MeanAnomaly_deg() - rate * dt;
        const double error = eccentricity < 1.0 ? std::remainder(grown, 360.0) : grown;
        // Near e = 1 the mean anomaly itself is ill-determined: only its size counts.
        const double scale = std::max(1.0, std::abs(rate * dt));
        EXPECT_LT(std::abs(error), 3e-7 * scale) << eccentricity << " " << dt;
      }
      // Energy and angular momentum stay.
      EXPECT_NEAR(then.semiLatusRectum / e.semiLatusRectum, 1.0, 1e-9) << eccentricity << " " << dt;
      EXPECT_NEAR(then.eccentricity, eccentricity, 1e-8) << eccentricity << " " << dt;
      // And back.
      const State back = Propagate(after, Vallado, -dt, "test");
      EXPECT_LT((back.position - start.position).norm(), 2.0) << eccentricity << " " << dt;
    }
  }
}

TEST(Orbit, ElementsGoBackToTheirStateInEveryPlane) {
  for (const double eccentricity : {0.0, 0.4, 1.0, 2.5}) {
    for (const double inclination : {0.0, 30.0, 90.0, 150.0, 180.0}) {
      for (const double anomaly : {-80.0, 0.0, 15.0, 100.0}) {
        const State s =
            StateOf({Vallado, 2e7, eccentricity, inclination, 200.0, 300.0, anomaly}, "test");
        const State again = StateOf(ElementsOf(s, Vallado, "test"), "test");
        EXPECT_LT((again.position - s.position).norm(), 1e-4);
        EXPECT_LT((again.velocity - s.velocity).norm(), 1e-7);
      }
    }
  }
}

TEST(Orbit, PointsLieOnTheConic) {
  const OrbitalElements ellipse{Vallado, 1e7, 0.6, 30.0, 20.0, 10.0, 77.0};
  const auto closed = OrbitPoints(ellipse, 181, 0.0, "test");
  EXPECT_EQ(closed.front(), closed.back());
  EXPECT_NEAR(closed[90].norm(), ellipse.PeriapsisRadius(), 1e-3);
  EXPECT_NEAR(closed[0].norm(), ellipse.ApoapsisRadius(), 1e-3);
  const OrbitalElements hyperbola{Vallado, 1e7, 1.6, 30.0, 20.0, 10.0, 0.0};
  const auto open = OrbitPoints(hyperbola, 101, 1e8, "test");
  EXPECT_NEAR(open.front().norm(), 1e8, 1.0);
  EXPECT_NEAR(open.back().norm(), 1e8, 1.0);
  EXPECT_NEAR(open[50].norm(), hyperbola.PeriapsisRadius(), 1e-3);
  EXPECT_THROW(OrbitPoints(hyperbola, 101, 1e6, "test"), Error);
}

TEST(Orbit, RejectsWhatIsNoOrbit) {
  EXPECT_THROW(ElementsOf({{7e6, 0, 0}, {1e3, 0, 0}}, Vallado, "test"), Error); // falls straight
  EXPECT_THROW(ElementsOf({{0, 0, 0}, {1e3, 0, 0}}, Vallado, "test"), Error);
  EXPECT_THROW(ElementsOf({{7e6, 0, 0}, {0, 7e3, 0}}, 0.0, "test"), Error);
  EXPECT_THROW(ElementsOf({{7e6, 0, 0}, {0, NAN, 0}}, Vallado, "test"), Error);
  EXPECT_THROW(StateOf({Vallado, 1e7, -0.1, 0, 0, 0, 0}, "test"), Error);
  EXPECT_THROW(StateOf({Vallado, 1e7, 2.0, 0, 0, 0, 150.0}, "test"), Error); // beyond the asymptote
  EXPECT_THROW(StateOf({Vallado, 1e7, 0.2, 181.0, 0, 0, 0}, "test"), Error);
}

// A state without a plane still moves: straight up, by the energy.
TEST(Orbit, FallsStraight) {
  const State s = Propagate({{7e6, 0, 0}, {5e3, 0, 0}}, Vallado, 300.0, "test");
  const double energy = 0.5 * 25e6 - Vallado / 7e6;
  EXPECT_NEAR(0.5 * s.velocity.squaredNorm() - Vallado / s.position.norm(), energy, 1e-3);
  EXPECT_EQ(s.position.y(), 0.0);
}

} // namespace
} // namespace dspace
