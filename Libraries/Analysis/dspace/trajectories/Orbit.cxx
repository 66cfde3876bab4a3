#include <dspace/trajectories/Orbit.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;
constexpr double Infinity = std::numeric_limits<double>::infinity();
// What rounding leaves of an eccentricity or of the sine of an inclination that is 0, or of 1 - e.
constexpr double Rounding = 1e-11;

double Wrapped(double degrees) {
  const double turn = std::fmod(degrees, 360.0);
  return turn < 0.0 ? turn + 360.0 : turn;
}

// The angle from a to b [deg] about the unit vector n.
double AngleAbout(const Eigen::Vector3d& n, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return Wrapped(std::atan2(n.dot(a.cross(b)), a.dot(b)) / Degree);
}

void CheckState(const State& state, double mu, const std::string& object) {
  Require(mu > 0.0 && std::isfinite(mu), object, "GM of the centre", mu,
          "a positive number [m^3/s^2]");
  RequirePosition(object, "the position", state.position);
  RequireFinite(object, "the velocity", state.velocity);
  Require(state.position.norm() > 0.0, object, "the distance from the centre", 0.0,
          "a positive number [m]");
}

// Stumpff's functions c2 and c3.
std::pair<double, double> Stumpff(double psi) {
  if (std::abs(psi) < 0.1) { // the closed forms would lose digits
    double c2 = 0.0;
    double c3 = 0.0;
    double term2 = 0.5;
    double term3 = 1.0 / 6.0;
    for (int k = 0; k < 12; ++k) {
      c2 += term2;
      c3 += term3;
      term2 *= -psi / ((2 * k + 3) * (2 * k + 4));
      term3 *= -psi / ((2 * k + 4) * (2 * k + 5));
    }
    return {c2, c3};
  }
  const double s = std::sqrt(std::abs(psi));
  if (psi > 0.0) {
    const double half = std::sin(0.5 * s);
    return {2.0 * half * half / psi, (s - std::sin(s)) / (psi * s)};
  }
  const double half = std::sinh(0.5 * s);
  return {2.0 * half * half / -psi, (std::sinh(s) - s) / (-psi * s)};
}

// Kepler's equation in the universal variable, and the radius, which is its derivative.
struct Universal {
  double r0, rv, alpha, mu;
  double time = 0.0;
  double radius = 0.0;
  double c2 = 0.0, c3 = 0.0;
  void At(double chi) {
    const double psi = chi * chi * this->alpha;
    std::tie(this->c2, this->c3) = Stumpff(psi);
    const double root = std::sqrt(this->mu);
    this->time = (chi * chi * chi * this->c3 + this->rv / root * chi * chi * this->c2 +
                  this->r0 * chi * (1.0 - psi * this->c3)) /
                 root;
    this->radius = chi * chi * this->c2 + this->rv / root * chi * (1.0 - psi * this->c3) +
                   this->r0 * (1.0 - psi * this->c2);
  }
};

} // namespace

double OrbitalElements::SemiMajorAxis() const {
  return this->eccentricity == 1.0
             ? Infinity
             : this->semiLatusRectum / ((1.0 - this->eccentricity) * (1.0 + this->eccentricity));
}

double OrbitalElements::PeriapsisRadius() const {
  return this->semiLatusRectum / (1.0 + this->eccentricity);
}

double OrbitalElements::ApoapsisRadius() const {
  return this->eccentricity < 1.0 ? this->semiLatusRectum / (1.0 - this->eccentricity) : Infinity;
}

double OrbitalElements::Period() const {
  if (this->eccentricity >= 1.0) {
    return Infinity;
  }
  const double a = this->SemiMajorAxis();
  return 2.0 * M_PI * a * std::sqrt(a / this->mu);
}

