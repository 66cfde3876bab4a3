#include <dspace/posts/HeightGrid.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <dspace/Error.h>

#include <dspace/posts/PostFacets.h>

namespace dspace {

namespace {

constexpr double MaximumHeight = 1e9;  // [m] more than the Sun's radius, were heights radii
constexpr double MaximumExtent = 1e15; // [m]

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

} // namespace

HeightGrid::HeightGrid(const std::string& name, int columns, int rows, std::vector<double> heights,
                       const Eigen::Affine2d& gridToScene)
    : Columns_(columns), Rows_(rows), Heights_(std::move(heights)), GridToScene_(gridToScene) {
  if (columns < 2 || rows < 2)
    throw Error(Error::Kind::InvalidArgument, name,
                std::to_string(columns) + " x " + std::to_string(rows) +
                    " posts span no surface; at least 2 x 2 are needed");
  if (this->Heights_.size() != static_cast<std::size_t>(columns) * rows)
    throw Error(Error::Kind::InvalidArgument, name,
                std::to_string(this->Heights_.size()) + " heights given for " +
                    std::to_string(columns) + " x " + std::to_string(rows) + " posts");
  this->Minimum_ = std::numeric_limits<double>::infinity();
  this->Maximum_ = -this->Minimum_;
  for (std::size_t i = 0; i < this->Heights_.size(); ++i) {
    const double h = this->Heights_[i];
    if (std::isinf(h))
      throw Error(Error::Kind::InvalidArgument, name,
                  "a height is infinite; accepted are finite ones, and NaN for no data");
    if (std::abs(h) > MaximumHeight)
      throw Error(
          Error::Kind::InvalidArgument, name,
          "the post of column " + std::to_string(i % columns) + ", row " +
              std::to_string(i / columns) + " has the height " + Number(h) +
              " m; accepted are -1e9 to 1e9 m; if the value marks posts without data, state "
              "it (no_data)");
    if (std::isnan(h)) {
      ++this->Holes_;
    } else {
      this->Minimum_ = std::min(this->Minimum_, h);
      this->Maximum_ = std::max(this->Maximum_, h);
    }
  }
  if (this->Holes_ == this->Heights_.size())
    throw Error(Error::Kind::InvalidArgument, name,
                "all " + std::to_string(this->Holes_) + " posts are without data (no-data or NaN)");
  const Eigen::Matrix2d m = gridToScene.linear();
  const double det = m.determinant();
  if (!m.allFinite() || !gridToScene.translation().allFinite() ||
      !(std::abs(det) > 1e-9 * m.col(0).norm() * m.col(1).norm()))
    throw Error(Error::Kind::InvalidArgument, name, "the grid's cells span no area in the scene");
  for (const double c : {0.0, columns - 1.0})
    for (const double r : {0.0, rows - 1.0}) {
      const Eigen::Vector2d corner = gridToScene * Eigen::Vector2d(c, r);
      if (!(corner.cwiseAbs().maxCoeff() <= MaximumExtent))
        throw Error(Error::Kind::InvalidArgument, name,
                    "a corner is at (" + Number(corner.x()) + ", " + Number(corner.y()) +
                        ") m from the scene's origin; accepted are places within 1e15 m");
    }
  this->SceneToGrid_ = gridToScene.inverse();
}

HeightGrid::Facet HeightGrid::CellFacet(int c, int r, bool below, double u, double v) const {
  return FacetOfCell(
      [this](std::int64_t cc, std::int64_t rr) { return this->At(int(cc), int(rr)); }, c, r, below,
      u, v);
}

HeightGrid::Facet HeightGrid::FacetAt(const Eigen::Vector2d& g) const {
  return FacetNear({0, this->Columns_ - 2, 0, this->Rows_ - 2}, g,
                   [this](std::int64_t c, std::int64_t r, bool below, double u, double v) {
                     return this->CellFacet(int(c), int(r), below, u, v);
                   });
}

Eigen::Vector2d HeightGrid::SceneGradient(const Facet& facet) const {
  return this->SceneToGrid_.linear().transpose() * Eigen::Vector2d(facet.dc, facet.dr);
}

Eigen::Vector3d HeightGrid::Normal(const Facet& facet) const {
  const Eigen::Vector2d g = this->SceneGradient(facet);
  return Eigen::Vector3d(-g.x(), -g.y(), 1.0).normalized();
}

double HeightGrid::Slope(const Facet& facet) const {
  return std::atan(this->SceneGradient(facet).norm()) * 180.0 / M_PI;
}

Eigen::Vector3d HeightGrid::PostNormal(int c, int r) const {
  // All triangles have the same area in the map, so that the area-weighted mean of their normals
  // is the mean of their gradients: (-gx, -gy, 1) is a triangle's normal times its area.
  if (c > 0 && r > 0 && c < this->Columns_ - 1 && r < this->Rows_ - 1) {
    const double* at = &this->Heights_[static_cast<std::size_t>(r) * this->Columns_ + c];
    const double* north = at - this->Columns_;
    const double* south = at + this->Columns_;
    Facet mean;
    mean.dc = (south[1] - south[0] + 2.0 * (at[1] - at[-1]) + north[0] - north[-1]) / 6.0;
    mean.dr = (south[1] - at[1] + 2.0 * (south[0] - north[0]) + at[-1] - north[-1]) / 6.0;
    if (std::isfinite(mean.dc + mean.dr + at[0])) { // all six triangles exist
      return this->Normal(mean);
    }
  }
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  const auto add = [&](int cc, int rr, bool below) {
    if (cc < 0 || rr < 0 || cc > this->Columns_ - 2 || rr > this->Rows_ - 2)
      return;
    const Facet facet = this->CellFacet(cc, rr, below, 0.0, 0.0);
    if (!facet.valid)
      return;
    sum += Eigen::Vector2d(facet.dc, facet.dr);
    ++count;
  };
  add(c, r, true);
  add(c, r, false);
  add(c - 1, r, false);
  add(c, r - 1, true);
  add(c - 1, r - 1, true);
  add(c - 1, r - 1, false);
  if (count == 0)
    return Eigen::Vector3d::UnitZ();
  Facet mean;
  mean.dc = sum.x() / count;
  mean.dr = sum.y() / count;
  return this->Normal(mean);
}

} // namespace dspace
