#include <dspace/camera/AngleLens.h>

#include <algorithm>
#include <cmath>

#include <dspace/camera/MonotoneRange.h>

namespace dspace {

AngleLens::AngleLens(bool equidistant, LensNumbers& numbers)
    : Plain_(equidistant), Focal_(TakeFocal(numbers)), Center_(numbers.Two("center")) {
  if (!equidistant) {
    const std::vector<double> radial = numbers.UpTo("radial", 1, 4);
    std::copy(radial.begin(), radial.end(), this->K_.begin());
  }
  numbers.Finish();
  this->Limit_ = MonotoneRange(M_PI, [this](double angle) {
    double slope = 0.0;
    this->Radius(angle, &slope);
    return slope;
  });
  this->Widest_ = this->Radius(this->Limit_, nullptr);
}

double AngleLens::Radius(double angle, double* slope) const {
  const double t = angle * angle;
  const auto& [k1, k2, k3, k4] = this->K_;
  if (slope) {
    *slope = 1.0 + t * (3.0 * k1 + t * (5.0 * k2 + t * (7.0 * k3 + t * 9.0 * k4)));
  }
  return angle * (1.0 + t * (k1 + t * (k2 + t * (k3 + t * k4))));
}

bool AngleLens::Project(const Eigen::Vector3d& p_C, Eigen::Vector2d& pixel,
                        Jacobian* jacobian) const {
  const Eigen::Vector2d side = p_C.head<2>();
  const double r = side.norm();
  const double square = p_C.squaredNorm();
  const double angle = std::atan2(r, p_C.z());
  if (!(square > 0.0) || !(angle < this->Limit_)) {
    return false;
  }
  double slope = 1.0;
  const double radius = this->Radius(angle, &slope);
  if (r < 1e-12 * p_C.z()) { // on the axis
    pixel = this->Focal_.cwiseProduct(side / p_C.z()) + this->Center_;
    if (jacobian) {
      jacobian->setZero();
      jacobian->leftCols<2>() = (this->Focal_ / p_C.z()).asDiagonal();
    }
    return true;
  }
  const Eigen::Vector2d unit = side / r;
  pixel = this->Focal_.cwiseProduct(radius * unit) + this->Center_;
  if (jacobian) {
    Eigen::RowVector3d dAngle;
    dAngle << p_C.z() / square * unit.transpose(), -r / square;
    jacobian->leftCols<2>() = radius / r * (Eigen::Matrix2d::Identity() - unit * unit.transpose());
    jacobian->col(2).setZero();
    *jacobian += slope * unit * dAngle;
    *jacobian = this->Focal_.asDiagonal() * *jacobian;
  }
  return true;
}

bool AngleLens::Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const {
  const Eigen::Vector2d u = (pixel - this->Center_).cwiseQuotient(this->Focal_);
  const double radius = u.norm();
  if (!(radius < this->Widest_)) {
    return false;
  }
  ray.origin.setZero();
  if (radius < 1e-12) {
    ray.direction = Eigen::Vector3d(u.x(), u.y(), 1.0).normalized();
    return true;
  }
  const double angle = SolveMonotone(
      radius, this->Limit_, [this](double t, double& slope) { return this->Radius(t, &slope); });
  const Eigen::Vector2d side = std::sin(angle) / radius * u;
  ray.direction = Eigen::Vector3d(side.x(), side.y(), std::cos(angle));
  return true;
}

LensField AngleLens::Field() const {
  const bool all = this->Limit_ >= M_PI;
  return {this->Limit_ * 180.0 / M_PI, all ? "" : "a fold"};
}

LensValues AngleLens::Values() const {
  LensValues values{{"focal", {this->Focal_.x(), this->Focal_.y()}},
                    {"center", {this->Center_.x(), this->Center_.y()}}};
  if (!this->Plain_) {
    values["radial"] = {this->K_.begin(), this->K_.end()};
  }
  return values;
}

LensPtr AngleLens::Scaled(double x, double y) const {
  return ScaledByFocal(*this, x, y);
}

} // namespace dspace
