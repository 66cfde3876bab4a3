// The tiles of a terrain's colour layers: a quadtree over each chart.
#ifndef DSPACE_LAYERS_COLORGRID_H
#define DSPACE_LAYERS_COLORGRID_H

#include <array>
#include <cstdint>

#include <dspace/crs/Crs.h>
#include <dspace/posts/PostPlacement.h>

namespace dspace {

// A tile of zoom z has TileTexels texels a side; each has four of zoom z + 1. Texels are squares in
// the chart's posts (degrees of a degree grid); x grows with the posts' columns, y with their rows.
struct ColorTile {
  int chart = 0; // of the terrain: 0 its own, then the poles'
  int zoom = 0;
  std::int64_t column = 0;
  std::int64_t row = 0;
  bool operator<(const ColorTile& o) const { return this->Key() < o.Key(); }
  bool operator==(const ColorTile& o) const { return this->Key() == o.Key(); }

private:
  std::array<std::int64_t, 4> Key() const {
    return {this->chart, this->zoom, this->column, this->row};
  }
};

struct ColorGrid {
  static constexpr int TileTexels = 256;
  static constexpr int MaximumZoom = 30;

  PostPlacement placement;
  Crs crs; // of map coordinates; None: the raster's own units
  // Of the root tiles together, in level-0 posts: the outer corner of the first texel, and the side
  // of one root tile.
  Eigen::Vector2d firstPost = Eigen::Vector2d::Zero();
  Eigen::Vector2d rootPosts = Eigen::Vector2d::Ones();
  int rootColumns = 1;   // side by side: 2 around a body, else 1; one row of them
  bool periodic = false; // along columns: the last tile's neighbour is the first
  Eigen::Affine2d postToMap = Eigen::Affine2d::Identity(); // posts to map (x, y) of `crs`
  // Where there is ground, in posts. No tile outside is requested.
  Eigen::AlignedBox2d extent;

  std::int64_t ColumnsAt(int zoom) const { return std::int64_t(this->rootColumns) << zoom; }
  std::int64_t RowsAt(int zoom) const { return std::int64_t(1) << zoom; }
  // From texels of a zoom, counted from the outer corner of the grid's first (its centre is at
  // (0.5, 0.5)), to posts and to the map.
  Eigen::Affine2d TexelToPost(int zoom) const;
  Eigen::Affine2d TexelToMap(int zoom) const { return this->postToMap * this->TexelToPost(zoom); }
  // The greater side of a texel of zoom 0 [m] on the ground in the middle of the extent.
  double RootTexelSize() const;
  // The least zoom whose texels are no larger than `pixel` [m]; at most MaximumZoom.
  int ZoomFor(double pixel) const;
};

} // namespace dspace

#endif
