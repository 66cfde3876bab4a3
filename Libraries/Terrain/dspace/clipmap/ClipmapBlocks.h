// Selects the blocks of a clipmap's levels that a view may see. No OpenGL.
#ifndef DSPACE_TERRAIN_CLIPMAPBLOCKS_H
#define DSPACE_TERRAIN_CLIPMAPBLOCKS_H

#include <array>
#include <vector>

#include <dspace/clipmap/ClipmapLevels.h>
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
  // `heights` [m] are those that the posts stay within. All of it outlives this.
  ClipmapBlocks(const ClipmapLevels& levels, const PostPlacement& placement,
                const std::array<double, 2>& heights)
      : Levels_(levels), Placement_(placement), Heights_(heights) {}

  // Runs of indices of a level's blocks that are not surely out of sight, joined where they follow
  // each other. `finest`: the finest level that is drawn; the others have its hole.
  std::vector<ClipmapIndices::Run>
  Seen(const ClipmapIndices& indices, const ClipmapViewVolume& sight, int level, int finest) const;

private:
  Eigen::AlignedBox2d PostsOf(int level, int column, int row) const;
  bool OutsideOnPlane(const ClipmapViewVolume& sight, const Eigen::AlignedBox2d& block) const;
  bool HiddenOnBody(const ClipmapViewVolume& sight, const Eigen::AlignedBox2d& block) const;

  const ClipmapLevels& Levels_;
  const PostPlacement& Placement_;
  const std::array<double, 2>& Heights_;
};

} // namespace dspace

#endif
