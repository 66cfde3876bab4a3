// How a StreamedTerrain comes about: place, posts, range of heights and warnings.
#include <dspace/surface/StreamedTerrain.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <dspace/Error.h>
#include <dspace/clipmap/arithmetic/ClipmapWindow.h>
#include <dspace/pyramid/FilledPosts.h>
#include <dspace/posts/RasterPosts.h>

#include <dspace/raster/DegreeGrid.h>
#include <dspace/raster/NetworkScope.h>
#include <dspace/pyramid/PostSurface.h>
#include <dspace/surface/ResamplingError.h>
#include <dspace/rays/SurfaceRay.h>
#include <dspace/surface/TerrainWarnings.h>

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;
constexpr double Departure = 1e-3;          // [m] of a flat cell's middle from the sphere, at most
constexpr std::int64_t ReadWhole = 4000000; // pixels whose heights are all looked at
constexpr int Sampled = 512;                // else so many along the raster's longer side

Eigen::Vector2d MiddleOf(const ElevationInfo& info) {
  return info.pixelToMap * Eigen::Vector2d(0.5 * info.window.width, 0.5 * info.window.height);
}

// A square of side s departs from the sphere most in its middle, by (s sqrt 2)^2 / 8R.
int SubdivisionsFor(const DegreeGrid& grid) {
  const double side = grid.radius * grid.step_deg.cwiseAbs().maxCoeff() * Degree;
  const double allowed = std::sqrt(4.0 * grid.radius * Departure);
  const int needed = int(std::ceil(std::log2(std::max(1.0, side / allowed))));
  return std::max(needed, grid.poles ? 1 : 0);
}

} // namespace

std::shared_ptr<const StreamedTerrain>
StreamedTerrain::Open(const std::string& path, const StreamedTerrainOptions& options) {
  const std::string name = "terrain '" + path + "'";
  if (options.onBody && (options.origin || options.originHeight != 0.0)) {
    throw Error(Error::Kind::InvalidArgument, name,
                "an origin was given, but on a body the scene's origin is its centre");
  }
  if (!(options.deadline > 0.0)) {
    throw Error(Error::Kind::InvalidArgument, name,
                "deadline " + std::to_string(options.deadline) +
                    " s given; accepted is a positive number");
  }
  if (options.subdivisions < 0 || options.subdivisions > (options.onBody ? 0 : 12)) {
    throw Error(Error::Kind::InvalidArgument, name,
                std::to_string(options.subdivisions) + " subdivisions are refused; accepted is " +
                    (options.onBody ? "0: on a body they follow from its size" : "0 to 12"));
  }
  ClipmapGeometry geometry(options.cells); // refuses what is out of range
  auto source = std::make_shared<const ElevationSource>(path, options.elevation);
  if (options.onBody && DegreeGridOf(source->Info()).repeats) {
    ElevationOptions once = options.elevation;
    once.window = source->Info().window;
    --once.window->width;
    source = std::make_shared<const ElevationSource>(path, once);
  }
  std::vector<std::string> warnings = WarningsOfPlace(source->Info(), !options.onBody);
  const std::shared_ptr<StreamedTerrain> terrain(
      new StreamedTerrain(name, std::move(source), std::move(warnings)));
  terrain->Deadline_ = options.deadline;
  if (options.onBody) {
    terrain->StandOnBody(options);
  } else {
    terrain->StandOnPlane(options);
  }
  terrain->FindHeightRange();
  terrain->TakePatches();
  return terrain;
}

void StreamedTerrain::StandOnPlane(const StreamedTerrainOptions& options) {
  const ElevationInfo& info = this->Info();
  this->Frame_.emplace(info.crs, options.origin.value_or(MiddleOf(info)), options.originHeight);
  this->Subdivisions_ = options.subdivisions;
  this->MakePyramid(options, false, false);
  this->Placement_ = PostPlacement::OnPlane(this->PlanePosts(), options.originHeight);
}

