// The data structures for rays on a terrain, created for the first ray. Not for public
// headers.
#ifndef DSPACE_TERRAIN_TERRAINRAYS_H
#define DSPACE_TERRAIN_TERRAINRAYS_H

#include <memory>
#include <mutex>

#include <dspace/groups/GroupPosts.h>
#include <dspace/tracks/WheelTracks.h>

#include <dspace/rays/SurfaceRay.h>

namespace dspace {

// Posts without patches and tracks: rays are spared reading finer ones where these say enough.
struct RayGround {
  std::shared_ptr<const PostSource> posts;
  ElevationPyramidOptions options;
  int level = 0; // whose posts say all
  bool poles = false;
  double deadline = 60.0; // [s]
  bool probes = false;    // the calling thread may read single posts
};

class TerrainRays {
public:
  // The surfaces must outlive this. `group` is null without patches; `tracked` and `tracks` are
  // null where there can be no wheel tracks. `placement` is that of level-0 posts.
  TerrainRays(RayGround ground, const PostSurface& surface, std::shared_ptr<const GroupPosts> group,
              const PostSurface* tracked, std::shared_ptr<const WheelTracks> tracks,
              const PostPlacement& placement);

  // For the surface as it is now. Any thread may call.
  const SurfaceRay& Get() const;

private:
  const PostSurface& Bottom() const;
  std::unique_ptr<SurfaceRay> Covered(const PostSurface& surface,
                                      std::shared_ptr<const WheelTracks> tracks) const;

  RayGround Ground_;
  const PostSurface& Surface_;
  std::shared_ptr<const GroupPosts> Group_;
  const PostSurface* Tracked_;
  std::shared_ptr<const WheelTracks> Tracks_;
  PostPlacement Placement_;
  mutable std::once_flag BottomOnce_;
  mutable std::unique_ptr<PostSurface> Bottom_;
  mutable std::once_flag RayOnce_;
  mutable std::unique_ptr<SurfaceRay> Ray_;
  mutable std::once_flag TrackedRayOnce_;
  mutable std::unique_ptr<SurfaceRay> TrackedRay_;
};

} // namespace dspace

#endif
