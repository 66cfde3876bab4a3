#include <dspace/rays/RayCover.h>

#include <cmath>

#include <dspace/groups/GroupPosts.h>
#include <dspace/tracks/WheelTracks.h>

namespace dspace {
namespace {

constexpr std::size_t MaximumCachedBlocks = 200000; // blocks; some 20 MB

Eigen::AlignedBox2d Posts(int bits, std::int64_t c, std::int64_t r) {
  const double size = std::ldexp(1.0, bits);
  const Eigen::Vector2d first = size * Eigen::Vector2d(double(c), double(r));
  return {first, first + Eigen::Vector2d::Constant(size)};
}

} // namespace

Eigen::AlignedBox2d RayCover::InScene(int bits, std::int64_t c, std::int64_t r) const {
  const Eigen::AlignedBox2d posts = Posts(bits, c, r);
  Eigen::AlignedBox2d box;
  for (int i = 0; i < 4; ++i) {
    box.extend(this->PostToScene_ * posts.corner(Eigen::AlignedBox2d::CornerType(i)));
  }
  const Eigen::Vector2d rounding = Eigen::Vector2d::Constant(1e-6) + 1e-12 * box.max().cwiseAbs();
  return {box.min() - rounding, box.max() + rounding};
}

bool RayCover::Reaches(int bits, std::int64_t c, std::int64_t r) const {
  return (this->Group_ && this->Group_->Reaches(Posts(bits, c, r))) ||
         (this->Tracks_ && this->Tracks_->Reaches(this->InScene(bits, c, r)));
}

RayTile::Range RayCover::OfPatches(int bits, std::int64_t c, std::int64_t r) const {
  const Key key = {bits, c, r};
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    const auto known = this->OfPatches_.find(key);
    if (known != this->OfPatches_.end()) {
      return known->second;
    }
  }
  const std::array<double, 2> heights = this->Group_->PatchHeights(Posts(bits, c, r));
  // Floats are rounded to either side; empty and infinite ranges stay what they are.
  const RayTile::Range range = {std::nextafter(float(heights[0]), -HUGE_VALF),
                                std::nextafter(float(heights[1]), HUGE_VALF)};
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  if (this->OfPatches_.size() >= MaximumCachedBlocks) {
    this->OfPatches_.clear();
  }
  this->OfPatches_[key] = range;
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
  if (this->Tracks_ && this->Tracks_->Reaches(this->InScene(bits, c, r))) {
    const std::array<double, 2> change = this->Tracks_->Changes();
    plain.least = std::nextafter(float(double(plain.least) + change[0]), -HUGE_VALF);
    plain.greatest = std::nextafter(float(double(plain.greatest) + change[1]), HUGE_VALF);
  }
  return plain;
}

} // namespace dspace
