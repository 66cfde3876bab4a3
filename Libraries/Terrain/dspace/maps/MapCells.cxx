#include <dspace/maps/MapCells.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <dspace/Checks.h>

namespace dspace {

Eigen::Affine2d MapCells::CellToMap(const MapGround& ground) const {
  Eigen::Affine2d cellToPost = Eigen::Affine2d::Identity();
  cellToPost.linear().diagonal().setConstant(double(this->every));
  cellToPost.translation() << double(this->column) - 0.5 * this->every,
      double(this->row) - 0.5 * this->every;
  return ground.postToMap * cellToPost;
}

MapCells FindCells(const MapGround& ground, const std::optional<std::array<double, 4>>& extent,
                   double spacing) {
  Require(spacing >= 0.0 && std::isfinite(spacing), ground.name, "the spacing of the cells",
          spacing, "map units, 0 or more");
  const PostLattice& lattice = ground.pyramid->Lattice();
  const double post = std::sqrt(std::abs(ground.postToMap.linear().determinant())); // map units
  MapCells cells;
  if (spacing > 0.0 && spacing < 0.5 * post) {
    Reject(ground.name, "the spacing of the cells is " + NumberText(spacing) +
                            " map units, but its posts are " + NumberText(post) +
                            " apart; accepted: that or more, or 0 (its pixels)");
  }
  const double every = spacing > 0.0 ? std::max(1.0, std::round(spacing / post))
                                     : std::min(ground.postsAPixel, MapCells::MostEvery);
  if (every > MapCells::MostEvery) {
    Reject(ground.name,
           "the spacing of the cells is " + NumberText(spacing) + " map units; accepted: up to " +
               NumberText(MapCells::MostEvery * post) + ", " + std::to_string(MapCells::MostEvery) +
               " of its posts (of a raster of wide pixels on a body, a pixel has many "
               "posts); take a smaller extent for fewer cells");
  }
  cells.every = int(every);
  Eigen::Vector2d low(0.0, 0.0);
  Eigen::Vector2d high(double(lattice.columns - 1), double(lattice.rows - 1));
  if (extent) {
    const auto [left, top, right, bottom] = *extent;
    for (const double edge : *extent) {
      RequireFinite(ground.name, "an edge of the extent", edge);
    }
    if (!(left <= right && bottom <= top)) {
      Reject(ground.name, "the extent is " + NumberText(left) + ", " + NumberText(top) + ", " +
                              NumberText(right) + ", " + NumberText(bottom) +
                              "; accepted: left, top, right, bottom with left <= right and bottom "
                              "<= top");
    }
    const Eigen::Affine2d mapToPost = ground.postToMap.inverse();
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(left, top), Eigen::Vector2d(right, top), Eigen::Vector2d(left, bottom),
          Eigen::Vector2d(right, bottom)}) {
      box.extend(mapToPost * corner);
    }
    low = low.cwiseMax(box.min());
    high = high.cwiseMin(box.max());
  }
  // Cells stand on pixels where they can.
  const auto first = [&](double from, double pixel) {
    const double offset = std::fmod(std::round(pixel), every);
    return offset + every * std::ceil((from - offset - 1e-6) / every);
  };
  const double column = first(low.x(), ground.firstPixel.x());
  const double row = first(low.y(), ground.firstPixel.y());
  const double columns = std::floor((high.x() + 1e-6 - column) / every) + 1.0;
  const double rows = std::floor((high.y() + 1e-6 - row) / every) + 1.0;
  if (!(columns >= 1.0 && rows >= 1.0)) {
    Reject(ground.name, "no cell of the map lies on its data; accepted: an extent that meets the "
                        "terrain");
  }
  if (columns > std::numeric_limits<int>::max() || rows > std::numeric_limits<int>::max()) {
    Reject(ground.name, "the map has " + NumberText(columns) + " x " + NumberText(rows) +
                            " cells; accepted: up to 2147483647 a side");
  }
  cells.column = std::int64_t(column);
  cells.row = std::int64_t(row);
  cells.columns = int(columns);
  cells.rows = int(rows);
  return cells;
}

} // namespace dspace
