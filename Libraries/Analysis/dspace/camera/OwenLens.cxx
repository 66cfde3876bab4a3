#include <dspace/camera/OwenLens.h>

#include <cmath>

#include <Eigen/LU>

#include <dspace/Checks.h>

namespace dspace {

Eigen::Matrix2d TakeFocalMatrix(LensNumbers& numbers) {
  const std::vector<double> k = numbers.Exactly("matrix", 4);
  Eigen::Matrix2d matrix;
  matrix << k[0], k[1], k[2], k[3];
  const double size = matrix.norm();
  Require(std::abs(matrix.determinant()) > 1e-9 * size * size, numbers.Label(),
          "the determinant of 'matrix'", matrix.determinant(), "a matrix that is not singular");
  return matrix;
}

OwenLens::OwenLens(LensNumbers& numbers)
    : PlaneLens(TakeFocalMatrix(numbers), numbers.Two("center")),
      Focal_(numbers.One("focal_length")), Radial_(numbers.UpTo("radial", 1, 2)),
      Tangential_(numbers.UpTo("tangential", 2, 2)), Pinwheel_(numbers.UpTo("pinwheel", 1, 2)) {
  Require(this->Focal_ >= 1e-3, numbers.Label(), "the focal length", this->Focal_,
          "1e-3 mm and more");
  numbers.Finish();
  this->FindFold(this->Tangential_[0] == 0.0 && this->Tangential_[1] == 0.0, numbers.Label());
}

bool OwenLens::Distort(const Eigen::Vector2d& n, Eigen::Vector2d& d,
                       Eigen::Matrix2d* derivative) const {
  const Eigen::Vector2d p = this->Focal_ * n;
  const Eigen::Vector2d turned(-p.y(), p.x());
  const double r2 = p.squaredNorm(), r = std::sqrt(r2);
  const double along = r2 * (this->Radial_[0] + r2 * this->Radial_[1]) +
                       this->Tangential_[0] * p.y() + this->Tangential_[1] * p.x();
  const double across = r * (this->Pinwheel_[0] + r2 * this->Pinwheel_[1]);
  d = p + along * p + across * turned;
  if (derivative) {
    const Eigen::RowVector2d dAlong =
        2.0 * (this->Radial_[0] + 2.0 * r2 * this->Radial_[1]) * p.transpose() +
        Eigen::RowVector2d(this->Tangential_[1], this->Tangential_[0]);
    Eigen::RowVector2d dAcross = Eigen::RowVector2d::Zero();
    if (r > 0.0) {
      dAcross = (this->Pinwheel_[0] + 3.0 * r2 * this->Pinwheel_[1]) / r * p.transpose();
    }
    Eigen::Matrix2d quarter;
    quarter << 0.0, -1.0, 1.0, 0.0;
    *derivative = this->Focal_ * ((1.0 + along) * Eigen::Matrix2d::Identity() + p * dAlong +
                                  across * quarter + turned * dAcross);
  }
  return true;
}

LensValues OwenLens::Values() const {
  const Eigen::Matrix2d& M = this->Matrix();
  return {{"focal_length", {this->Focal_}},
          {"matrix", {M(0, 0), M(0, 1), M(1, 0), M(1, 1)}},
          {"center", {this->Center().x(), this->Center().y()}},
          {"radial", this->Radial_},
          {"tangential", this->Tangential_},
          {"pinwheel", this->Pinwheel_}};
}

LensPtr OwenLens::Scaled(double x, double y) const {
  LensValues values = this->Values();
  values["matrix"][0] *= x;
  values["matrix"][1] *= x;
  values["matrix"][2] *= y;
  values["matrix"][3] *= y;
  values["center"] = {ScaledPosition(this->Center().x(), x), ScaledPosition(this->Center().y(), y)};
  return MakeLens(this->Type(), values, "scaled lens");
}

} // namespace dspace