void StreamedTerrain::StandOnBody(const StreamedTerrainOptions& options) {
  const DegreeGrid grid = DegreeGridOf(this->Info());
  this->Subdivisions_ = SubdivisionsFor(grid);
  const RasterWindow& window = this->Info().window;
  if (grid.periodic && ColumnsAround(window.width, window.height - (grid.poles ? 0 : 1),
                                     CoarsestFor(options.cells)) != window.width) {
    this->Subdivisions_ = std::max(this->Subdivisions_, RasterPosts::Finer);
  }
  this->MakePyramid(options, grid.periodic, grid.poles);
  const double parts = std::ldexp(1.0, this->Subdivisions_);
  const PostLattice& lattice = this->Pyramid_->Lattice();
  Eigen::Vector2d step = grid.step_deg / parts;
  if (grid.periodic) {
    step.x() = std::copysign(360.0 / double(lattice.columns), step.x());
  }
  Eigen::Vector2d first = grid.first_deg;
  if (grid.poles) {
    first.y() = 90.0;
  }
  this->Placement_ =
      PostPlacement::OnSphere(first, step, grid.radius, 0.5 * double(lattice.columns - 1));
  if (this->Posts_->Stretch() != 1.0) {
    this->Resample(grid, options.pyramid);
  }
}

// Its own pixels, for what is asked of them, and what the others cost.
void StreamedTerrain::Resample(const DegreeGrid& grid, const ElevationPyramidOptions& options) {
  RasterPostsOptions own;
  own.periodic = true;
  own.levels = 1;
  ElevationPyramidOptions small = options;
  small.byteBudget = std::max(options.byteBudget / 16, std::size_t(4) << 20);
  const auto pixels = std::make_shared<const RasterPosts>(this->Source_, own);
  this->Pixels_ = std::make_shared<ElevationPyramid>(pixels, small);
  this->PixelPlacement_ = PostPlacement::OnSphere(grid.first_deg, grid.step_deg, grid.radius,
                                                  0.5 * double(pixels->GetLattice().columns - 1));
  this->Resampling_ = MeasureResampling(*this->Posts_);
  std::ostringstream text;
  text.precision(3);
  text << "its " << this->Info().window.width << " columns around the body are resampled to "
       << this->Resampling_->columns << ", which halve often enough: what is drawn and answered "
       << "departs from its pixels by " << this->Resampling_->rmsError << " m rms, at most "
       << this->Resampling_->greatestError << " m, at " << this->Resampling_->posts
       << " of them taken at random";
  this->AddWarning(text.str());
}

