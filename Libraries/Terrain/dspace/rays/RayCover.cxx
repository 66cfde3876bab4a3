#include <dspace/rays/RayCover.h>

#include <cmath>
#include <optional>

#include <dspace/groups/GroupPosts.h>
#include <dspace/tracks/TrackMap.h>
#include <dspace/tracks/WheelTracks.h>

namespace dspace {
namespace {

Eigen::AlignedBox2d Posts(int bits, std::int64_t c, std::int64_t r) {
  const double size = std::ldexp(1.0, bits);
  const Eigen::Vector2d first = size * Eigen::Vector2d(double(c), double(r));
  return {first, first + Eigen::Vector2d::Constant(size)};
}

} // namespace

bool RayCover::Reaches(int bits, std::int64_t c, std::int64_t r) const {
  return (this->Group_ && this->Group_->Reaches(Posts(bits, c, r))) ||
         this->ReachedByTracks(bits, c, r);
}

std::unique_ptr<GroupProbe> RayCover::MakeProbe() const {
  return this->Probes_ && this->Group_ ? this->Group_->MakeGroupProbe() : nullptr;
}

bool RayCover::ReachedByTracks(int bits, std::int64_t c, std::int64_t r) const {
  const std::optional<TrackMap> map =
      this->Tracks_ ? TrackMap::Of(this->Placement_, *this->Tracks_) : std::nullopt;
  if (!map) {
    return false;
  }
  const Eigen::AlignedBox2d box = map->BoxOf(Posts(bits, c, r));
  const Eigen::Vector2d rounding = Eigen::Vector2d::Constant(1e-6) + 1e-12 * box.max().cwiseAbs();
  return this->Tracks_->Reaches({box.min() - rounding, box.max() + rounding});
}

RayTile::Range RayCover::OfPatches(int bits, std::int64_t c, std::int64_t r) const {
  RayTile::Range range;
  if (this->Ranges_.Find(bits, c, r, range)) {
    return range;
  }
  const std::array<double, 2> heights = this->Group_->PatchHeights(Posts(bits, c, r));
  // Floats are rounded to either side; empty and infinite ranges stay what they are.
  range = {std::nextafter(float(heights[0]), -HUGE_VALF),
           std::nextafter(float(heights[1]), HUGE_VALF)};
  this->Ranges_.Insert(bits, c, r, range);
  return range;
}

RayTile::Range RayCover::Over(int bits, std::int64_t c, std::int64_t r,
                              RayTile::Range plain) const {
  if (this->Group_) {
    // A blend of two heights lies between them.
    plain.Widen(this->OfPatches(bits, c, r));
  }
  if (plain.least > plain.greatest) {
    return plain; // holes stay holes
  }
  // Level 0 of a subdivided raster is rounded again.
  plain.least = std::nextafter(plain.least, -HUGE_VALF);
  plain.greatest = std::nextafter(plain.greatest, HUGE_VALF);
  if (this->ReachedByTracks(bits, c, r)) {
    const std::array<double, 2> change = this->Tracks_->Changes();
    plain.least = std::nextafter(float(double(plain.least) + change[0]), -HUGE_VALF);
    plain.greatest = std::nextafter(float(double(plain.greatest) + change[1]), HUGE_VALF);
  }
  return plain;
}

} // namespace dspace
