#include <dspace/layers/raster/GroundAxes.h>

#include <cmath>

namespace dspace {
namespace {

constexpr double Radian = M_PI / 180.0;
constexpr double Step = 1e-6; // of the body's radius: half of what a direction is found across

} // namespace

GroundAxes::GroundAxes(const Crs& crs) : Crs_(crs), Below_(crs.Geographic()) {
  if (crs.GetKind() != Crs::Kind::Geographic) {
    this->Transform_ = std::make_unique<CrsTransform>(crs, this->Below_);
  }
}

std::vector<Eigen::Matrix2d> GroundAxes::At(const Eigen::Matrix2Xd& places) const {
  const Eigen::Index count = places.cols();
  if (!this->Transform_) {
    return std::vector<Eigen::Matrix2d>(std::size_t(count), this->Crs_.GetAxisSigns().asDiagonal());
  }
  const BodyAxes& body = this->Crs_.GetAxes();
  const double step = Step * body.semiMajor / this->Crs_.GetUnit();
  Eigen::Matrix2Xd ends(2, 4 * count); // after and before along x, then along y
  for (Eigen::Index i = 0; i < count; ++i) {
    for (int k = 0; k < 4; ++k) {
      ends.col(4 * i + k) = places.col(i);
      ends(k / 2, 4 * i + k) += k % 2 == 0 ? step : -step;
    }
  }
  this->Transform_->TryApply(ends);
  const Eigen::Vector2d toAngle = Radian * this->Below_.GetUnit() * this->Below_.GetAxisSigns();
  const double squash = 1.0 - std::pow(body.semiMinor / body.semiMajor, 2); // eccentricity squared
  std::vector<Eigen::Matrix2d> axes;
  axes.reserve(std::size_t(count));
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::Matrix2d there;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d after = toAngle.cwiseProduct(ends.col(4 * i + 2 * axis));
      const Eigen::Vector2d before = toAngle.cwiseProduct(ends.col(4 * i + 2 * axis + 1));
      const double latitude = 0.5 * (after.y() + before.y());
      const double sine = std::sin(latitude);
      const double east = std::cos(latitude) * std::remainder(after.x() - before.x(), 2.0 * M_PI);
      // Radii of curvature: along the meridian over that along the parallel.
      const double north = (1.0 - squash) / (1.0 - squash * sine * sine) * (after.y() - before.y());
      there.col(axis) = Eigen::Vector2d(east, north) / std::hypot(east, north);
    }
    axes.push_back(there);
  }
  return axes;
}

} // namespace dspace
