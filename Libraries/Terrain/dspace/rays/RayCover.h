// Bounds of patches and wheel tracks on a terrain's plain surface.
#ifndef DSPACE_TERRAIN_RAYCOVER_H
#define DSPACE_TERRAIN_RAYCOVER_H

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include <Eigen/Geometry>

#include <dspace/groups/GroupProbe.h>
#include <dspace/posts/PostPlacement.h>
#include <dspace/rays/RangeTable.h>
#include <dspace/rays/RayTiles.h>

namespace dspace {

class GroupPosts;
class WheelTracks;

// Patches and wheel tracks on a raster. (c, r) counts blocks of 2^bits cells of level 0. A result
// holds for every corner post of the block. Any thread may call.
class RayCover {
public:
  // Either may be null. `placement` is that of level-0 posts. `probes`: single posts may be read by
  // the calling thread.
  RayCover(std::shared_ptr<const GroupPosts> group, std::shared_ptr<const WheelTracks> tracks,
           const PostPlacement& placement, bool probes = false)
      : Group_(std::move(group)), Tracks_(std::move(tracks)), Placement_(placement),
        Probes_(probes) {}

  // False: the block's posts are those of the plain surface, but for their rounding.
  bool Reaches(int bits, std::int64_t c, std::int64_t r) const;
  // Reads the posts of blocks that no track reaches; null where blocks are to be read.
  std::unique_ptr<GroupProbe> MakeProbe() const;
  bool ReachedByTracks(int bits, std::int64_t c, std::int64_t r) const;
  // The range of heights if the plain surface lies within `plain`. Infinite if it is unknown.
  // Of a block of at most 2^PatchProbe::Bits cells without tracks. `plain()` gives the plain range.
  template<typename Plain>
  RayTile::Range Over(GroupProbe& probe, int bits, std::int64_t c, std::int64_t r,
                      const Plain& plain) const;
  RayTile::Range Over(int bits, std::int64_t c, std::int64_t r, RayTile::Range plain) const;

private:
  RayTile::Range OfPatches(int bits, std::int64_t c, std::int64_t r) const;

  std::shared_ptr<const GroupPosts> Group_;
  std::shared_ptr<const WheelTracks> Tracks_;
  PostPlacement Placement_;
  bool Probes_;
  mutable RangeTable Ranges_; // of patches; up to 2^PatchProbe::Bits cells with the ground below
};

template<typename Plain>
RayTile::Range RayCover::Over(GroupProbe& probe, int bits, std::int64_t c, std::int64_t r,
                              const Plain& plain) const {
  constexpr int Least = 6; // lesser blocks are cheap
  RayTile::Range known;
  if (bits >= Least && this->Ranges_.Find(bits, c, r, known)) {
    return known;
  }
  const std::array<double, 2> heights = probe.Over(bits, c, r, [&] {
    const RayTile::Range range = plain();
    // Level 0 of a subdivided raster is rounded again.
    return std::array<double, 2>{std::nextafter(range.least, -HUGE_VALF),
                                 std::nextafter(range.greatest, HUGE_VALF)};
  });
  if (heights[0] <= heights[1]) {
    known = {std::nextafter(float(heights[0]), -HUGE_VALF),
             std::nextafter(float(heights[1]), HUGE_VALF)};
  }
  if (bits >= Least) {
    this->Ranges_.Insert(bits, c, r, known);
  }
  return known;
}

} // namespace dspace

#endif
