// Interface to the posts of a terrain: from a raster, several rasters, or a formula.
#ifndef DSPACE_TERRAIN_POSTSOURCE_H
#define DSPACE_TERRAIN_POSTSOURCE_H

#include <cstdint>
#include <memory>
#include <string>

#include <dspace/posts/PostLattice.h>

namespace dspace {

class PostProbe;

// A block of posts of one level.
struct PostBlock {
  int level = 0;
  std::int64_t column = 0; // of its first post; may lie outside the lattice
  std::int64_t row = 0;
  int width = 0; // posts
  int height = 0;
};

// Posts that changed, of a level; around a body they may begin in any turn, and are at most one.
struct PostRectangle {
  std::int64_t column = 0; // of its first post
  std::int64_t row = 0;
  std::int64_t width = 0; // posts
  std::int64_t height = 0;
  int levels = 64; // a change of level 0 reaches levels from..levels-1
  int from = 0;
};

// The posts of a level whose cells reach into a rectangle of level 0.
inline PostRectangle PostsTouched(const PostRectangle& base, int level) {
  if (level == 0) {
    return base;
  }
  const std::int64_t step = std::int64_t(1) << level;
  const std::int64_t column = FloorDiv(base.column, step) - 1;
  const std::int64_t row = FloorDiv(base.row, step) - 1;
  return {column,
          row,
          FloorDiv(base.column + base.width, step) + 3 - column,
          FloorDiv(base.row + base.height, step) + 3 - row,
          base.levels,
          base.from};
}

// Abstract. Heights are metres above the terrain's vertical datum, floats: a step of 0.5 mm below
// 8192 m and 1 mm below 16384 m, the same for drawing and for queries.
class PostSource {
public:
  virtual ~PostSource() = default;
  virtual const std::string& GetName() const = 0; // for messages
  virtual const PostLattice& GetLattice() const = 0;
  // Writes the block row by row to `heights`; NaN where there is no data and outside the lattice.
  // Level 0 is the surface itself; a post of a coarser level is the mean over its cell, so that
  // distant ground does not alias. Called from several threads at once. Throws Error when the data
  // cannot be read.
  virtual void Read(const PostBlock& block, float* heights) const = 0;
  // The same, and writes to `tracks` how much of each post's cell wheels have rolled over, 0 to 1.
  // Returns false, without writing `tracks`, if there are no tracks.
  virtual bool ReadWithTracks(const PostBlock& block, float* heights, float* /*tracks*/) const {
    this->Read(block, heights);
    return false;
  }
  // For reading single posts of level 0; null if blocks are all there is.
  virtual std::unique_ptr<PostProbe> MakeProbe() const;
};

} // namespace dspace

#endif
