// Rays on a StreamedTerrain.
#include <dspace/surface/StreamedTerrain.h>

#include <dspace/posts/RasterPosts.h>

#include <dspace/pyramid/PostSurface.h>
#include <dspace/rays/SurfaceRay.h>

namespace dspace {

// The ground without patches and tracks: rays are spared reading finer ones where these say enough.
const PostSurface& StreamedTerrain::Bottom() const {
  std::call_once(this->BottomOnce_, [this] {
    this->Bottom_ = std::make_unique<PostSurface>(
        std::make_shared<ElevationPyramid>(this->Ground_, this->BottomOptions_), this->FullLevel_,
        this->Poles_, this->Deadline_);
  });
  return *this->Bottom_;
}

const SurfaceRay& StreamedTerrain::Ray() const {
  const auto covered = [this](const PostSurface& surface, std::shared_ptr<const WheelTracks> of) {
    return std::make_unique<SurfaceRay>(
        surface, &this->Bottom(),
        std::make_unique<RayCover>(this->Group_, std::move(of), this->Placement_.PostToScene()));
  };
  if (this->Tracked()) {
    std::call_once(this->TrackedRayOnce_,
                   [&] { this->TrackedRay_ = covered(*this->Tracked_, this->Tracks_); });
    return *this->TrackedRay_;
  }
  std::call_once(this->RayOnce_, [&] {
    this->Ray_ = this->Group_ ? covered(*this->Surface_, nullptr)
                              : std::make_unique<SurfaceRay>(*this->Surface_);
  });
  return *this->Ray_;
}

RayHit StreamedTerrain::DoIntersect(const Eigen::Vector3d& origin_S, const Eigen::Vector3d& unit_S,
                                    double maximumDistance) const {
  const double most = 1e9; // [m] that heights are within
  const RayPath path(this->Placement_, this->Pyramid_->Lattice(), origin_S, unit_S, maximumDistance,
                     this->HeightRangeIsExact_ ? this->DrawnHeights()[0] : -most,
                     this->HeightRangeIsExact_ ? this->DrawnHeights()[1] : most);
  const SurfaceRay::Hit found = this->Ray().Intersect(path);
  RayHit hit;
  if (!found.hit || found.distance > maximumDistance) {
    return hit;
  }
  hit.hit = true;
  hit.fromBelow = found.fromBelow;
  hit.distance = found.distance;
  hit.position_S = origin_S + found.distance * unit_S;
  hit.normal_S = this->NormalAt(found.facet, hit.position_S);
  return hit;
}

} // namespace dspace
