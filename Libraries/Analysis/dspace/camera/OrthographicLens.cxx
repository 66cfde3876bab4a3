#include <dspace/camera/OrthographicLens.h>

#include <dspace/Checks.h>

namespace dspace {

OrthographicLens::OrthographicLens(LensNumbers& numbers)
    : Scale_(numbers.Two("scale")), Center_(numbers.Two("center")) {
  for (const double each : {this->Scale_.x(), this->Scale_.y()}) {
    Require(each >= 1e-9, numbers.Label(), "the scale", each, "1e-9 pixels per metre and more");
  }
  numbers.Finish();
}

bool OrthographicLens::Project(const Eigen::Vector3d& p_C, Eigen::Vector2d& pixel,
                               Jacobian* jacobian) const {
  if (!(p_C.z() >= 0.0)) {
    return false;
  }
  pixel = this->Scale_.cwiseProduct(p_C.head<2>()) + this->Center_;
  if (jacobian) {
    jacobian->setZero();
    jacobian->leftCols<2>() = this->Scale_.asDiagonal();
  }
  return true;
}

bool OrthographicLens::Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const {
  ray.origin.head<2>() = (pixel - this->Center_).cwiseQuotient(this->Scale_);
  ray.origin.z() = 0.0;
  ray.direction = Eigen::Vector3d::UnitZ();
  return pixel.allFinite();
}

LensValues OrthographicLens::Values() const {
  return {{"scale", {this->Scale_.x(), this->Scale_.y()}},
          {"center", {this->Center_.x(), this->Center_.y()}}};
}

LensPtr OrthographicLens::Scaled(double x, double y) const {
  LensValues values = this->Values();
  values["scale"][0] *= x;
  values["scale"][1] *= y;
  values["center"] = {ScaledPosition(this->Center_.x(), x), ScaledPosition(this->Center_.y(), y)};
  return MakeLens(this->Type(), values, "scaled lens");
}

} // namespace dspace