void StreamedTerrain::MakePyramid(const StreamedTerrainOptions& options, bool periodic,
                                  bool poles) {
  const ElevationInfo& info = this->Info();
  std::optional<OpenPatches> patches;
  if (!options.patches.empty()) {
    patches.emplace(info, options.patches);
    this->Subdivisions_ = std::max(this->Subdivisions_, patches->Subdivisions());
  }
  RasterPostsOptions posts;
  posts.subdivisions = this->Subdivisions_;
  posts.periodic = periodic;
  posts.poles = poles;
  posts.coarsest = CoarsestFor(options.cells);
  if (periodic) {
    posts.columns =
        ColumnsAround(info.window.width, info.window.height - (poles ? 0 : 1), posts.coarsest);
  }
  auto raster = std::make_shared<const RasterPosts>(this->Source_, posts);
  this->Posts_ = raster;
  this->Poles_ = poles;
  const double parts = std::ldexp(1.0, this->Subdivisions_);
  const double across = parts / raster->Stretch();
  this->PixelToPost_.linear() = Eigen::Vector2d(across, parts).asDiagonal();
  this->PixelToPost_.translation() << -0.5 * across, poles ? 0.0 : -0.5 * parts;
  this->MapToPost_ = this->PixelToPost_ * info.pixelToMap.inverse();
  std::shared_ptr<const PostSource> source = raster;
  if (options.fillHoles) {
    this->Filled_ = std::make_shared<const FilledPosts>(raster, *options.fillHoles);
    source = this->Filled_;
  }
  const std::shared_ptr<const PostSource> base = source;
  this->Ground_ = base;
  this->FullLevel_ = raster->FullLevel();
  int level = this->FullLevel_;
  if (patches) {
    this->Group_ =
        std::make_shared<const GroupPosts>(base, this->MapToPost_.inverse(), poles,
                                           std::move(*patches), this->Filled_ ? raster : nullptr);
    source = this->Group_;
    level = 0; // patches have posts between those of the raster
  }
  if (this->Filled_) {
    ElevationPyramidOptions small = options.pyramid;
    small.byteBudget = std::max(options.pyramid.byteBudget / 16, std::size_t(4) << 20);
    const std::shared_ptr<const PostSource> holed =
        this->Group_ ? std::shared_ptr<const PostSource>(
                           this->Group_->On(raster, info.crs, this->MapToPost_.inverse()))
                     : std::shared_ptr<const PostSource>(raster);
    this->Holed_ = std::make_shared<const PostSurface>(
        std::make_shared<ElevationPyramid>(holed, small), level, poles, options.deadline);
  }
  if (this->Frame_) {
    source = this->WithTracks(source, options);
  }
  this->Pyramid_ = std::make_shared<ElevationPyramid>(source, options.pyramid);
  // A group's tiles hold far more posts than pixels were read.
  const bool local =
      !IsRemote(GdalPath(info.path)) &&
      std::none_of(options.patches.begin(), options.patches.end(),
                   [](const TerrainPatch& patch) { return IsRemote(GdalPath(patch.path)); });
  const bool scattered = this->Group_ && local;
  this->Surface_ =
      std::make_unique<PostSurface>(this->Pyramid_, level, poles, options.deadline, scattered);
  if (this->Group_) {
    this->Plain_ =
        std::make_unique<PostSurface>(this->Pyramid_, this->FullLevel_, poles, options.deadline);
  }
  this->BottomOptions_ = options.pyramid;
  this->BottomOptions_.byteBudget = std::size_t(4) << 20; // rays keep what they need
  this->BottomOptions_.threads = 1;
  if (this->Tracks_) {
    this->Tracked_ =
        std::make_unique<PostSurface>(this->Pyramid_, 0, poles, options.deadline, scattered);
  }
}

void StreamedTerrain::FindHeightRange() {
  const RasterWindow window = this->Info().window;
  this->HeightRangeIsExact_ = std::int64_t(window.width) * window.height <= ReadWhole;
  // As a grid on a plane, which on a body is the one of longitudes and latitudes.
  Eigen::Affine2d postToScene = this->Placement_.PostToScene();
  if (this->OnBody()) {
    postToScene.linear() = (this->Placement_.Radius() * this->Placement_.Step()).asDiagonal();
  }
  // Pixels, not means: the mean of ups and downs is neither.
  int factor = 1;
  while (!this->HeightRangeIsExact_ && std::max(window.width, window.height) / factor > Sampled) {
    factor *= 2;
  }
  std::vector<double> heights =
      this->Source_->ReadReduced({0, 0, window.width, window.height}, factor);
  const int columns = 1 + (window.width - 1) / factor;
  const int rows = 1 + (window.height - 1) / factor;
  if (!this->HeightRangeIsExact_) {
    // The first picture's first level; it need not be waited for here.
    const PostLattice& lattice = this->Pyramid_->Lattice();
    const int top = lattice.levels - 1;
    const PostBlock coarsest{top, 0, 0, int(lattice.ColumnsAt(top)), int(lattice.RowsAt(top))};
    std::vector<float> posts(std::size_t(coarsest.width) * coarsest.height);
    this->Pyramid_->TryRead(coarsest, posts.data());
    if (std::all_of(heights.begin(), heights.end(), [](double h) { return std::isnan(h); })) {
      this->AddWarning(
          "of its " + std::to_string(window.width) + " x " + std::to_string(window.height) +
          " pixels, the " + std::to_string(columns) + " x " + std::to_string(rows) +
          " that were looked at have no data: it may hold no heights at all, or what it "
          "states as no data is wrong");
      return; // there may be heights between
    }
  }
  postToScene.linear() = postToScene.linear() * this->PixelToPost_.linear() * double(factor);
  const HeightGrid grid(this->GetName(), columns, rows, std::move(heights), postToScene);
  this->HeightRange_ = {grid.GetMinimum(), grid.GetMaximum()};
  Eigen::AlignedBox3d box;
  for (const double c : {0.0, columns - 1.0}) {
    for (const double r : {0.0, rows - 1.0}) {
      const Eigen::Vector2d p = grid.ToScene({c, r});
      for (const double h : this->HeightRange_) {
        box.extend(Eigen::Vector3d(p.x(), p.y(), h));
      }
    }
  }
  for (std::string& warning : WarningsOfRelief(grid, box)) {
    this->AddWarning(std::move(warning));
  }
  if (!this->HeightRangeIsExact_) {
    const double half = 0.5 * (this->HeightRange_[1] - this->HeightRange_[0]);
    this->HeightRange_ = {this->HeightRange_[0] - half, this->HeightRange_[1] + half};
  }
  if (this->OnBody() && !(this->HeightRange_[0] > -this->Placement_.Radius()) &&
      this->HeightRangeIsExact_) {
    throw Error(Error::Kind::InvalidArgument, this->GetName(),
                "a height of " + std::to_string(this->HeightRange_[0]) +
                    " m lies below the body's centre");
  }
}

