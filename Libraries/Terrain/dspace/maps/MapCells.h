// The cells of a map: posts of a terrain at an even spacing.
#ifndef DSPACE_MAPS_MAP_CELLS_H
#define DSPACE_MAPS_MAP_CELLS_H

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include <dspace/maps/MapGround.h>

namespace dspace {

// Cell (i, j) stands at the level-0 post (column + i every, row + j every), which is its centre.
struct MapCells {
  static constexpr int MostEvery = 64;

  std::int64_t column = 0;
  std::int64_t row = 0;
  int columns = 0; // cells
  int rows = 0;
  int every = 1; // posts, 1 to MostEvery

  Eigen::Vector2d Post(int i, int j) const {
    return {double(this->column + std::int64_t(i) * this->every),
            double(this->row + std::int64_t(j) * this->every)};
  }
  // Corners of cells to map coordinates, as GDAL's geotransforms: (0.5, 0.5) is the centre of the
  // first cell.
  Eigen::Affine2d CellToMap(const MapGround& ground) const;
};

// `extent`: left, top, right, bottom in map coordinates; absent: all of the terrain. `spacing`: of
// the cells in map units, rounded to a whole number of posts; 0: the terrain's pixels, or, where
// these are more than MostEvery posts apart, MostEvery posts. Throws Error(InvalidArgument) for an
// extent without a cell on the terrain, more than 2^31 - 1 cells a side, and a spacing that is
// negative, not finite or too wide.
MapCells FindCells(const MapGround& ground, const std::optional<std::array<double, 4>>& extent,
                   double spacing);

} // namespace dspace

#endif
