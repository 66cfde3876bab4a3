#include <dspace/surface/TerrainPosts.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <dspace/clipmap/arithmetic/ClipmapWindow.h>
#include <dspace/pyramid/FilledPosts.h>
#include <dspace/raster/NetworkScope.h>
#include <dspace/surface/StreamedTerrain.h>
#include <dspace/tracks/GroundTracks.h>

namespace dspace {
namespace {

constexpr std::size_t SmallestBudget = std::size_t(4) << 20;

bool IsLocal(const std::string& path) {
  return !IsRemote(GdalPath(path));
}

} // namespace

TerrainPosts::TerrainPosts(const std::string& name, std::shared_ptr<ElevationSource> source,
                           const StreamedTerrainOptions& options, const Layout& layout,
                           const SceneFrame* frame, const PlacementOf& placementOf)
    : Source_(std::move(source)), Poles_(layout.poles), Subdivisions_(layout.subdivisions),
      Deadline_(options.deadline) {
  const ElevationInfo& info = this->Source_->Info();
  std::optional<OpenPatches> patches;
  if (!options.patches.empty()) {
    patches.emplace(info, options.patches);
    this->Subdivisions_ = std::max(this->Subdivisions_, patches->Subdivisions());
  }
  const bool poles = this->Poles_;
  RasterPostsOptions posts;
  posts.subdivisions = this->Subdivisions_;
  posts.periodic = layout.periodic;
  posts.poles = poles;
  posts.coarsest = CoarsestFor(options.cells);
  if (layout.periodic) {
    posts.columns =
        ColumnsAround(info.window.width, info.window.height - (poles ? 0 : 1), posts.coarsest);
  }
  this->Raster_ = std::make_shared<RasterPosts>(this->Source_, posts);
  const std::shared_ptr<const RasterPosts> raster = this->Raster_;
  const double parts = std::ldexp(1.0, this->Subdivisions_);
  const double across = parts / raster->Stretch();
  this->PixelToPost_.linear() = Eigen::Vector2d(across, parts).asDiagonal();
  this->PixelToPost_.translation() << -0.5 * across, poles ? 0.0 : -0.5 * parts;
  this->MapToPost_ = this->PixelToPost_ * info.pixelToMap.inverse();
  const Eigen::Affine2d postToMap = this->MapToPost_.inverse();

  std::shared_ptr<const PostSource> top = raster;
  if (options.fillHoles) {
    this->Filled_ = std::make_shared<const FilledPosts>(this->Raster_, *options.fillHoles);
    top = this->Filled_;
  }
  const std::shared_ptr<const PostSource> base = top;
  this->FullLevel_ = raster->FullLevel();
  int level = this->FullLevel_;
  if (patches) {
    this->Group_ = std::make_shared<const GroupPosts>(base, postToMap, poles, std::move(*patches),
                                                      this->Filled_ ? raster : nullptr);
    top = this->Group_;
    level = 0; // patches have posts between those of the raster
  }
  if (this->Filled_) {
    const std::shared_ptr<const PostSource> holed =
        this->Group_
            ? std::shared_ptr<const PostSource>(this->Group_->WithBase(raster, info.crs, postToMap))
            : std::shared_ptr<const PostSource>(raster);
    this->Holed_ = std::make_shared<const PostSurface>(
        std::make_shared<ElevationPyramid>(holed, SmallPyramid(options.pyramid)), level, poles,
        options.deadline);
  }
  if (frame) {
    this->Tracks_ = std::make_unique<GroundTracks>(name, top, this->PostToScene(*frame), *frame,
                                                   info.crs, options.tracks);
    top = this->Tracks_->Posts();
  } else {
    this->Tracks_ = std::make_unique<GroundTracks>(
        name, top, placementOf(top->GetLattice(), this->Subdivisions_), this->MapToPost_, info.crs,
        options.tracks);
    top = this->Tracks_->Posts();
  }
  this->Pyramid_ = std::make_shared<ElevationPyramid>(top, options.pyramid);
  // A tile of a group has far more posts than pixels are read: single posts are cheaper.
  const bool scattered = this->Group_ && IsLocal(info.path) &&
                         std::all_of(options.patches.begin(), options.patches.end(),
                                     [](const TerrainPatch& patch) { return IsLocal(patch.path); });
  this->Surface_ =
      std::make_unique<PostSurface>(this->Pyramid_, level, poles, options.deadline, scattered);
  if (this->Group_) {
    this->Plain_ =
        std::make_unique<PostSurface>(this->Pyramid_, this->FullLevel_, poles, options.deadline);
  }
  if (this->Tracks_) {
    this->Tracked_ =
        std::make_unique<PostSurface>(this->Pyramid_, 0, poles, options.deadline, scattered);
  }
  this->RayGround_ = RayGround{base, options.pyramid, this->FullLevel_, poles, options.deadline};
  this->RayGround_.options.byteBudget = SmallestBudget; // rays have a cache of their own
  this->RayGround_.options.threads = 1;
  this->RayGround_.probes = scattered;
}

TerrainPosts::~TerrainPosts() = default;

ElevationPyramidOptions TerrainPosts::SmallPyramid(const ElevationPyramidOptions& options) {
  ElevationPyramidOptions small = options;
  small.byteBudget = std::max(options.byteBudget / 16, SmallestBudget);
  return small;
}

Eigen::Affine2d TerrainPosts::PostToScene(const SceneFrame& frame) const {
  // SceneFrame::PostToScene() places posts half a unit from the corner.
  const Eigen::Affine2d postToMap =
      this->Source_->Info().pixelToMap *
      (this->PixelToPost_.inverse() * Eigen::Translation2d(-0.5, -0.5));
  return frame.PostToScene(postToMap);
}

bool TerrainPosts::Tracked() const {
  return this->Tracks_ && !this->Tracks_->Empty();
}

const PostSurface& TerrainPosts::SurfaceAt(const Eigen::Vector2d& post) const {
  const bool plain =
      this->Plain_ && !this->Tracked() && !this->Group_->Reaches(post, this->Plain_->Level());
  return plain ? *this->Plain_ : this->Surface();
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a Ref is a view that is written through
void TerrainPosts::Heights(const std::vector<Eigen::Vector2d>& posts,
                           Eigen::Ref<Eigen::VectorXd> heights) const {
  std::map<const PostSurface*, std::vector<std::size_t>> parts;
  for (std::size_t i = 0; i < posts.size(); ++i) {
    parts[&this->SurfaceAt(posts[i])].push_back(i);
  }
  for (const auto& [surface, indices] : parts) {
    std::vector<Eigen::Vector2d> places;
    places.reserve(indices.size());
    for (const std::size_t i : indices) {
      places.push_back(posts[i]);
    }
    const std::vector<std::size_t>& at = indices; // bindings are not captured
    surface->At(places, [&](std::size_t k, const HeightGrid::Facet& facet) {
      heights[Eigen::Index(at[k])] =
          facet.valid ? facet.height : std::numeric_limits<double>::quiet_NaN();
    });
  }
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a Ref is a view that is written through
void TerrainPosts::Filled(const std::vector<Eigen::Vector2d>& posts,
                          Eigen::Ref<Eigen::VectorXd> filled) const {
  this->Heights(posts, filled);
  for (double& height : filled) {
    height = std::isnan(height) ? height : (this->Holed_ ? 1.0 : 0.0);
  }
  if (this->Holed_) {
    this->Holed_->At(posts, [&](std::size_t i, const HeightGrid::Facet& facet) {
      if (facet.valid) {
        filled[Eigen::Index(i)] = 0.0;
      }
    });
  }
}

void TerrainPosts::ReadPixels(const PostBlock& block, float* heights) const {
  if (this->Tracked()) {
    this->Bare()->Pyramid_->Read(block, heights, this->Deadline_);
    this->Tracks_->Posts()->Lower(block, heights);
  } else {
    this->Pyramid_->Read(block, heights, this->Deadline_);
  }
  if (this->Holed_) {
    std::vector<float> own(std::size_t(block.width) * block.height);
    this->Holed_->SharedPyramid()->Read(block, own.data(), this->Deadline_);
    for (std::size_t k = 0; k < own.size(); ++k) {
      heights[k] = std::isnan(own[k]) ? own[k] : heights[k];
    }
  }
}

std::unique_ptr<TerrainRays> TerrainPosts::MakeRays(const PostPlacement& placement) const {
  return std::make_unique<TerrainRays>(
      this->RayGround_, *this->Surface_, this->Group_, this->Tracked_.get(),
      this->Tracks_ ? this->Tracks_->Tracks() : nullptr, placement);
}

std::shared_ptr<TerrainPosts> TerrainPosts::Bare() const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  if (!this->Bare_) {
    ElevationPyramidOptions options;
    options.byteBudget = std::size_t(16) << 20;
    const std::shared_ptr<TerrainPosts> bare(new TerrainPosts);
    bare->Source_ = this->Source_;
    bare->Raster_ = this->Raster_;
    bare->Filled_ = this->Filled_;
    bare->Holed_ = this->Holed_;
    bare->Group_ = this->Group_;
    bare->Pyramid_ = std::make_shared<ElevationPyramid>(this->Tracks_->Bare(), options);
    bare->Surface_ = std::make_unique<PostSurface>(bare->Pyramid_, this->Surface_->Level(),
                                                   this->Poles_, this->Deadline_);
    if (this->Plain_) {
      bare->Plain_ = std::make_unique<PostSurface>(bare->Pyramid_, this->Plain_->Level(),
                                                   this->Poles_, this->Deadline_);
    }
    bare->RayGround_ = this->RayGround_;
    bare->PixelToPost_ = this->PixelToPost_;
    bare->MapToPost_ = this->MapToPost_;
    bare->Poles_ = this->Poles_;
    bare->Subdivisions_ = this->Subdivisions_;
    bare->FullLevel_ = this->FullLevel_;
    bare->Deadline_ = this->Deadline_;
    this->Bare_ = bare;
  }
  return this->Bare_;
}

int TerrainPosts::LoadOverviews(const std::vector<std::shared_ptr<ElevationPyramid>>& others) {
  if (this->Filled_) { // fills depend on coarse levels, also in finer tiles that are loaded already
    return 0;
  }
  const int levels = this->Source_->LoadOverviews();
  if (levels > 0) {
    this->Raster_->InvalidateReduced();
    std::vector<std::shared_ptr<ElevationPyramid>> pyramids = others;
    pyramids.push_back(this->Pyramid_);
    for (const std::shared_ptr<ElevationPyramid>& pyramid : pyramids) {
      PostRectangle coarse{0, 0, pyramid->Lattice().columns, pyramid->Lattice().rows};
      coarse.from = this->Raster_->FirstReducedLevel();
      pyramid->Invalidate({coarse});
    }
  }
  return levels;
}

} // namespace dspace
