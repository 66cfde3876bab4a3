// Least and greatest heights of a raster's squares.
#ifndef DSPACE_TERRAIN_PATCHRANGES_H
#define DSPACE_TERRAIN_PATCHRANGES_H

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace dspace {

// Of squares of 8 x 8 pixels, and of such twice as wide again and again. 10 bytes a square.
class PatchRanges {
public:
  PatchRanges() = default; // of nothing: every answer is infinite
  PatchRanges(int columns, int rows);

  void Take(int column, int row, double height); // not NaN
  void Finish();                                 // after all pixels
  // Of all pixels whose centres lie in a box, in pixels from the raster's corner, and of some
  // around it. Least above greatest: none has data.
  std::array<double, 2> Of(const Eigen::AlignedBox2d& pixels) const;

private:
  struct Level {
    int columns = 0;
    int rows = 0;
    std::vector<std::array<float, 2>> heights;
  };
  std::vector<Level> Levels_;
};

} // namespace dspace

#endif
