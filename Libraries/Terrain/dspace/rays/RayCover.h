// Bounds of patches and wheel tracks on a terrain's plain surface.
#ifndef DSPACE_TERRAIN_RAYCOVER_H
#define DSPACE_TERRAIN_RAYCOVER_H

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include <Eigen/Geometry>

#include <dspace/rays/RayTiles.h>

namespace dspace {

class GroupPosts;
class WheelTracks;

// Patches and wheel tracks on a raster. (c, r) counts blocks of 2^bits cells of level 0. A result
// holds for every corner post of the block. Any thread may call.
class RayCover {
public:
  // Either may be null. `postToScene` takes level-0 posts to the tracks' coordinates.
  RayCover(std::shared_ptr<const GroupPosts> group, std::shared_ptr<const WheelTracks> tracks,
           const Eigen::Affine2d& postToScene)
      : Group_(std::move(group)), Tracks_(std::move(tracks)), PostToScene_(postToScene) {}

  // False: the block's posts are those of the plain surface, but for their rounding.
  bool Reaches(int bits, std::int64_t c, std::int64_t r) const;
  // The range of heights if the plain surface lies within `plain`. Infinite if it is unknown.
  RayTile::Range Over(int bits, std::int64_t c, std::int64_t r, RayTile::Range plain) const;

private:
  using Key = std::array<std::int64_t, 3>; // bits, c, r
  Eigen::AlignedBox2d InScene(int bits, std::int64_t c, std::int64_t r) const;
  RayTile::Range OfPatches(int bits, std::int64_t c, std::int64_t r) const;

  std::shared_ptr<const GroupPosts> Group_;
  std::shared_ptr<const WheelTracks> Tracks_;
  Eigen::Affine2d PostToScene_;
  mutable std::mutex Mutex_;                        // of what follows
  mutable std::map<Key, RayTile::Range> OfPatches_; // which never change
};

} // namespace dspace

#endif
