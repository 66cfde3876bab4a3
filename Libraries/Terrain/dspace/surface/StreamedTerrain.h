// A raster of any size as a TerrainSurface. A pyramid of tiles provides the heights.
#ifndef DSPACE_TERRAIN_STREAMEDTERRAIN_H
#define DSPACE_TERRAIN_STREAMEDTERRAIN_H

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <dspace/crs/SceneFrame.h>
#include <dspace/groups/GroupPosts.h>
#include <dspace/posts/HeightGrid.h>
#include <dspace/posts/PostPlacement.h>
#include <dspace/pyramid/ElevationPyramid.h>
#include <dspace/raster/ElevationSource.h>
#include <dspace/raster/RasterPlace.h>
#include <dspace/surface/TerrainSurface.h>
#include <dspace/tracks/TrackedGround.h>

namespace dspace {

struct DegreeGrid;
struct PolarGrid;
class GroundTracks;
class TrackPosts;
class TerrainPosts;
class TerrainRays;

struct StreamedTerrainOptions {
  ElevationOptions elevation;
  // On a plane (SceneFrame): scene origin in map coordinates; the raster's middle by default.
  std::optional<Eigen::Vector2d> origin;
  double originHeight = 0.0; // [m] above the vertical datum, where scene z = 0
  // The terrain stands on the body: the scene is the body-fixed frame (Z to the north pole, X to
  // longitude 0). Height 0 is the CRS's sphere, with the radius of the vertical datum if it states
  // one, or its ellipsoid of revolution, along whose normals heights count. Requires a degree grid
  // (DegreeGridOf) or a polar stereographic projection of a sphere (PolarGridOf). A degree grid
  // that goes once around is closed across its edge, and over the poles if it reaches them.
  bool onBody = false;
  // Each cell between pixels is halved this many times; on a body at least as often as its size
  // asks. Wheel tracks need posts some centimetres apart. 0 to 12, on a body to 24.
  int subdivisions = 0;
  WheelTracksOptions tracks;
  // Fills holes that are within this many pixels of data (FilledPosts); infinity: all. Filled
  // ground is drawn and answers queries like other ground; Filled() distinguishes it. Patches lie
  // on it; over holes of the raster they are shown alone, without a margin. > 0; absent: holes
  // stay.
  std::optional<double> fillHoles;
  int cells = 124; // a side of the clipmap levels that draw it; sets the number of levels
  ElevationPyramidOptions pyramid;
  double deadline = 60.0; // [s] longest wait of a query for tiles
  // Patches of higher resolution, later ones on top; see GroupPosts. The finest sets level 0.
  std::vector<TerrainPatch> patches;
};

// A degree grid whose columns do not halve often enough is resampled along its parallels: posts lie
// on its surface, but not at its pixels.
struct ResamplingReport {
  std::int64_t columns = 0; // around the body instead of the raster's
  // The surface that is drawn and answered against the raster's pixels, at `posts` of them taken at
  // random. 0 posts: not measured.
  int posts = 0;
  double rmsError = 0.0;      // [m]
  double greatestError = 0.0; // [m]
};

// Posts stand at pixel centres. On a body, cells are divided until a chord departs from the sphere
// by at most a millimetre, and posts are resampled if ResamplingReport is present. Between the
// posts of level 0 are the triangles of HeightGrid: heights are linear in post coordinates. Queries
// read missing tiles and wait for them; results do not depend on what was drawn before. Any thread
// but a drawing one may query.
class StreamedTerrain : public TerrainSurface, public TrackedGround {
public:
  // Reads the raster's header and a sample for HeightRange(). Throws what ElevationSource throws,
  // and Error(Unsupported) for a raster that cannot stand on a body.
  static std::shared_ptr<StreamedTerrain> Open(const std::string& path,
                                               const StreamedTerrainOptions& options = {});
  ~StreamedTerrain() override;

  const ElevationInfo& Info() const;
  const std::shared_ptr<ElevationPyramid>& Pyramid() const;
  const PostPlacement& Placement() const { return this->Placement_; }
  // Least and greatest height [m]: exact where the raster has at most 4 million pixels, else that
  // of up to 512 x 512 of them widened by half to either side, a guess that only culling uses.
  const std::array<double, 2>& HeightRange() const { return this->HeightRange_; }
  bool HeightRangeIsExact() const { return this->HeightRangeIsExact_; }
  // Map coordinates to level-0 posts; without meaning outside a plane's map or the body.
  Eigen::Vector2d MapToPost(const Eigen::Vector2d& map) const;
  // Level-0 posts from pixels of the raster's corners: the place of an image that lies on it.
  const Eigen::Affine2d& PixelToPost() const;
  // On a plane only.
  const SceneFrame& Frame() const;
  std::uint64_t GetVersion() const override;
  // How often cells between pixels are halved: 2^n posts of level 0 a pixel.
  int Subdivisions() const;
  // Whether it goes from pole to pole of its body.
  bool ReachesPoles() const;
  // The result for each patch; null without patches.
  const GroupReport* Group() const;

  // The error of resampling; absent if every pixel is a post.
  const std::optional<ResamplingReport>& Resampling() const { return this->Resampling_; }
  // Uses the current overviews of the cache folder, here and in `others` (pole charts). Coarse
  // levels are read again; finer ones and queries do not change. Returns the number of overview
  // levels; 0 if there are none, and if holes are filled, because fills depend on the overviews at
  // opening. Throws what ElevationSource::LoadOverviews throws.
  int LoadOverviews(const std::vector<std::shared_ptr<ElevationPyramid>>& others = {});
  // The finest level with information of the raster; patches of a group have finer posts.
  int FullLevel() const;

