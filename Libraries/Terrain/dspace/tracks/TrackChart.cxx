#include <dspace/tracks/TrackChart.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dspace {
namespace {

Eigen::Vector3d EastOf(const Eigen::Vector3d& up) {
  const double parallel = up.head<2>().norm();
  return parallel > 0.0 ? Eigen::Vector3d(-up.y() / parallel, up.x() / parallel, 0.0)
                        : Eigen::Vector3d::UnitY(); // as of longitude 0
}

// tan((90 deg - latitude) / 2) is that of the sphere times this.
double Flattening(double squash, double sine) {
  const double e = std::sqrt(squash);
  return std::exp(-e * std::atanh(e * sine));
}

} // namespace

TrackChart::TrackChart(const BodyEllipsoid& body, const Eigen::Vector3d& anchor)
    : Body_(body), Anchor_(anchor.normalized()) {
  const Eigen::Vector3d s = this->ToSphere(this->Anchor_);
  const Eigen::Vector3d east = EastOf(s);
  this->Axes_.row(0) = east;
  this->Axes_.row(1) = s.cross(east);
  this->Axes_.row(2) = s;
}

// Snyder (3-1): tan(45 + chi/2) = tan(45 + phi/2) [(1 - e sin)/(1 + e sin)]^(e/2).
Eigen::Vector3d TrackChart::ToSphere(const Eigen::Vector3d& up) const {
  if (this->Body_.Spherical()) {
    return up;
  }
  const double parallel = up.head<2>().norm();
  if (parallel == 0.0) {
    return up;
  }
  const double sine = std::abs(up.z());
  // Of half the polar distance: (1 - sin) / cos = cos / (1 + sin).
  const double t = parallel / (1.0 + sine) / Flattening(this->Body_.Squash(), sine);
  const double q = 1.0 + t * t;
  const double cosine = 2.0 * t / q;
  return {cosine * up.x() / parallel, cosine * up.y() / parallel,
          std::copysign((1.0 - t * t) / q, up.z())};
}

Eigen::Vector3d TrackChart::FromSphere(const Eigen::Vector3d& s) const {
  const double parallel = s.head<2>().norm();
  if (this->Body_.Spherical() || parallel == 0.0) {
    return s;
  }
  const double t = parallel / (1.0 + std::abs(s.z()));
  double sine = std::abs(s.z());
  double cosine = parallel;
  for (int i = 0; i < 30; ++i) {
    const double u = t * Flattening(this->Body_.Squash(), sine);
    const double next = (1.0 - u * u) / (1.0 + u * u);
    cosine = 2.0 * u / (1.0 + u * u);
    const bool done = std::abs(next - sine) < 1e-16;
    sine = next;
    if (done) {
      break;
    }
  }
  return {cosine * s.x() / parallel, cosine * s.y() / parallel, std::copysign(sine, s.z())};
}

Eigen::Vector2d TrackChart::ToChart(const Eigen::Vector3d& up) const {
  const Eigen::Vector3d p = this->Axes_ * this->ToSphere(up);
  return 2.0 * this->Body_.Equatorial() / std::max(1.0 + p.z(), 1e-9) * p.head<2>();
}

Eigen::Vector3d TrackChart::ToUp(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d u = place / (2.0 * this->Body_.Equatorial());
  const double q = u.squaredNorm();
  const Eigen::Vector3d p(2.0 * u.x(), 2.0 * u.y(), 1.0 - q);
  return this->FromSphere(this->Axes_.transpose() * p / (1.0 + q));
}

double TrackChart::Scale(const Eigen::Vector3d& up) const {
  const Eigen::Vector3d s = this->ToSphere(up);
  const double k = 2.0 / std::max(1.0 + this->Axes_.row(2).dot(s), 1e-9);
  if (this->Body_.Spherical()) {
    return k;
  }
  const double parallel = up.head<2>().norm();
  const double sine = std::abs(up.z());
  const double cosines = // of the sphere's latitude over that of the ellipsoid
      parallel > 1e-12 ? s.head<2>().norm() / parallel
                       : 1.0 / Flattening(this->Body_.Squash(), sine);
  return k * cosines * this->Body_.Equatorial() / this->Body_.EastRadius(sine);
}

double TrackChart::East(const Eigen::Vector3d& up) const {
  const Eigen::Vector3d s = this->ToSphere(up);
  const Eigen::Vector3d p = this->Axes_ * s;
  const Eigen::Vector3d d = this->Axes_ * EastOf(s);
  const Eigen::Vector2d way = d.head<2>() * (1.0 + p.z()) - p.head<2>() * d.z();
  return std::atan2(way.y(), way.x());
}

double TrackChart::Distance(const Eigen::Vector3d& up) const {
  const Eigen::Vector3d p = this->Axes_ * this->ToSphere(up);
  return std::atan2(p.head<2>().norm(), p.z());
}

// The image of a circle on the sphere is a circle.
Eigen::AlignedBox2d TrackChart::BoxOf(const Eigen::Vector3d& s, double angle) const {
  constexpr double Farthest = 3.1; // [rad]
  const Eigen::Vector3d p = this->Axes_ * s;
  const double aside = p.head<2>().norm();
  const double distance = std::atan2(aside, p.z());
  if (!(distance + angle < Farthest)) {
    const double all = std::numeric_limits<double>::max();
    return {Eigen::Vector2d(-all, -all), Eigen::Vector2d(all, all)};
  }
  const Eigen::Vector2d way =
      aside > 0.0 ? Eigen::Vector2d(p.head<2>() / aside) : Eigen::Vector2d::UnitX();
  const double size = 2.0 * this->Body_.Equatorial();
  const double near = size * std::tan(0.5 * (distance - angle));
  const double far = size * std::tan(0.5 * (distance + angle));
  const Eigen::Vector2d middle = 0.5 * (near + far) * way;
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5 * (far - near));
  return {middle - half, middle + half};
}

double TrackChart::AngleOf(const Eigen::AlignedBox2d& box) const {
  return 0.5 * box.diagonal().norm() / this->Body_.Equatorial(); // the scale is 1 or more
}

} // namespace dspace
