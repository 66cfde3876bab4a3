// Frames that move with trajectories, attitudes, and the sampling of paths.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/trajectories/Attitude.h>
#include <dspace/trajectories/MovingFrame.h>
#include <dspace/trajectories/Orbit.h>
#include <dspace/trajectories/PathSampling.h>

namespace dspace {
namespace {

constexpr double Earth = 398600.4418e9;
using Vector = Eigen::Vector3d;

TrajectoryPtr OrbitOf(double p, double e, double inclination, double anomaly) {
  return std::make_shared<Conic>(
      "craft", StateOf({Earth, p, e, inclination, 20.0, 30.0, anomaly}, "craft"), 0.0, Earth);
}

// The velocity in a moving frame is the derivative of the position there.
void ExpectVelocityIsTheDerivative(const Trajectory& path, double t, double tolerance) {
  const double h = 0.5;
  const Vector slope = (path.At(t + h).position - path.At(t - h).position) / (2.0 * h);
  EXPECT_LT((path.At(t).velocity - slope).norm(), tolerance) << slope.transpose();
}

TEST(MovingFrame, TheTwoBodiesOfARotatingFrameStandStill) {
  const TrajectoryPtr moon = OrbitOf(3.8e8, 0.055, 23.0, 40.0);
  const auto frame = std::make_shared<TwoBodyFrame>("frame", nullptr, moon, 0.0);
  const RelativeTrajectory seen(moon, frame);
  for (const double t : {0.0, 1e5, 2e6}) {
    const State s = seen.At(t);
    EXPECT_NEAR(s.position.x(), moon->At(t).position.norm(), 1e-6);
    EXPECT_LT(std::hypot(s.position.y(), s.position.z()), 1e-6);
    EXPECT_LT(std::hypot(s.velocity.y(), s.velocity.z()), 1e-9); // only along the line
    EXPECT_NEAR(s.velocity.x(), moon->At(t).position.normalized().dot(moon->At(t).velocity), 1e-9);
  }
  const RelativeTrajectory craft(OrbitOf(9e7, 0.4, 60.0, 10.0), frame);
  ExpectVelocityIsTheDerivative(craft, 5e4, 1e-5);
  // The barycentre is on the line.
  const TwoBodyFrame barycentric("frame", nullptr, moon, 0.01215);
  EXPECT_LT((barycentric.At(0.0).position - 0.01215 * moon->At(0.0).position).norm(), 1e-6);
}

// A frame whose plane turns: the second body is pushed out of the plane.
class Tilting : public Trajectory {
public:
  TimeSpan Span() const override { return {-1e9, 1e9}; }
  State At(double t) const override {
    const double w = 1e-3;
    const double tilt = 2e-4;
    const Eigen::AngleAxisd turn(tilt * t, Vector::UnitX());
    const Vector p(7e6 * std::cos(w * t), 7e6 * std::sin(w * t), 0.0);
    const Vector v(-7e6 * w * std::sin(w * t), 7e6 * w * std::cos(w * t), 0.0);
    const Vector turned = turn * p;
    return {turned, turn * v + Vector(tilt, 0, 0).cross(turned)};
  }
};

TEST(MovingFrame, VelocitiesKnowThatThePlaneTurns) {
  const auto frame =
      std::make_shared<TwoBodyFrame>("frame", nullptr, std::make_shared<Tilting>(), 0.0);
  const RelativeTrajectory craft(OrbitOf(2e7, 0.2, 60.0, 10.0), frame);
  for (const double t : {0.0, 1000.0, 2500.0}) {
    ExpectVelocityIsTheDerivative(craft, t, 0.02); // of 20 km/s
  }
}

TEST(MovingFrame, AxesOfTheLocalVertical) {
  const TrajectoryPtr craft = OrbitOf(7e6, 0.1, 50.0, 70.0);
  const State s = craft->At(100.0);
  const Vector up = s.position.normalized();
  const Vector normal = s.position.cross(s.velocity).normalized();
  using Axes = LocalFrame::Axes;
  const Eigen::Matrix3d lvlh = LocalFrame("f", craft, Axes::Lvlh).At(100.0).rotation;
  EXPECT_LT((lvlh.col(2) + up).norm(), 1e-12);
  EXPECT_LT((lvlh.col(1) + normal).norm(), 1e-12);
  EXPECT_GT(lvlh.col(0).dot(s.velocity), 0.0);
  const Eigen::Matrix3d rtn = LocalFrame("f", craft, Axes::Rtn).At(100.0).rotation;
  EXPECT_LT((rtn.col(0) - up).norm(), 1e-12);
  EXPECT_LT((rtn.col(2) - normal).norm(), 1e-12);
  const Eigen::Matrix3d velocity = LocalFrame("f", craft, Axes::Velocity).At(100.0).rotation;
  EXPECT_LT((velocity.col(0) - s.velocity.normalized()).norm(), 1e-12);
  EXPECT_LT(velocity.col(1).dot(up), 0.0);
  for (const Eigen::Matrix3d& axes : {lvlh, rtn, velocity}) {
    EXPECT_NEAR(axes.determinant(), 1.0, 1e-12);
  }
}

// Hill's equations: a craft ahead on the same circle stands still for the one behind it.
TEST(MovingFrame, AFollowerOnACircleStandsStill) {
  const auto chief = std::make_shared<Conic>(
      "chief", StateOf({Earth, 7e6, 0.0, 50.0, 20.0, 0.0, 0.0}, "c"), 0.0, Earth);
  const auto ahead = std::make_shared<Conic>(
      "ahead", StateOf({Earth, 7e6, 0.0, 50.0, 20.0, 0.0, 0.01}, "c"), 0.0, Earth);
  const RelativeTrajectory seen(ahead,
                                std::make_shared<LocalFrame>("f", chief, LocalFrame::Axes::Lvlh));
  const double angle = 0.01 * M_PI / 180.0;
  for (const double t : {0.0, 1000.0, 4000.0}) {
    EXPECT_LT(
        (seen.At(t).position - Vector(7e6 * std::sin(angle), 0.0, 7e6 * (1.0 - std::cos(angle))))
            .norm(),
        1e-3);
    EXPECT_LT(seen.At(t).velocity.norm(), 1e-5);
  }
}

TEST(MovingFrame, APointOfATurningBodyStandsStill) {
  const double rate = 7.2921159e-5;
  const auto turn = [rate](double t) {
    return Eigen::AngleAxisd(0.3 + rate * t, Vector::UnitZ()).toRotationMatrix();
  };
  const auto frame = std::make_shared<TurningFrame>("earth", nullptr, turn, TimeSpan{-1e9, 1e9});
  const Vector site(6378137.0, 0.0, 0.0);
  const Vector p = turn(5000.0) * site;
  const State s = frame->At(5000.0).FromReference({p, Vector(0, 0, rate).cross(p)});
  EXPECT_LT((s.position - site).norm(), 1e-8);
  EXPECT_LT(s.velocity.norm(), 1e-6);
  // Outside of the span of the rotation.
  const TurningFrame known("earth", nullptr, turn, TimeSpan{0.0, 10.0});
  EXPECT_THROW(known.At(11.0), Error);
}

TEST(Attitude, ARulePointsItsAxes) {
  const TrajectoryPtr craft = OrbitOf(7e6, 0.1, 50.0, 70.0);
  const State s = craft->At(100.0);
  PointingRule rule;
  rule.axis = {0, 0, 2};
  rule.secondaryAxis = {1, 0, 1};
  const RuleAttitude nadir("craft", craft, rule);
  const Eigen::Quaterniond q = nadir.At(100.0);
  EXPECT_LT((q * Vector::UnitZ() + s.position.normalized()).norm(), 1e-12);
  // The secondary axis is in the plane of nadir and velocity, on its side.
  const Vector normal = s.position.cross(s.velocity).normalized();
  EXPECT_LT(std::abs((q * Vector(1, 0, 1)).dot(normal)), 1e-12);
  EXPECT_GT((q * Vector(1, 0, 0)).dot(s.velocity), 0.0);
  rule.direction = PointingRule::Direction::Sun;
  rule.secondaryDirection = PointingRule::Direction::OrbitNormal;
  const Vector sun(1.0, 2.0, -0.5);
  const RuleAttitude solar("craft", craft, rule, [&](double, const Vector&) { return sun; });
  EXPECT_LT((solar.At(0.0) * Vector::UnitZ() - sun.normalized()).norm(), 1e-12);
  EXPECT_THROW(RuleAttitude("craft", craft, rule), Error); // no Sun
  rule.secondaryAxis = {0, 0, -1};
  EXPECT_THROW(RuleAttitude("craft", craft, rule, [&](double, const Vector&) { return sun; }),
               Error);
}

TEST(Attitude, ATableTurnsAtConstantRate) {
  const Eigen::Quaterniond a(Eigen::AngleAxisd(0.2, Vector::UnitX()));
  const Eigen::Quaterniond b(Eigen::AngleAxisd(1.2, Vector::UnitX()));
  // The second is written with the other sign: the same attitude.
  const TableAttitude table("craft", {0.0, 10.0}, {a, Eigen::Quaterniond(-b.coeffs())});
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(0.5, Vector::UnitX()));
  EXPECT_LT(table.At(3.0).angularDistance(expected), 1e-12);
  EXPECT_LT(table.At(10.0).angularDistance(b), 1e-12);
  EXPECT_THROW(table.At(10.1), Error);
  EXPECT_THROW(TableAttitude("craft", {0.0}, {Eigen::Quaterniond(1.0, 0.1, 0.0, 0.0)}), Error);
  EXPECT_THROW(TableAttitude("craft", {1.0, 1.0}, {a, b}), Error);
  const auto craft = OrbitOf(7e6, 0.0, 0.0, 0.0);
  const CraftFrame frame(craft,
                         std::make_shared<TableAttitude>("c", std::vector<double>{0.0, 10.0},
                                                         std::vector<Eigen::Quaterniond>{a, b}));
  EXPECT_LT((frame.At(5.0).angularVelocity - Vector(0.1, 0, 0)).norm(), 1e-9);
}

TEST(PathSampling, ChordsStayNearThePath) {
  const TrajectoryPtr craft = OrbitOf(1e7, 0.7, 50.0, 180.0);
  const double period = ElementsOf(craft->At(0.0), Earth, "c").Period();
  PathSampling by;
  const std::vector<double> times = SampleTimes(*craft, {0.0, period}, by, "craft");
  EXPECT_EQ(times.front(), 0.0);
  EXPECT_EQ(times.back(), period);
  EXPECT_LT(times.size(), 400u);
  for (std::size_t i = 1; i < times.size(); ++i) {
    ASSERT_GT(times[i], times[i - 1]);
    const Vector a = craft->At(times[i - 1]).position;
    const Vector b = craft->At(times[i]).position;
    for (double share = 0.1; share < 1.0; share += 0.1) {
      const Vector p = craft->At(times[i - 1] + share * (times[i] - times[i - 1])).position;
      const double away = (p - a).cross((b - a).normalized()).norm();
      EXPECT_LT(away, 1.05 * by.flatness * (b - a).norm());
    }
  }
  by.most = 100;
  EXPECT_EQ(SampleTimes(*craft, {0.0, period}, by, "craft").size(), 100u);
  EXPECT_THROW(SampleTimes(*craft, {0.0, 0.0}, by, "craft"), Error);
  EXPECT_THROW(SampleTimes(*craft, {0.0, INFINITY}, by, "craft"), Error);
}

} // namespace
} // namespace dspace
