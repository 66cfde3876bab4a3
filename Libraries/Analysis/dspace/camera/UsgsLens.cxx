#include <dspace/camera/UsgsLens.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/camera/MonotoneRange.h>
#include <dspace/camera/OwenLens.h>

namespace dspace {
namespace {

constexpr double FocalPlane = 1e4; // [mm] from the axis: none is larger

} // namespace

UsgsLens::UsgsLens(LensNumbers& numbers)
    : PlaneLens(TakeFocalMatrix(numbers), numbers.Two("center")),
      Focal_(numbers.One("focal_length")), Radial_(numbers.UpTo("radial", 1, 3)) {
  Require(this->Focal_ >= 1e-3, numbers.Label(), "the focal length", this->Focal_,
          "1e-3 mm and more");
  numbers.Finish();
  const std::vector<double>& k = this->Radial_;
  const double end = std::min(FocalPlane, 600.0 * this->Focal_); // 89.9 degrees of a pinhole
  this->Farthest_ = MonotoneRange(end, [&](double r) {
    const double r2 = r * r;
    return 1.0 - k[0] - r2 * (3.0 * k[1] + 5.0 * r2 * k[2]);
  });
  this->FindFold(true, numbers.Label());
}

bool UsgsLens::Distort(const Eigen::Vector2d& n, Eigen::Vector2d& d,
                       Eigen::Matrix2d* derivative) const {
  const std::vector<double>& k = this->Radial_;
  const auto removed = [&](double r, double& slope) {
    const double r2 = r * r;
    slope = 1.0 - k[0] - r2 * (3.0 * k[1] + 5.0 * r2 * k[2]);
    return r * (1.0 - k[0] - r2 * (k[1] + r2 * k[2]));
  };
  double slope = 1.0;
  const Eigen::Vector2d u = this->Focal_ * n;
  const double length = u.norm();
  if (!(length < removed(this->Farthest_, slope))) {
    return false;
  }
  const double r = length == 0.0 ? 0.0 : SolveMonotone(length, this->Farthest_, removed);
  removed(r, slope);
  const double ratio = length == 0.0 ? 1.0 / (1.0 - k[0]) : r / length;
  d = ratio * u;
  if (derivative) {
    // Across the radius d grows by the ratio, along it by 1 / slope.
    *derivative = ratio * Eigen::Matrix2d::Identity();
    if (length > 0.0) {
      const Eigen::Vector2d along = u / length;
      *derivative += (1.0 / slope - ratio) * along * along.transpose();
    }
    *derivative *= this->Focal_;
  }
  return true;
}

LensValues UsgsLens::Values() const {
  const Eigen::Matrix2d& M = this->Matrix();
  return {{"focal_length", {this->Focal_}},
          {"matrix", {M(0, 0), M(0, 1), M(1, 0), M(1, 1)}},
          {"center", {this->Center().x(), this->Center().y()}},
          {"radial", this->Radial_}};
}

LensPtr UsgsLens::Scaled(double x, double y) const {
  LensValues values = this->Values();
  values["matrix"][0] *= x;
  values["matrix"][1] *= x;
  values["matrix"][2] *= y;
  values["matrix"][3] *= y;
  values["center"] = {ScaledPosition(this->Center().x(), x), ScaledPosition(this->Center().y(), y)};
  return MakeLens(this->Type(), values, "scaled lens");
}

} // namespace dspace
