#include <dspace/surface/TerrainRays.h>

#include <utility>

namespace dspace {

TerrainRays::TerrainRays(RayGround ground, const PostSurface& surface,
                         std::shared_ptr<const GroupPosts> group, const PostSurface* tracked,
                         std::shared_ptr<const WheelTracks> tracks, const PostPlacement& placement)
    : Ground_(std::move(ground)), Surface_(surface), Group_(std::move(group)), Tracked_(tracked),
      Tracks_(std::move(tracks)), Placement_(placement) {}

const PostSurface& TerrainRays::Bottom() const {
  std::call_once(this->BottomOnce_, [this] {
    this->Bottom_ = std::make_unique<PostSurface>(
        std::make_shared<ElevationPyramid>(this->Ground_.posts, this->Ground_.options),
        this->Ground_.level, this->Ground_.poles, this->Ground_.deadline);
  });
  return *this->Bottom_;
}

std::unique_ptr<SurfaceRay> TerrainRays::Covered(const PostSurface& surface,
                                                 std::shared_ptr<const WheelTracks> tracks) const {
  return std::make_unique<SurfaceRay>(surface, &this->Bottom(),
                                      std::make_unique<RayCover>(this->Group_, std::move(tracks),
                                                                 this->Placement_,
                                                                 this->Ground_.probes));
}

const SurfaceRay& TerrainRays::Get() const {
  if (this->Tracks_ && !this->Tracks_->Empty()) {
    std::call_once(this->TrackedRayOnce_,
                   [this] { this->TrackedRay_ = this->Covered(*this->Tracked_, this->Tracks_); });
    return *this->TrackedRay_;
  }
  std::call_once(this->RayOnce_, [this] {
    this->Ray_ = this->Group_ ? this->Covered(this->Surface_, nullptr)
                              : std::make_unique<SurfaceRay>(this->Surface_);
  });
  return *this->Ray_;
}

} // namespace dspace
