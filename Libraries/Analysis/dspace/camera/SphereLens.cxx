#include <dspace/camera/SphereLens.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>

namespace dspace {

SphereLens::SphereLens(Kind kind, LensNumbers& numbers)
    : Kind_(kind), Focal_(TakeFocal(numbers)), Center_(numbers.Two("center")),
      Alpha_(numbers.One("alpha")) {
  Require(this->Alpha_ >= 0.0 && this->Alpha_ <= 1.0, numbers.Label(), "alpha", this->Alpha_,
          "0 to 1");
  const double ratio = this->Alpha_ <= 0.5 ? this->Alpha_ / (1.0 - this->Alpha_)
                                           : (1.0 - this->Alpha_) / this->Alpha_;
  this->Least_ = ratio;
  if (kind == Kind::Extended) {
    this->Beta_ = numbers.One("beta");
    Require(this->Beta_ >= 1e-3 && this->Beta_ <= 1e3, numbers.Label(), "beta", this->Beta_,
            "1e-3 to 1e3");
  }
  if (kind == Kind::Double) {
    this->Xi_ = numbers.One("xi");
    Require(std::abs(this->Xi_) <= 1.0, numbers.Label(), "xi", this->Xi_, "-1 to 1");
    const double below = 2.0 * ratio * this->Xi_ + this->Xi_ * this->Xi_ + 1.0;
    this->Least_ = below > 0.0 ? (ratio + this->Xi_) / std::sqrt(below) : 0.0;
  }
  numbers.Finish();
}

const char* SphereLens::Type() const {
  return this->Kind_ == Kind::Unified    ? "ucm"
         : this->Kind_ == Kind::Extended ? "eucm"
                                         : "double_sphere";
}

bool SphereLens::Project(const Eigen::Vector3d& p, Eigen::Vector2d& pixel,
                         Jacobian* jacobian) const {
  double w = 0.0;
  Eigen::RowVector3d dw;
  const double alpha = this->Alpha_;
  if (this->Kind_ == Kind::Double) {
    const double length = p.norm();
    const double k = this->Xi_ * length + p.z();
    const double d = std::sqrt(p.x() * p.x() + p.y() * p.y() + k * k);
    w = alpha * d + (1.0 - alpha) * k;
    if (!(p.z() > -this->Least_ * length) || !(w > 0.0)) {
      return false;
    }
    const Eigen::RowVector3d dk = this->Xi_ / length * p.transpose() + Eigen::RowVector3d(0, 0, 1);
    dw = alpha / d * (Eigen::RowVector3d(p.x(), p.y(), 0.0) + k * dk) + (1.0 - alpha) * dk;
  } else {
    const double d = std::sqrt(this->Beta_ * (p.x() * p.x() + p.y() * p.y()) + p.z() * p.z());
    w = alpha * d + (1.0 - alpha) * p.z();
    if (!(p.z() > -this->Least_ * d) || !(w > 0.0)) {
      return false;
    }
    dw = alpha / d * Eigen::RowVector3d(this->Beta_ * p.x(), this->Beta_ * p.y(), p.z()) +
         Eigen::RowVector3d(0, 0, 1.0 - alpha);
  }
  const Eigen::Vector2d m = p.head<2>() / w;
  pixel = this->Focal_.cwiseProduct(m) + this->Center_;
  if (jacobian) {
    jacobian->setZero();
    jacobian->leftCols<2>() = Eigen::Matrix2d::Identity() / w;
    *jacobian -= m / w * dw;
    *jacobian = this->Focal_.asDiagonal() * *jacobian;
  }
  return true;
}

bool SphereLens::Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const {
  const Eigen::Vector2d m = (pixel - this->Center_).cwiseQuotient(this->Focal_);
  const double r2 = m.squaredNorm();
  const double alpha = this->Alpha_;
  const double root2 = 1.0 - (2.0 * alpha - 1.0) * this->Beta_ * r2;
  if (!(root2 >= 0.0) || !m.allFinite()) {
    return false;
  }
  const double below = alpha * std::sqrt(root2) + 1.0 - alpha;
  if (!(below > 0.0)) {
    return false;
  }
  const double z = (1.0 - this->Beta_ * alpha * alpha * r2) / below;
  ray.origin.setZero();
  if (this->Kind_ != Kind::Double) {
    ray.direction = Eigen::Vector3d(m.x(), m.y(), z).normalized();
  } else {
    const double inner = z * z + (1.0 - this->Xi_ * this->Xi_) * r2;
    if (!(inner >= 0.0)) {
      return false;
    }
    const double scale = (z * this->Xi_ + std::sqrt(inner)) / (z * z + r2);
    ray.direction =
        (scale * Eigen::Vector3d(m.x(), m.y(), z) - Eigen::Vector3d(0, 0, this->Xi_)).normalized();
  }
  Eigen::Vector2d back; // a pixel of another branch has no ray
  return this->Project(ray.direction, back) && (back - pixel).norm() <= 1e-6 * (1.0 + pixel.norm());
}

LensField SphereLens::Field() const {
  // Z = -q d on the border: the angle from the axis.
  double limit = M_PI;
  if (this->Kind_ == Kind::Double) {
    limit = std::acos(std::clamp(-this->Least_, -1.0, 1.0));
  } else {
    const double q2 = this->Least_ * this->Least_;
    limit = q2 >= 1.0 ? M_PI : M_PI_2 + std::atan(std::sqrt(q2 * this->Beta_ / (1.0 - q2)));
  }
  return {limit * 180.0 / M_PI, limit >= M_PI        ? ""
                                : this->Alpha_ > 0.5 ? "a fold"
                                                     : "the end of the model"};
}

LensValues SphereLens::Values() const {
  LensValues values{{"focal", {this->Focal_.x(), this->Focal_.y()}},
                    {"center", {this->Center_.x(), this->Center_.y()}},
                    {"alpha", {this->Alpha_}}};
  if (this->Kind_ == Kind::Extended) {
    values["beta"] = {this->Beta_};
  }
  if (this->Kind_ == Kind::Double) {
    values["xi"] = {this->Xi_};
  }
  return values;
}

LensPtr SphereLens::Scaled(double x, double y) const {
  return ScaledByFocal(*this, x, y);
}

} // namespace dspace