// Their warnings and heights.
void StreamedTerrain::TakePatches() {
  if (!this->Group_) {
    return;
  }
  for (const std::string& warning : this->Group_->Report().warnings) {
    this->AddWarning(warning);
  }
  for (const PatchReport& patch : this->Group_->Report().patches) {
    if (patch.used) {
      const double more = patch.heightsAreExact ? 0.0 : 0.5 * (patch.heights[1] - patch.heights[0]);
      this->HeightRange_ = {std::min(this->HeightRange_[0], patch.heights[0] - more),
                            std::max(this->HeightRange_[1], patch.heights[1] + more)};
      this->HeightRangeIsExact_ = this->HeightRangeIsExact_ && patch.heightsAreExact;
    }
  }
}

TerrainBounds StreamedTerrain::DoGetBounds() const {
  const PostLattice& lattice = this->Pyramid_->Lattice();
  TerrainBounds bounds;
  // A lattice that goes around has no last post: its map ends a column further.
  const Eigen::Vector2d end(double(lattice.columns - (lattice.periodic ? 0 : 1)),
                            double(lattice.rows - 1));
  const Eigen::Affine2d postToMap = this->MapToPost_.inverse();
  for (const double c : {0.0, end.x()}) {
    for (const double r : {0.0, end.y()}) {
      const Eigen::Vector2d map = postToMap * Eigen::Vector2d(c, r);
      bounds.map.extend(map);
      for (const double h : this->HeightRange_) {
        if (!this->OnBody()) {
          bounds.scene.extend(this->Placement_.ToScene({c, r}, h));
        }
      }
    }
  }
  if (!this->OnBody()) {
    return bounds;
  }
  // Sines and cosines have their extremes at the ends and at whole quarters of a turn between.
  const auto places = [](double first, double last) {
    std::vector<double> angles = {first, last};
    const double low = std::min(first, last);
    for (double a = std::ceil(low / (0.5 * M_PI)) * 0.5 * M_PI; a < std::max(first, last);
         a += 0.5 * M_PI) {
      angles.push_back(a);
    }
    return angles;
  };
  const Eigen::Vector2d& first = this->Placement_.First();
  const Eigen::Vector2d last = first + end.cwiseProduct(this->Placement_.Step());
  for (const double longitude : places(first.x(), last.x())) {
    for (const double latitude : places(first.y(), last.y())) {
      const Eigen::Vector2d post =
          (Eigen::Vector2d(longitude, latitude) - first).cwiseQuotient(this->Placement_.Step());
      for (const double h : this->HeightRange_) {
        bounds.scene.extend(this->Placement_.ToScene(post, h));
      }
    }
  }
  return bounds;
}

} // namespace dspace
