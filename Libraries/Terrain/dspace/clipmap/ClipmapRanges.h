// How low and how high the ground of a clipmap's blocks is.
#ifndef DSPACE_TERRAIN_CLIPMAPRANGES_H
#define DSPACE_TERRAIN_CLIPMAPRANGES_H

#include <array>
#include <vector>

#include <dspace/clipmap/ClipmapLevels.h>

namespace dspace {

// The least and greatest heights [m] of the posts of each block (ClipmapIndices), also of those of
// the coarser level that they may be turned into. Found when they are asked for, once until the
// level changes. No OpenGL.
class ClipmapRanges {
public:
  using Range = std::array<double, 2>;

  // A level's posts or window are others; also those of the finer level are then found anew.
  void Changed(int level);
  // Least > greatest: no post has data.
  Range Of(const ClipmapLevels& levels, int level, int column, int row);

private:
  std::vector<std::vector<Range>> Levels_; // row by row; empty: not known
};

} // namespace dspace

#endif
