// The posts of a streamed terrain: layers over a raster, their pyramid, and the surfaces between
// them. Not for public headers.
#ifndef DSPACE_TERRAIN_TERRAINPOSTS_H
#define DSPACE_TERRAIN_TERRAINPOSTS_H

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <dspace/crs/SceneFrame.h>
#include <dspace/groups/GroupPosts.h>
#include <dspace/posts/RasterPosts.h>
#include <dspace/pyramid/ElevationPyramid.h>
#include <dspace/pyramid/PostSurface.h>
#include <dspace/raster/ElevationSource.h>
#include <dspace/surface/TerrainRays.h>

namespace dspace {

class FilledPosts;
class GroundTracks;
struct StreamedTerrainOptions;

// Layers from bottom to top: the raster's posts, filled holes, patches, wheel tracks. Layers that
// the options do not ask for are absent. Const functions may be called from any thread.
class TerrainPosts {
public:
  // How the raster's posts form a lattice.
  struct Layout {
    int subdivisions = 0; // see RasterPostsOptions; patches may need more
    bool periodic = false;
    bool poles = false;
  };

  using PlacementOf = std::function<PostPlacement(const PostLattice& lattice, int subdivisions)>;

  // `name` is for messages. `frame` is the scene on a plane; null on a body, where
  // `placementOf` says how posts of a lattice with so many subdivisions stand. Throws what
  // RasterPosts, OpenPatches, FilledPosts and WheelTracks throw.
  TerrainPosts(const std::string& name, std::shared_ptr<ElevationSource> source,
               const StreamedTerrainOptions& options, const Layout& layout, const SceneFrame* frame,
               const PlacementOf& placementOf = {});
  ~TerrainPosts();
  TerrainPosts(const TerrainPosts&) = delete;
  TerrainPosts& operator=(const TerrainPosts&) = delete;

  // Layers. Group() and Tracks() may be null.
  const RasterPosts& Raster() const { return *this->Raster_; }
  const std::shared_ptr<const GroupPosts>& Group() const { return this->Group_; }
  GroundTracks* Tracks() const { return this->Tracks_.get(); }
  bool FillsHoles() const { return this->Filled_ != nullptr; }
  // Whether there are wheel tracks now.
  bool Tracked() const;

  const std::shared_ptr<ElevationPyramid>& Pyramid() const { return this->Pyramid_; }
  const PostLattice& Lattice() const { return this->Pyramid_->Lattice(); }
  int Subdivisions() const { return this->Subdivisions_; }
  // The finest level with information of the raster.
  int FullLevel() const { return this->FullLevel_; }
  // The level of the surface without tracks.
  int SurfaceLevel() const { return this->Surface_->Level(); }
  bool Poles() const { return this->Poles_; }

  // To level-0 posts, from pixels of the raster's corners and from the raster's map.
  const Eigen::Affine2d& PixelToPost() const { return this->PixelToPost_; }
  const Eigen::Affine2d& MapToPost() const { return this->MapToPost_; }
  // Level-0 posts to the scene on a plane.
  Eigen::Affine2d PostToScene(const SceneFrame& frame) const;

  // The surface that answers at a place in level-0 posts.
  const PostSurface& SurfaceAt(const Eigen::Vector2d& post) const;
  // Heights at many places; NaN where there is no surface. Each surface is called once.
  void Heights(const std::vector<Eigen::Vector2d>& posts,
               Eigen::Ref<Eigen::VectorXd> heights) const;
  // 1 where the ground is filled, 0 where it is between posts with data, NaN where there is none.
  void Filled(const std::vector<Eigen::Vector2d>& posts, Eigen::Ref<Eigen::VectorXd> filled) const;
  // Posts of pixels with ruts at full depth, not the means of coarser posts, and without filled
  // posts.
  void ReadPixels(const PostBlock& block, float* heights) const;
  // For rays on these posts; this must outlive them.
  std::unique_ptr<TerrainRays> MakeRays(const PostPlacement& placement) const;

  // The same posts without wheel tracks, with a small pyramid of their own. Created on demand.
  // Requires Tracks().
  std::shared_ptr<TerrainPosts> Bare() const;

  // The options of a second pyramid of the same terrain, with a sixteenth of the memory.
  static ElevationPyramidOptions SmallPyramid(const ElevationPyramidOptions& options);

  // See StreamedTerrain::LoadOverviews.
  int LoadOverviews(const std::vector<std::shared_ptr<ElevationPyramid>>& others);

private:
  TerrainPosts() = default;
  const PostSurface& Surface() const { return this->Tracked() ? *this->Tracked_ : *this->Surface_; }

  std::shared_ptr<ElevationSource> Source_;
  std::shared_ptr<RasterPosts> Raster_;
  std::shared_ptr<const FilledPosts> Filled_;
  std::shared_ptr<const PostSurface> Holed_; // the surface without filled posts
  std::shared_ptr<const GroupPosts> Group_;
  std::unique_ptr<GroundTracks> Tracks_;
  std::shared_ptr<ElevationPyramid> Pyramid_;
  std::unique_ptr<PostSurface> Surface_;
  std::unique_ptr<PostSurface> Plain_;   // of a group: the raster's posts, where no patch reaches
  std::unique_ptr<PostSurface> Tracked_; // of level 0: ruts are between the raster's posts
  RayGround RayGround_;
  Eigen::Affine2d PixelToPost_ = Eigen::Affine2d::Identity();
  Eigen::Affine2d MapToPost_ = Eigen::Affine2d::Identity();
  bool Poles_ = false;
  int Subdivisions_ = 0;
  int FullLevel_ = 0;
  double Deadline_ = 60.0;   // [s]
  mutable std::mutex Mutex_; // of Bare_
  mutable std::shared_ptr<TerrainPosts> Bare_;
};

} // namespace dspace

#endif
