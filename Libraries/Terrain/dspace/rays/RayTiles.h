// Tiles of posts with the least and greatest heights of their blocks, kept for rays.
#ifndef DSPACE_TERRAIN_RAYTILES_H
#define DSPACE_TERRAIN_RAYTILES_H

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include <dspace/pyramid/ElevationPyramid.h>

#include <dspace/raster/LruCache.h>

namespace dspace {

// Cells of one tile of a level, with the posts at all their corners.
struct RayTile {
  static constexpr int Bits = 7;
  static constexpr int Cells = 1 << Bits;
  static constexpr int Posts = Cells + 1;
  static_assert(Cells == ElevationPyramid::TileSize, "tiles are the pyramid's");
  // Empty, hence +infinity and -infinity, where no post has data.
  struct Range {
    float least = std::numeric_limits<float>::infinity();
    float greatest = -std::numeric_limits<float>::infinity();
    void Widen(const Range& by) { // to hold both
      this->least = by.least < this->least ? by.least : this->least;
      this->greatest = by.greatest > this->greatest ? by.greatest : this->greatest;
    }
  };

  std::int64_t column = 0; // of its first post
  std::int64_t row = 0;
  std::vector<float> heights;                  // Posts x Posts
  std::array<std::vector<Range>, Bits> ranges; // [k]: blocks of 2^(k+1) cells a side, row by row

  double operator()(std::int64_t c, std::int64_t r) const {
    return this->heights[std::size_t(r - this->row) * Posts + std::size_t(c - this->column)];
  }
  // Of the block of 2^bits cells, bits >= 1, that is (c, r) of such blocks from the lattice's
  // first.
  Range Of(int bits, std::int64_t c, std::int64_t r) const;
};

// The latest ones; and of all that were ever read the whole tile's range.
class RayTiles {
public:
  using Key = std::array<std::int64_t, 3>; // level, column and row of tiles

  explicit RayTiles(std::shared_ptr<ElevationPyramid> pyramid);

  // Forgets what has changed in the pyramid since. Each ray begins with it; what changes while it
  // is on its way it may see or not.
  void Refresh();
  // Throws what the pyramid's Read() throws.
  std::shared_ptr<const RayTile> Get(const Key& key, double seconds);
  RayTile::Range RangeOf(const Key& key, double seconds);

private:
  void DropChanged(); // with the lock held
  std::shared_ptr<ElevationPyramid> Pyramid_;
  std::mutex Mutex_; // of what follows
  LruCache<Key, std::shared_ptr<const RayTile>> Tiles_;
  std::map<Key, RayTile::Range> Ranges_;
  std::atomic<std::uint64_t> Seen_{0}; // change of the pyramid; written with the lock held
};

} // namespace dspace

#endif
