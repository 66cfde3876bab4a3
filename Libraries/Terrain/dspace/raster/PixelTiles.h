// A cache for reading single pixels of a raster.
#ifndef DSPACE_TERRAIN_PIXELTILES_H
#define DSPACE_TERRAIN_PIXELTILES_H

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <dspace/raster/ElevationSource.h>

#include <dspace/raster/LruCache.h>

namespace dspace {

// Squares of 64 x 64 pixels, the latest 1024 of them (32 MiB), so that a few pixels here and there
// do not cost a read each. Any thread may call.
class PixelTiles {
public:
  static constexpr int Size = 64;                          // pixels a side of a tile
  static constexpr int Most = 64;                          // pixels of a window that is worth it
  using Tile = std::shared_ptr<const std::vector<double>>; // row by row; less at the raster's edge

  explicit PixelTiles(std::shared_ptr<const ElevationSource> source)
      : Source_(std::move(source)), Tiles_(1024) {}

  // As ElevationSource::Read.
  std::vector<double> Read(const RasterWindow& window) const;
  Tile TileAt(int column, int row) const; // counts tiles

private:
  std::shared_ptr<const ElevationSource> Source_;
  mutable std::mutex Mutex_; // of what follows
  mutable LruCache<std::pair<int, int>, Tile> Tiles_;
};

} // namespace dspace

#endif