double OrbitalElements::MeanAnomaly_deg() const {
  const double e = this->eccentricity;
  const double half = std::tan(0.5 * this->trueAnomaly_deg * Degree);
  if (e < 1.0) {
    const double E = 2.0 * std::atan(std::sqrt((1.0 - e) / (1.0 + e)) * half);
    return Wrapped((E - e * std::sin(E)) / Degree);
  }
  if (e > 1.0) {
    const double F = 2.0 * std::atanh(std::sqrt((e - 1.0) / (e + 1.0)) * half);
    return (e * std::sinh(F) - F) / Degree;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

OrbitalElements ElementsOf(const State& state, double mu, const std::string& object) {
  CheckState(state, mu, object);
  const Eigen::Vector3d& r = state.position;
  const Eigen::Vector3d& v = state.velocity;
  const double distance = r.norm();
  const Eigen::Vector3d h = r.cross(v);
  if (h.norm() <= Rounding * distance * v.norm()) {
    Reject(object, "its velocity " + VectorText(v) +
                       " m/s is along its position; accepted: states "
                       "with an angular momentum, since others have no orbital plane");
  }
  const Eigen::Vector3d n = h.normalized();
  OrbitalElements elements;
  elements.mu = mu;
  elements.semiLatusRectum = h.squaredNorm() / mu;
  Eigen::Vector3d toPeriapsis = v.cross(h) / mu - r / distance; // of length e
  elements.eccentricity = toPeriapsis.norm();
  const bool circle = elements.eccentricity < Rounding;
  if (circle) {
    elements.eccentricity = 0.0;
  }
  if (std::abs(elements.eccentricity - 1.0) < Rounding) {
    elements.eccentricity = 1.0;
  }
  elements.inclination_deg = std::atan2(std::hypot(n.x(), n.y()), n.z()) / Degree;
  Eigen::Vector3d node(-n.y(), n.x(), 0.0);
  if (node.norm() < Rounding) {
    node = Eigen::Vector3d::UnitX();
    elements.inclination_deg = n.z() > 0.0 ? 0.0 : 180.0;
  } else {
    node.normalize();
    elements.ascendingNode_deg =
        AngleAbout(Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), node);
  }
  if (circle) {
    toPeriapsis = node;
  } else {
    elements.periapsisArgument_deg = AngleAbout(n, node, toPeriapsis);
  }
  elements.trueAnomaly_deg = AngleAbout(n, toPeriapsis, r);
  if (elements.eccentricity >= 1.0 && elements.trueAnomaly_deg > 180.0) {
    elements.trueAnomaly_deg -= 360.0;
  }
  return elements;
}

State StateOf(const OrbitalElements& elements, const std::string& object) {
  const double e = elements.eccentricity;
  const double p = elements.semiLatusRectum;
  Require(elements.mu > 0.0 && std::isfinite(elements.mu), object, "GM of the centre", elements.mu,
          "a positive number [m^3/s^2]");
  Require(p > 0.0 && std::isfinite(p), object, "the semi-latus rectum", p, "a positive number [m]");
  Require(e >= 0.0 && std::isfinite(e), object, "the eccentricity", e, "0 and more");
  Require(elements.inclination_deg >= 0.0 && elements.inclination_deg <= 180.0, object,
          "the inclination", elements.inclination_deg, "0 to 180 degrees");
  RequireFinite(object, "the ascending node", elements.ascendingNode_deg);
  RequireFinite(object, "the argument of periapsis", elements.periapsisArgument_deg);
  RequireFinite(object, "the true anomaly", elements.trueAnomaly_deg);
  const double anomaly = elements.trueAnomaly_deg * Degree;
  const double reach = 1.0 + e * std::cos(anomaly);
  Require(reach > 1e-12, object, "the true anomaly", elements.trueAnomaly_deg,
          "angles at which the conic is at a finite distance");
  const Eigen::Matrix3d axes =
      (Eigen::AngleAxisd(elements.ascendingNode_deg * Degree, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(elements.inclination_deg * Degree, Eigen::Vector3d::UnitX()) *
       Eigen::AngleAxisd(elements.periapsisArgument_deg * Degree, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  const double r = p / reach;
  const double speed = std::sqrt(elements.mu / p);
  return {axes * Eigen::Vector3d(r * std::cos(anomaly), r * std::sin(anomaly), 0.0),
          axes * Eigen::Vector3d(-speed * std::sin(anomaly), speed * (e + std::cos(anomaly)), 0.0)};
}

State Propagate(const State& state, double mu, double dt_s, const std::string& object) {
  CheckState(state, mu, object);
  RequireFinite(object, "the time", dt_s);
  if (dt_s == 0.0) {
    return state;
  }
  const double r0 = state.position.norm();
  const double alpha = 2.0 / r0 - state.velocity.squaredNorm() / mu; // 1 / a
  Universal u{r0, state.position.dot(state.velocity), alpha, mu};
  double dt = dt_s;
  if (alpha * r0 > Rounding) { // whole revolutions change nothing
    const double period = 2.0 * M_PI / (alpha * std::sqrt(alpha * mu));
    dt = std::remainder(dt_s, period);
  }
  // The time grows with the universal variable: a bracket, then Newton's steps within it.
  double low = 0.0;
  double high = 0.0;
  double step = std::sqrt(mu) * dt / r0;
  for (int i = 0; i < 2000; ++i) {
    high += step;
    u.At(high);
    if (!std::isfinite(u.time)) {
      high -= step;
      step *= 0.25;
      continue;
    }
    if ((dt > 0.0) == (u.time >= dt)) {
      break;
    }
    low = high;
    step *= i < 40 ? 1.5 : 1.0;
  }
  if (dt < 0.0) {
    std::swap(low, high);
  }
  double chi = 0.5 * (low + high);
  double residual = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 500; ++i) {
    u.At(chi);
    (u.time < dt ? low : high) = chi;
    double next = chi - (u.time - dt) * std::sqrt(mu) / u.radius;
    // Where the time grows as an exponential, Newton's steps from above are short.
    const bool slow = std::abs(u.time - dt) > 0.5 * residual;
    residual = std::abs(u.time - dt);
    if (slow || !(next > low && next < high)) {
      next = 0.5 * (low + high);
    }
    if (std::abs(next - chi) <= 1e-15 * std::abs(chi)) {
      break;
    }
    chi = next;
  }
  u.At(chi);
  const double root = std::sqrt(mu);
  const double f = 1.0 - chi * chi / r0 * u.c2;
  const double g = dt - chi * chi * chi / root * u.c3;
  State after;
  after.position = f * state.position + g * state.velocity;
  const double r = after.position.norm();
  const double fDot = root / (r * r0) * chi * (chi * chi * alpha * u.c3 - 1.0);
  const double gDot = 1.0 - chi * chi / r * u.c2;
  after.velocity = fDot * state.position + gDot * state.velocity;
  return after;
}

std::vector<Eigen::Vector3d> OrbitPoints(const OrbitalElements& elements, std::size_t count,
                                         double farthest, const std::string& object) {
  Require(count >= 3, object, "the number of points", double(count), "3 and more");
  OrbitalElements at = elements;
  std::vector<Eigen::Vector3d> points;
  points.reserve(count);
  const double e = elements.eccentricity;
  if (e >= 1.0) {
    Require(farthest > elements.PeriapsisRadius() && std::isfinite(farthest), object,
            "the farthest distance of an open orbit", farthest, "beyond its periapsis [m]");
  }
  const double most =
      e < 1.0 ? 180.0
              : std::acos(std::clamp((elements.semiLatusRectum / farthest - 1.0) / e, -1.0, 1.0)) /
                    Degree;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = 2.0 * double(i) / double(count - 1) - 1.0; // -1 to 1
    if (e < 1.0) {
      const double E = share * M_PI;
      at.trueAnomaly_deg = 2.0 *
                           std::atan2(std::sqrt(1.0 + e) * std::sin(0.5 * E),
                                      std::sqrt(1.0 - e) * std::cos(0.5 * E)) /
                           Degree;
    } else {
      // Evenly in tan(v / 2): the parabola's eccentric anomaly, and the square root of the distance
      // from periapsis.
      at.trueAnomaly_deg = 2.0 * std::atan(share * std::tan(0.5 * most * Degree)) / Degree;
    }
    points.push_back(StateOf(at, object).position);
  }
  if (e < 1.0) {
    points.back() = points.front();
  }
  return points;
}

Conic::Conic(std::string name, const State& state, double epoch_s, double mu)
    : Name_(std::move(name)), State_(state), Epoch_s_(epoch_s), Mu_(mu) {
  CheckState(state, mu, this->Name_);
  RequireFinite(this->Name_, "the epoch", epoch_s);
}

TimeSpan Conic::Span() const {
  return {-Infinity, Infinity};
}

State Conic::At(double time_s) const {
  RequireFinite(this->Name_, "the time", time_s);
  return Propagate(this->State_, this->Mu_, time_s - this->Epoch_s_, this->Name_);
}

} // namespace dspace
