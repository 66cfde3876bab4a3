// Selects the blocks of a clipmap's levels that a view may see. No OpenGL.
#ifndef DSPACE_TERRAIN_CLIPMAPBLOCKS_H
#define DSPACE_TERRAIN_CLIPMAPBLOCKS_H

#include <array>
#include <optional>
#include <vector>

#include <dspace/clipmap/ClipmapRanges.h>
#include <dspace/clipmap/arithmetic/ClipmapIndices.h>
#include <dspace/posts/PostPlacement.h>

namespace dspace {

// The view, in the terrain's frame.
struct ClipmapViewVolume {
  Eigen::Vector3d camera = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector4d> planes; // of the view volume, inwards; of any length
};

class ClipmapBlocks {
public:
  // `heights` [m] are those that all posts stay within. All of it outlives this.
  ClipmapBlocks(const ClipmapLevels& levels, const PostPlacement& placement,
                const std::array<double, 2>& heights, ClipmapRanges& ranges)
      : Levels_(levels), Placement_(placement), Heights_(heights), Ranges_(ranges) {}

  // Where a block's ground is, in the terrain's frame [m]: within `radius` of the hull of points,
  // and on a plane between two heights.
  struct Bounds {
    std::vector<Eigen::Vector3d> points;
    double radius = 0.0;
    std::optional<std::array<double, 2>> heights;
  };
  struct Block {
    ClipmapIndices::Run run;
    Bounds bounds; // without points: anywhere
  };
  // A level's blocks that are not surely out of sight. `finest`: the finest level that is drawn;
  // the others have its hole.
  std::vector<Block> Seen(const ClipmapIndices& indices, const ClipmapViewVolume& sight, int level,
                          int finest) const;
  // Their runs of indices, joined where they follow each other.
  static std::vector<ClipmapIndices::Run> Runs(const std::vector<Block>& blocks);

private:
  Eigen::AlignedBox2d PostsOf(int level, int column, int row) const;
  Bounds OnPlane(const Eigen::AlignedBox2d& block, const ClipmapRanges::Range& heights) const;
  Bounds OnBody(const Eigen::AlignedBox2d& block, const ClipmapRanges::Range& heights) const;
  bool BehindBody(const ClipmapViewVolume& sight, const Bounds& ball, double top) const;

  const ClipmapLevels& Levels_;
  const PostPlacement& Placement_;
  const std::array<double, 2>& Heights_;
  ClipmapRanges& Ranges_;
};

} // namespace dspace

#endif
