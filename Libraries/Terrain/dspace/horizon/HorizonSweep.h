// The elevation of the horizon at the posts of a terrain, in one azimuth.
#ifndef DSPACE_TERRAIN_HORIZONSWEEP_H
#define DSPACE_TERRAIN_HORIZONSWEEP_H

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <dspace/horizon/HeldPosts.h>
#include <dspace/posts/PostPlacement.h>
#include <dspace/pyramid/ElevationPyramid.h>

namespace dspace {

struct HorizonOptions {
  int near = 16;   // posts of the level: nearer ground is no distant occluder; 1 to `posts` / 2
  int posts = 256; // of a level that are followed before the next coarser one; a power of two from
                   // 64 to 4096
  std::array<double, 2> heights = {0, 0}; // [m] that all ground lies between
  double above = 0.0;                     // [m] of the observers over their posts, >= 0
  // Places of ground that are found to a thousandth of a degree everywhere: of a body the line of
  // sight is followed on a great circle between more places, and where columns crowd about a pole
  // of a degree grid of up to 131072 columns at every edge too.
  bool fine = false;
  // About 1.6 times as fast, to half a degree where slopes are up to 0.3. Beyond `FastExact` posts
  // the samples are 1 / FastExact of the distance apart. The sweep skips ground that cannot raise a
  // horizon by more than FastSlack.
  bool fast = false;
  static constexpr int FastExact = 24;
  static constexpr float FastSlack = 0.003f; // of the tangent: 0.17 degrees
};

// What a sweep read, and how much it did.
struct HorizonReport {
  std::vector<PostBlock> read; // or blocks around what it read
  std::uint64_t steps = 0;     // posts times places of ground that each was compared with
  std::uint64_t skipped = 0;   // the same, that the greatest heights ruled out
};

// At each post of a block of a level the tangent of the elevation over the plane that is normal to
// the local vertical (of a plane Z, of a body that of its sphere or ellipsoid) of all ground in an
// azimuth of the chart (HorizonPath).
//
// The ground is the level's own triangles up to `posts` posts away, followed at every edge that the
// line of sight crosses: exact but for floats. Farther away it is each coarser level from half of
// `posts` to `posts` of its own posts away, bilinear between them, at every half post. Its posts
// are means: where the ground departs from a coarse level's surface by up to d metres at a distance
// D, the tangent errs by up to d / D. Ground of slopes up to m departs by up to m of a post's
// spacing, hence by up to 2 m / posts: m = 0.3 and 256 posts give 0.13 degrees at most, a quarter
// of the Sun's disc, and in the mean a tenth of that (TestHorizonSweep measures it). The sweep goes
// on until the greatest height could not be seen over the horizon that is already found: over a
// body's curvature, on a plane to the end of the data. A stencil march: along a row of posts every
// place has the same offsets and weights (within 32 posts of a pole's chart, to second order, and
// with HorizonOptions::fine within as many as differ by 5e-4 of a distance at most).
// Bands of distance whose greatest height cannot raise a row's horizon are skipped, and where posts
// are held runs of some 8 posts that cannot raise the horizon of a group of 16 lanes.
//
// Holes, and what lies outside the data, are no occluders. Where nothing is in sight, the tangent
// is None; where the post itself has no data, NaN. The last post of a row or column that a level
// does not divide evenly counts as a whole post away from the last but one.
class HorizonSweep {
public:
  static constexpr float None = -1e6f;

  // Throws Error(InvalidArgument) for an option out of range.
  HorizonSweep(std::shared_ptr<ElevationPyramid> pyramid, const PostPlacement& placement,
               const HorizonOptions& options);

  // Sweeps of level 0 at every held->Every()-th post then read nothing of that level.
  void Hold(std::shared_ptr<const HeldPosts> held) { this->Held_ = std::move(held); }
  const HeldPosts* Held() const { return this->Held_.get(); }

  // Rows of the block's posts: `all` ground, and `distant` ground beyond HorizonOptions::near posts
  // alone (null: not wanted). Any azimuth [deg]. Waits for tiles; throws what
  // ElevationPyramid::Read throws, and Error(InvalidArgument) for an azimuth that is not finite or
  // a block that is empty or of a level that there is not. Any thread may call.
  HorizonReport Sweep(const PostBlock& block, double azimuth_deg, float* all, float* distant,
                      double seconds = std::numeric_limits<double>::infinity()) const;
  // `all` alone, for every `every`-th post of every `every`-th row of level 0 from (block.column,
  // block.row) on; the block's width and height count these. `every`: 1 to 64.
  HorizonReport SweepEvery(const PostBlock& block, int every, double azimuth_deg, float* all,
                           double seconds = std::numeric_limits<double>::infinity()) const;

  const PostPlacement& Placement() const { return this->Placement_; }
  const std::shared_ptr<ElevationPyramid>& Pyramid() const { return this->Pyramid_; }
  const HorizonOptions& Options() const { return this->Options_; }

private:
  HorizonReport SweepParts(const PostBlock& block, int every, double azimuth_deg, float* all,
                           float* distant, double seconds) const;

  std::shared_ptr<ElevationPyramid> Pyramid_;
  PostPlacement Placement_;
  HorizonOptions Options_;
  std::shared_ptr<const HeldPosts> Held_;
};

} // namespace dspace

#endif
