// A whole raster in memory at full resolution, as a TerrainSurface in a local metric frame.
#ifndef DSPACE_TERRAIN_GRIDTERRAIN_H
#define DSPACE_TERRAIN_GRIDTERRAIN_H

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <utility>
#include <vector>

#include <dspace/crs/SceneFrame.h>
#include <dspace/posts/HeightGrid.h>
#include <dspace/raster/ElevationSource.h>
#include <dspace/rays/GridRay.h>
#include <dspace/surface/TerrainSurface.h>
#include <dspace/tracks/TrackedGround.h>

namespace dspace {

struct GridTerrainOptions {
  ElevationOptions elevation;
  // Scene origin in map coordinates; the raster's middle by default.
  std::optional<Eigen::Vector2d> origin;
  double originHeight = 0.0; // [m] above the vertical datum, where scene z = 0
  // Greatest number of posts that is loaded; about 11 bytes each. Larger rasters are rejected.
  std::size_t maximumPosts = 100000000;
  // Each cell between pixels is halved this many times, on its own triangles: posts for wheel
  // tracks. 0 to 12.
  int subdivisions = 0;
  WheelTracksOptions tracks = {};
};

// Posts stand at pixel centres, and evenly between them where cells are halved; between posts are
// the triangles of HeightGrid, for heights, normals, slopes and rays alike. The frame is
// SceneFrame's; up is Z everywhere. Level 0 answers everywhere. Rotated, sheared, south-up and
// non-square pixels are taken as they are. The border is the line through the outermost posts, half
// a pixel inside the raster's edge; a whole body is not closed across its date line.
//
// Wheel tracks (TrackedGround) lower the posts where they stand, to full depth: between them the
// surface is flat, so that a rut is shown as wide as its posts and the next ones, and one between
// the posts of a raster not at all. Ruts do not count where posts are more than four times as far
// apart as they are wide. The first track doubles the memory of the posts. Other threads may
// query while tracks change; Grid() and Rolled() are for the thread that changes them.
class GridTerrain : public TerrainSurface, public TrackedGround {
public:
  // Throws what ElevationSource, HeightGrid and SceneFrame throw, and Error(Resource) for more than
  // maximumPosts.
  static std::shared_ptr<GridTerrain> Load(const std::string& path,
                                           const GridTerrainOptions& options = {});

  // From heights made elsewhere: [m] above `datum`, row by row from the top, NaN for none.
  // `pixelToMap` as in ElevationInfo.
  GridTerrain(const std::string& name, int columns, int rows, std::vector<double> heights,
              const Eigen::Affine2d& pixelToMap, const Crs& crs = {},
              const VerticalDatum& datum = {},
              const std::optional<Eigen::Vector2d>& origin = std::nullopt,
              double originHeight = 0.0, std::vector<std::string> warnings = {},
              const WheelTracksOptions& tracks = {});
  ~GridTerrain() override;

  const HeightGrid& Grid() const { return this->Grid_; }
  const SceneFrame& Frame() const { return this->Frame_; }
  std::uint64_t GetVersion() const override { return this->Version_; }
  // The ground without wheel tracks. Valid as long as this.
  const GridTerrain& Undisturbed() const {
    return this->Undisturbed_ ? *this->Undisturbed_ : *this;
  }
  // How much of a post was rolled over, 0 to 1; negative where neither a rut nor its rim reaches.
  float Rolled(int c, int r) const {
    return this->Rolled_.empty()
               ? -1.0f
               : this->Rolled_[static_cast<std::size_t>(r) * this->Grid_.GetColumns() + c];
  }
  // Rectangles of posts that tracks have changed since the last call.
  std::vector<PostRectangle> TakeChanges() { return std::exchange(this->Changes_, {}); }
  // How often cells between pixels are halved.
  int Subdivisions() const { return this->Subdivisions_; }
  // Pixel corners to map, of the posts that are loaded (a window's own); where cells are halved, of
  // pixels as wide as posts are apart.
  const Eigen::Affine2d& PixelToMap() const { return this->PixelToMap_; }

protected:
  GroundTracks& RequireTracks() const override { return *this->Tracks_; }
  void TracksChanged(const std::vector<TrackReach>& changed) override;
  TerrainBounds DoGetBounds() const override;
  SurfaceSample DoSample(const Eigen::Vector3d& p_S) const override;
  SurfaceSample DoSampleMap(const Eigen::Vector2d& map) const override;
  RayHit DoIntersect(const Eigen::Vector3d& origin_S, const Eigen::Vector3d& unit_S,
                     double maximumDistance) const override;
  Eigen::Vector3d DoMapToScene(const Eigen::Vector3d& map) const override;
  Eigen::Vector3d DoSceneToMap(const Eigen::Vector3d& p_S) const override;
  Eigen::Vector3d DoUp(const Eigen::Vector3d& p_S) const override;
  int DoResidentLevel(const Eigen::Vector2d& map) const override;
  void DoHeights(const Eigen::Ref<const Rows3>& points_S,
                 Eigen::Ref<Eigen::VectorXd> heights) const override;

private:
  SurfaceSample SampleGrid(const Eigen::Vector2d& g, const Eigen::Vector2d& xy_S) const;

  Eigen::Affine2d PixelToMap_;
  SceneFrame Frame_;
  std::shared_lock<std::shared_mutex> Reading() const;
  mutable std::shared_mutex Mutex_; // of the heights
  mutable std::mutex Turn_;         // of a writer, for which readers make way
  std::atomic<bool> Writing_{false};
  HeightGrid Grid_;
  GridRay Ray_;
  std::unique_ptr<GroundTracks> Tracks_;           // over the undisturbed posts
  std::shared_ptr<const GridTerrain> Undisturbed_; // since the first track
  bool Disturbed_ = false;                         // there are tracks
  std::vector<float> Rolled_;                      // a post; empty before the first track
  std::vector<PostRectangle> Changes_;
  std::uint64_t Version_ = 0;
  int Subdivisions_ = 0;
};

} // namespace dspace

#endif
