#include <dspace/camera/BrownLens.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>

namespace dspace {
namespace {

// Projects the plane Z = 1 onto the plane of a sensor turned by x, then y [rad], along the axis.
Eigen::Matrix3d TiltOf(double x, double y) {
  const double cx = std::cos(x), sx = std::sin(x), cy = std::cos(y), sy = std::sin(y);
  Eigen::Matrix3d turn;
  turn << cy, sy * sx, -sy * cx, //
      0.0, cx, sx,               //
      sy, -cy * sx, cy * cx;
  Eigen::Matrix3d onto;
  onto << turn(2, 2), 0.0, -turn(0, 2), //
      0.0, turn(2, 2), -turn(1, 2),     //
      0.0, 0.0, 1.0;
  return onto * turn;
}

template<std::size_t N> std::array<double, N> Fill(const std::vector<double>& from) {
  std::array<double, N> to{};
  std::copy_n(from.begin(), std::min(N, from.size()), to.begin());
  return to;
}

} // namespace

BrownLens::BrownLens(bool pinhole, LensNumbers& numbers)
    : PlaneLens(TakeFocal(numbers).asDiagonal(), numbers.Two("center")), Pinhole_(pinhole) {
  if (!pinhole) {
    this->K_ = Fill<6>(numbers.UpTo("radial", 1, 6));
    this->P_ = Fill<2>(numbers.UpTo("tangential", 2, 2));
    this->S_ = Fill<4>(numbers.UpTo("prism", 4, 4));
    this->Tilt_deg_ = Eigen::Vector2d(numbers.UpTo("tilt_deg", 2, 2).data());
    for (const double tilt : {this->Tilt_deg_.x(), this->Tilt_deg_.y()}) {
      Require(std::abs(tilt) <= 80.0, numbers.Label(), "a tilt", tilt, "-80 to 80 deg");
    }
    this->Tilted_ = this->Tilt_deg_ != Eigen::Vector2d::Zero();
    this->TiltMatrix_ =
        TiltOf(this->Tilt_deg_.x() * M_PI / 180.0, this->Tilt_deg_.y() * M_PI / 180.0);
  }
  numbers.Finish();
  const auto zero = [](const auto& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return v == 0.0; });
  };
  this->FindFold(zero(this->P_) && zero(this->S_) && !this->Tilted_, numbers.Label());
}

bool BrownLens::Distort(const Eigen::Vector2d& n, Eigen::Vector2d& d,
                        Eigen::Matrix2d* derivative) const {
  if (this->Pinhole_) {
    d = n;
    if (derivative) {
      derivative->setIdentity();
    }
    return true;
  }
  const auto& [k1, k2, k3, k4, k5, k6] = this->K_;
  const auto& [p1, p2] = this->P_;
  const auto& [s1, s2, s3, s4] = this->S_;
  const double x = n.x(), y = n.y();
  const double r2 = x * x + y * y;
  const double above = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double below = 1.0 + r2 * (k4 + r2 * (k5 + r2 * k6));
  if (!(below > 0.0)) {
    return false;
  }
  const double g = above / below;
  d.x() = g * x + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x) + r2 * (s1 + r2 * s2);
  d.y() = g * y + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y + r2 * (s3 + r2 * s4);
  if (derivative) {
    // By r².
    const double dAbove = k1 + r2 * (2.0 * k2 + 3.0 * r2 * k3);
    const double dBelow = k4 + r2 * (2.0 * k5 + 3.0 * r2 * k6);
    const double dg = (dAbove - g * dBelow) / below;
    const double dsx = s1 + 2.0 * s2 * r2, dsy = s3 + 2.0 * s4 * r2;
    Eigen::Matrix2d& J = *derivative;
    J(0, 0) = g + 2.0 * x * x * dg + 2.0 * p1 * y + 6.0 * p2 * x + 2.0 * x * dsx;
    J(0, 1) = 2.0 * x * y * dg + 2.0 * p1 * x + 2.0 * p2 * y + 2.0 * y * dsx;
    J(1, 0) = 2.0 * x * y * dg + 2.0 * p1 * x + 2.0 * p2 * y + 2.0 * x * dsy;
    J(1, 1) = g + 2.0 * y * y * dg + 6.0 * p1 * y + 2.0 * p2 * x + 2.0 * y * dsy;
  }
  if (this->Tilted_) {
    const Eigen::Vector3d q = this->TiltMatrix_ * Eigen::Vector3d(d.x(), d.y(), 1.0);
    if (!(q.z() > 0.0)) {
      return false;
    }
    d = q.head<2>() / q.z();
    if (derivative) {
      const Eigen::Matrix2d onto =
          (this->TiltMatrix_.topLeftCorner<2, 2>() - d * this->TiltMatrix_.row(2).head<2>()) /
          q.z();
      *derivative = onto * *derivative;
    }
  }
  return true;
}

LensValues BrownLens::Values() const {
  const Eigen::Matrix2d& M = this->Matrix();
  LensValues values{{"focal", {M(0, 0), M(1, 1)}},
                    {"center", {this->Center().x(), this->Center().y()}}};
  if (!this->Pinhole_) {
    values["radial"] = {this->K_.begin(), this->K_.end()};
    values["tangential"] = {this->P_.begin(), this->P_.end()};
    values["prism"] = {this->S_.begin(), this->S_.end()};
    values["tilt_deg"] = {this->Tilt_deg_.x(), this->Tilt_deg_.y()};
  }
  return values;
}

LensPtr BrownLens::Scaled(double x, double y) const {
  return ScaledByFocal(*this, x, y);
}

} // namespace dspace