  // Wheel tracks: TrackedGround's functions.

  // Posts without wheel tracks.
  const std::shared_ptr<const PostSource>& BarePosts() const;
  // Other posts of a body with its wheel tracks; a pyramid over them, which Follow() names, is read
  // again where tracks change.
  std::shared_ptr<const TrackPosts> TrackedPosts(std::shared_ptr<const PostSource> bare,
                                                 const PostPlacement& placement) const;
  void Follow(std::shared_ptr<const TrackPosts> posts,
              const std::shared_ptr<ElevationPyramid>& pyramid) const;

  // The ground without wheel tracks. Valid as long as this.
  const StreamedTerrain& Undisturbed() const;
  // HeightRange() widened by the greatest depth of ruts and height of rims.
  std::array<double, 2> DrawnHeights() const;

  // Writes to `filled`: 1 where the ground is filled (StreamedTerrainOptions::fillHoles), 0 where
  // it is between posts with data, NaN where there is none.
  void Filled(const Eigen::Ref<const Rows3>& points_S, Eigen::Ref<Eigen::VectorXd> filled) const;
  void FilledMap(const Eigen::Ref<const Rows2>& map, Eigen::Ref<Eigen::VectorXd> filled) const;
  bool FillsHoles() const;

  // Root mean square [m] of the heights of the raster's pixels within `radius` [m] of each point
  // about the plane that fits them best (least squares, of heights above the vertical datum): the
  // "RMS height" of Shepard et al., J. Geophys. Res. 106 (E12), 32777, 2001, detrended by a plane,
  // over n. Wheels' ruts count as deep as they are where a pixel stands. Distances are level: in
  // the scene on a plane, along the sphere on a body. NaN where fewer than 4 pixels with data, or
  // less than half of those there, span no plane. Throws Error(InvalidArgument) for a radius that
  // is not positive or reaches over 4 million pixels.
  void Roughness(const Eigen::Ref<const Rows3>& points_S, double radius,
                 Eigen::Ref<Eigen::VectorXd> roughness) const;

protected:
  GroundTracks& RequireTracks() const override;
  void TracksChanged(const std::vector<TrackReach>& changed) override;
  TerrainBounds DoGetBounds() const override;
  SurfaceSample DoSample(const Eigen::Vector3d& p_S) const override;
  SurfaceSample DoSampleMap(const Eigen::Vector2d& map) const override;
  RayHit DoIntersect(const Eigen::Vector3d& origin_S, const Eigen::Vector3d& unit_S,
                     double maximumDistance) const override;
  Eigen::Vector3d DoMapToScene(const Eigen::Vector3d& map) const override;
  Eigen::Vector3d DoSceneToMap(const Eigen::Vector3d& p_S) const override;
  Eigen::Vector3d DoUp(const Eigen::Vector3d& p_S) const override;
  Eigen::Vector3d DoNorth(const Eigen::Vector3d& p_S) const override;
  int DoResidentLevel(const Eigen::Vector2d& map) const override;
  void DoHeights(const Eigen::Ref<const Rows3>& points_S,
                 Eigen::Ref<Eigen::VectorXd> heights) const override;
  void DoHeightsMap(const Eigen::Ref<const Rows2>& map,
                    Eigen::Ref<Eigen::VectorXd> heights) const override;

private:
  StreamedTerrain(const std::string& name, std::shared_ptr<ElevationSource> source,
                  std::vector<std::string> warnings);
  void InitOnPlane(const StreamedTerrainOptions& options);
  void InitOnDegrees(const StreamedTerrainOptions& options);
  void InitAtPole(const StreamedTerrainOptions& options, const PolarGrid& grid);
  void Resample(const DegreeGrid& grid, const ElevationPyramidOptions& options);
  std::vector<Eigen::Vector2d> PostsOf(const Eigen::Ref<const Rows3>& points_S) const;
  void FindHeightBounds();
  void AddPatchReports();
  SurfaceSample SampleAt(const Eigen::Vector2d& post, const Eigen::Vector3d& vertical_S) const;
  Eigen::Vector3d NormalAt(const HeightGrid::Facet& facet, const Eigen::Vector3d& p_S) const;
  bool OnBody() const { return this->Placement_.OnBody(); }
  bool OnDegrees() const { return this->Placement_.GetKind() == PostPlacement::Kind::Sphere; }

  std::shared_ptr<ElevationSource> Source_;
  std::shared_ptr<TerrainPosts> Posts_;
  std::unique_ptr<TerrainRays> Rays_;
  PostPlacement Placement_;
  std::optional<SceneFrame> Frame_; // on a plane
  std::optional<ResamplingReport> Resampling_;
  std::shared_ptr<ElevationPyramid> Pixels_; // the raster's own where it is resampled, and their
  PostPlacement PixelPlacement_;             // places
  double Deadline_ = 60.0;
  std::array<double, 2> HeightRange_ = {0.0, 0.0};
  bool HeightRangeIsExact_ = false;
  mutable std::mutex Mutex_; // of what follows
  mutable std::vector<std::pair<std::shared_ptr<const TrackPosts>, std::weak_ptr<ElevationPyramid>>>
      Followers_;
  mutable std::unique_ptr<StreamedTerrain> Undisturbed_;
};

// Where its raster lies.
RasterPlace PlaceOf(const StreamedTerrain& terrain);

} // namespace dspace

#endif
