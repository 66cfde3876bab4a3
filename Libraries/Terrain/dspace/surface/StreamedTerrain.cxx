#include <dspace/surface/StreamedTerrain.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <dspace/Error.h>
#include <dspace/clipmap/arithmetic/ClipmapWindow.h>
#include <dspace/tracks/GroundTracks.h>

#include <dspace/posts/ChartAxes.h>
#include <dspace/raster/DegreeGrid.h>
#include <dspace/raster/PolarGrid.h>
#include <dspace/surface/HeightRange.h>
#include <dspace/surface/PixelRoughness.h>
#include <dspace/surface/ResamplingError.h>
#include <dspace/surface/TerrainPosts.h>
#include <dspace/surface/TerrainRays.h>
#include <dspace/surface/TerrainWarnings.h>

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;
constexpr double Departure = 1e-3; // [m] of a flat cell's middle from the sphere, at most

Eigen::Vector2d MiddleOf(const ElevationInfo& info) {
  return info.pixelToMap * Eigen::Vector2d(0.5 * info.window.width, 0.5 * info.window.height);
}

// A square of side s departs from the sphere most in its middle, by (s sqrt 2)^2 / 8R.
int SubdivisionsFor(const BodyEllipsoid& body, double side) {
  // An ellipsoid bends most along the meridian at the equator.
  const double allowed = std::sqrt(4.0 * body.NorthRadius(0.0) * Departure);
  return int(std::ceil(std::log2(std::max(1.0, side / allowed))));
}

int SubdivisionsFor(const DegreeGrid& grid) {
  const double side = grid.body.Equatorial() * grid.step_deg.cwiseAbs().maxCoeff() * Degree;
  return std::max(SubdivisionsFor(grid.body, side), grid.poles ? 1 : 0);
}

// A CRS given by hand stands for a file's wrong one, but no other body has this ellipsoid.
void RequireOwnEllipsoid(const std::string& path, const ElevationOptions& options,
                         const ElevationInfo& info) {
  const BodyAxes& given = info.crs.GetAxes();
  if (!options.crs || given.semiMajor == given.semiMinor) {
    return;
  }
  Crs own;
  try {
    ElevationOptions plain = options;
    plain.crs.reset();
    own = ElevationSource(path, plain).Info().crs;
  } catch (const Error&) { // what is wrong with it is replaced
    return;
  }
  const double radius = own.GetAxes().semiMajor;
  if (radius > 0.0 && std::abs(radius - given.semiMajor) > 0.005 * radius) {
    throw Error(Error::Kind::InvalidArgument, "raster '" + path + "'",
                "the CRS given, '" + info.crs.GetName() +
                    "', is of an ellipsoid with a radius of " + std::to_string(given.semiMajor) +
                    " m; the file's own, '" + own.GetName() + "', is of a body of " +
                    std::to_string(radius) + " m; accepted is a CRS of that body");
  }
}

void RequireResults(const std::string& name, bool finite, Eigen::Index n, Eigen::Index results) {
  if (!finite || n != results) {
    throw Error(Error::Kind::InvalidArgument, name,
                "accepted: finite points and one result per point");
  }
}

} // namespace

StreamedTerrain::StreamedTerrain(const std::string& name, std::shared_ptr<ElevationSource> source,
                                 std::vector<std::string> warnings)
    : TerrainSurface(name, source->Info().crs, source->Info().verticalDatum, std::move(warnings)),
      Source_(std::move(source)) {}

StreamedTerrain::~StreamedTerrain() = default;

const std::shared_ptr<ElevationPyramid>& StreamedTerrain::Pyramid() const {
  return this->Posts_->Pyramid();
}

const Eigen::Affine2d& StreamedTerrain::PixelToPost() const {
  return this->Posts_->PixelToPost();
}

std::uint64_t StreamedTerrain::GetVersion() const {
  return this->Pyramid()->Arrivals();
}

int StreamedTerrain::Subdivisions() const {
  return this->Posts_->Subdivisions();
}

bool StreamedTerrain::ReachesPoles() const {
  return this->Posts_->Poles();
}

const GroupReport* StreamedTerrain::Group() const {
  return this->Posts_->Group() ? &this->Posts_->Group()->Report() : nullptr;
}

int StreamedTerrain::FullLevel() const {
  return this->Posts_->FullLevel();
}

bool StreamedTerrain::FillsHoles() const {
  return this->Posts_->FillsHoles();
}

std::shared_ptr<StreamedTerrain> StreamedTerrain::Open(const std::string& path,
                                                       const StreamedTerrainOptions& options) {
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
  if (options.subdivisions < 0 ||
      options.subdivisions > (options.onBody ? RasterPosts::Most : 12)) {
    throw Error(Error::Kind::InvalidArgument, name,
                std::to_string(options.subdivisions) + " subdivisions are rejected; accepted is " +
                    (options.onBody ? "0 to 24" : "0 to 12"));
  }
  ClipmapGeometry geometry(options.cells); // rejects what is out of range
  ElevationOptions elevation = options.elevation;
  elevation.closesAround = options.onBody;
  auto source = std::make_shared<ElevationSource>(path, elevation);
  if (options.onBody) {
    RequireOwnEllipsoid(path, options.elevation, source->Info());
  }
  const std::optional<PolarGrid> polar =
      options.onBody ? PolarGridOf(source->Info()) : std::nullopt;
  if (options.onBody && !polar && DegreeGridOf(source->Info()).repeats) {
    ElevationOptions once = elevation;
    once.mapWindow.reset();
    once.window = source->Info().window;
    --once.window->width;
    source = std::make_shared<ElevationSource>(path, once);
  }
  std::vector<std::string> warnings = WarningsOfPlace(source->Info(), !options.onBody);
  const std::shared_ptr<StreamedTerrain> terrain(
      new StreamedTerrain(name, std::move(source), std::move(warnings)));
  terrain->Deadline_ = options.deadline;
  if (polar) {
    terrain->InitAtPole(options, *polar);
  } else if (options.onBody) {
    terrain->InitOnDegrees(options);
  } else {
    terrain->InitOnPlane(options);
  }
  terrain->FindHeightBounds();
  terrain->AddPatchReports();
  terrain->Rays_ = terrain->Posts_->MakeRays(terrain->Placement_);
  return terrain;
}

void StreamedTerrain::InitOnPlane(const StreamedTerrainOptions& options) {
  const ElevationInfo& info = this->Info();
  this->Frame_.emplace(info.crs, options.origin.value_or(MiddleOf(info)), options.originHeight);
  TerrainPosts::Layout layout;
  layout.subdivisions = options.subdivisions;
  this->Posts_ = std::make_shared<TerrainPosts>(this->GetName(), this->Source_, options, layout,
                                                &*this->Frame_);
  this->Placement_ =
      PostPlacement::OnPlane(this->Posts_->PostToScene(*this->Frame_), options.originHeight);
}

void StreamedTerrain::InitAtPole(const StreamedTerrainOptions& options, const PolarGrid& grid) {
  TerrainPosts::Layout layout;
  const double side = 2.0 * grid.body.Equatorial() * grid.step; // at the pole, where it is greatest
  layout.subdivisions = std::max(SubdivisionsFor(grid.body, side), options.subdivisions);
  const auto placementOf = [&grid](const PostLattice& /*lattice*/, int subdivisions) {
    const double posts = std::ldexp(1.0, subdivisions);
    return PostPlacement::AtPole(grid.south, grid.step / posts, grid.pole * posts, grid.east_deg,
                                 grid.body);
  };
  this->Posts_ = std::make_shared<TerrainPosts>(this->GetName(), this->Source_, options, layout,
                                                nullptr, placementOf);
  this->Placement_ = placementOf(this->Posts_->Lattice(), this->Subdivisions());
}

void StreamedTerrain::InitOnDegrees(const StreamedTerrainOptions& options) {
  const DegreeGrid grid = DegreeGridOf(this->Info());
  TerrainPosts::Layout layout;
  layout.subdivisions = std::max(SubdivisionsFor(grid), options.subdivisions);
  layout.periodic = grid.periodic;
  layout.poles = grid.poles;
  const RasterWindow& window = this->Info().window;
  if (grid.periodic && ColumnsAround(window.width, window.height - (grid.poles ? 0 : 1),
                                     CoarsestFor(options.cells)) != window.width) {
    layout.subdivisions = std::max(layout.subdivisions, RasterPosts::Finer);
  }
  const auto placementOf = [&grid](const PostLattice& lattice, int subdivisions) {
    Eigen::Vector2d step = grid.step_deg / std::ldexp(1.0, subdivisions);
    if (grid.periodic) {
      step.x() = std::copysign(360.0 / double(lattice.columns), step.x());
    }
    Eigen::Vector2d first = grid.first_deg;
    if (grid.poles) {
      first.y() = 90.0;
    }
    return PostPlacement::OnEllipsoid(first, step, grid.body, 0.5 * double(lattice.columns - 1));
  };
  this->Posts_ = std::make_shared<TerrainPosts>(this->GetName(), this->Source_, options, layout,
                                                nullptr, placementOf);
  this->Placement_ = placementOf(this->Posts_->Lattice(), this->Subdivisions());
  if (this->Posts_->Raster().Stretch() != 1.0) {
    this->Resample(grid, options.pyramid);
  }
}

// Prepares queries of the raster's own pixels, and measures the error of the resampled posts.
void StreamedTerrain::Resample(const DegreeGrid& grid, const ElevationPyramidOptions& options) {
  RasterPostsOptions own;
  own.periodic = true;
  own.levels = 1;
  const auto pixels = std::make_shared<const RasterPosts>(this->Source_, own);
  this->Pixels_ = std::make_shared<ElevationPyramid>(pixels, TerrainPosts::SmallPyramid(options));
  this->PixelPlacement_ = PostPlacement::OnEllipsoid(
      grid.first_deg, grid.step_deg, grid.body, 0.5 * double(pixels->GetLattice().columns - 1));
  this->Resampling_ = MeasureResampling(this->Posts_->Raster());
  std::ostringstream text;
  text.precision(3);
  text << "its " << this->Info().window.width << " columns around the body are resampled to "
       << this->Resampling_->columns
       << ", which can be halved often enough: the drawn and queried surface "
       << "differs from its pixels by " << this->Resampling_->rmsError << " m rms, at most "
       << this->Resampling_->greatestError << " m, at " << this->Resampling_->posts
       << " random pixels";
  this->AddWarning(text.str());
}

void StreamedTerrain::FindHeightBounds() {
  const dspace::HeightRange range = FindHeightRange(
      this->GetName(), *this->Source_, this->Placement_, this->PixelToPost(), *this->Pyramid());
  this->HeightRange_ = range.heights;
  this->HeightRangeIsExact_ = range.exact;
  for (const std::string& warning : range.warnings) {
    this->AddWarning(warning);
  }
}

// Adds the warnings of the patches, and widens the range of heights by theirs.
void StreamedTerrain::AddPatchReports() {
  const GroupReport* group = this->Group();
  if (!group) {
    return;
  }
  for (const std::string& warning : group->warnings) {
    this->AddWarning(warning);
  }
  for (const PatchReport& patch : group->patches) {
    if (patch.used) {
      const double more = patch.heightsAreExact ? 0.0 : 0.5 * (patch.heights[1] - patch.heights[0]);
      this->HeightRange_ = {std::min(this->HeightRange_[0], patch.heights[0] - more),
                            std::max(this->HeightRange_[1], patch.heights[1] + more)};
      this->HeightRangeIsExact_ = this->HeightRangeIsExact_ && patch.heightsAreExact;
    }
  }
}

TerrainBounds StreamedTerrain::DoGetBounds() const {
  const PostLattice& lattice = this->Posts_->Lattice();
  TerrainBounds bounds;
  // A lattice that goes around has no last post: its map ends a column further.
  const Eigen::Vector2d end(double(lattice.columns - (lattice.periodic ? 0 : 1)),
                            double(lattice.rows - 1));
  const Eigen::Affine2d postToMap = this->Posts_->MapToPost().inverse();
  for (const double c : {0.0, end.x()}) {
    for (const double r : {0.0, end.y()}) {
      bounds.map.extend(Eigen::Vector2d(postToMap * Eigen::Vector2d(c, r)));
    }
  }
  bounds.scene = this->Placement_.BoundsOf(end, this->HeightRange_[0], this->HeightRange_[1]);
  return bounds;
}

const ElevationInfo& StreamedTerrain::Info() const {
  return this->Source_->Info();
}

const SceneFrame& StreamedTerrain::Frame() const {
  if (!this->Frame_) {
    throw Error(Error::Kind::Unsupported, this->GetName(),
                "it stands on a body; only a terrain on a plane has a scene frame");
  }
  return *this->Frame_;
}

Eigen::Vector2d StreamedTerrain::MapToPost(const Eigen::Vector2d& map) const {
  Eigen::Vector2d post = this->Posts_->MapToPost() * map;
  if (this->OnDegrees()) { // towards the data
    const double turn = 2.0 * M_PI / std::abs(this->Placement_.Step().x());
    const double last = double(this->Posts_->Lattice().columns) - 1.0;
    if (this->Posts_->Lattice().periodic) {
      post.x() -= turn * std::floor(post.x() / turn);
    } else if (post.x() < 0.0 || post.x() > last) {
      post.x() -= turn * std::round((post.x() - 0.5 * last) / turn);
    }
  }
  return post;
}

// Unit, upward, of the facet at a place of the surface.
Eigen::Vector3d StreamedTerrain::NormalAt(const HeightGrid::Facet& facet,
                                          const Eigen::Vector3d& p_S) const {
  const Eigen::Vector2d rise(facet.dc, facet.dr);
  if (!this->OnBody()) {
    const Eigen::Vector2d g = this->Placement_.SceneToPost().linear().transpose() * rise;
    return Eigen::Vector3d(-g.x(), -g.y(), 1.0).normalized();
  }
  if (!this->OnDegrees()) {
    const Eigen::Vector2d post = this->Placement_.ToPosts(p_S).head<2>();
    const ChartAxes axes = ChartAxesAt(this->Placement_, post);
    const double radius = this->Placement_.Radius();
    const double metres = this->Placement_.CellSize(post) * (radius + facet.height) / radius;
    return (axes.up - (rise.x() * axes.east - rise.y() * axes.north) / metres).normalized();
  }
  // p = (R + h(c, r)) up(c, r): its derivatives by c and r span the tangent plane. On an ellipsoid
  // the radii are those of curvature.
  const Eigen::Vector3d up = this->Placement_.Up(p_S);
  const BodyEllipsoid& body = this->Placement_.Body();
  const bool sphere = body.Spherical();
  const double distance = (sphere ? body.Equatorial() : body.EastRadius(up.z())) + facet.height;
  const double along = (sphere ? body.Equatorial() : body.NorthRadius(up.z())) + facet.height;
  const double parallel = std::max(up.head<2>().norm(), 1e-12); // cosine of the latitude
  const Eigen::Vector3d north = this->DoNorth(p_S);
  const Eigen::Vector3d east = north.cross(up);
  const Eigen::Vector2d& step = this->Placement_.Step();
  const double toEast = rise.x() == 0.0 ? 0.0 : rise.x() / (distance * parallel * step.x());
  const double toNorth = rise.y() / (along * step.y());
  return (up - toEast * east - toNorth * north).normalized();
}

// The surface at a place; `vertical_S` is the point of space that was asked for, whose vertical it
// is found on.
SurfaceSample StreamedTerrain::SampleAt(const Eigen::Vector2d& post,
                                        const Eigen::Vector3d& vertical_S) const {
  const HeightGrid::Facet facet = this->Posts_->SurfaceAt(post).At(post);
  SurfaceSample sample;
  if (!facet.valid) {
    return sample;
  }
  sample.valid = true;
  sample.level = 0;
  sample.height = facet.height;
  const Eigen::Vector3d up = this->Placement_.Up(vertical_S);
  if (this->OnBody()) {
    const BodyEllipsoid& body = this->Placement_.Body();
    sample.position_S = body.Spherical() ? Eigen::Vector3d((body.Equatorial() + facet.height) * up)
                                         : body.Point(up, facet.height);
  } else {
    sample.position_S << vertical_S.head<2>(), facet.height - this->Placement_.OriginHeight();
  }
  sample.normal_S = this->NormalAt(facet, vertical_S);
  sample.slope_deg = std::atan2(sample.normal_S.cross(up).norm(), sample.normal_S.dot(up)) / Degree;
  return sample;
}

SurfaceSample StreamedTerrain::DoSample(const Eigen::Vector3d& p_S) const {
  if (this->OnBody() && p_S.isZero(0.0)) {
    return {}; // its centre lies under no place
  }
  return this->SampleAt(this->Placement_.ToPosts(p_S).head<2>(), p_S);
}

SurfaceSample StreamedTerrain::DoSampleMap(const Eigen::Vector2d& map) const {
  const Eigen::Vector2d post = this->MapToPost(map);
  return this->SampleAt(post, this->OnBody() ? this->Placement_.ToScene(post, 0.0)
                                             : this->DoMapToScene({map.x(), map.y(), 0.0}));
}

std::vector<Eigen::Vector2d>
StreamedTerrain::PostsOf(const Eigen::Ref<const Rows3>& points_S) const {
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector2d> posts(points_S.rows());
  for (Eigen::Index i = 0; i < points_S.rows(); ++i) {
    const Eigen::Vector3d p_S = points_S.row(i);
    posts[i] = this->OnBody() && p_S.isZero(0.0)
                   ? Eigen::Vector2d(none, none)
                   : Eigen::Vector2d(this->Placement_.ToPosts(p_S).head<2>());
  }
  return posts;
}

void StreamedTerrain::DoHeights(const Eigen::Ref<const Rows3>& points_S,
                                Eigen::Ref<Eigen::VectorXd> heights) const {
  this->Posts_->Heights(this->PostsOf(points_S), heights);
}

void StreamedTerrain::DoHeightsMap(const Eigen::Ref<const Rows2>& map,
                                   Eigen::Ref<Eigen::VectorXd> heights) const {
  std::vector<Eigen::Vector2d> posts(map.rows());
  for (Eigen::Index i = 0; i < map.rows(); ++i) {
    posts[i] = this->MapToPost(map.row(i));
  }
  this->Posts_->Heights(posts, heights);
}

Eigen::Vector3d StreamedTerrain::DoMapToScene(const Eigen::Vector3d& map) const {
  return this->OnBody()
             ? this->Placement_.ToScene(this->Posts_->MapToPost() * map.head<2>(), map.z())
             : this->Frame_->MapToScene(map);
}

Eigen::Vector3d StreamedTerrain::DoSceneToMap(const Eigen::Vector3d& p_S) const {
  if (!this->OnBody()) {
    return this->Frame_->SceneToMap(p_S);
  }
  const Eigen::Vector3d post = this->Placement_.ToPosts(p_S);
  const Eigen::Vector2d map = this->Posts_->MapToPost().inverse() * Eigen::Vector2d(post.head<2>());
  return {map.x(), map.y(), post.z()};
}

Eigen::Vector3d StreamedTerrain::DoUp(const Eigen::Vector3d& p_S) const {
  return this->Placement_.Up(p_S);
}

Eigen::Vector3d StreamedTerrain::DoNorth(const Eigen::Vector3d& p_S) const {
  return this->Placement_.North(p_S);
}

int StreamedTerrain::DoResidentLevel(const Eigen::Vector2d& map) const {
  const PostLattice& lattice = this->Posts_->Lattice();
  const Eigen::Vector2d post = this->MapToPost(map);
  const double edge = 1e-9;
  if (!(lattice.periodic ||
        (post.x() >= -edge && post.x() <= double(lattice.columns - 1) + edge)) ||
      !(post.y() >= -edge && post.y() <= double(lattice.rows - 1) + edge)) {
    return -1;
  }
  std::array<float, 4> heights = {};
  for (int level = 0; level < lattice.levels; ++level) {
    const Eigen::Vector2d place = post.cwiseMax(0.0) * std::ldexp(1.0, -level);
    const auto c = std::int64_t(std::floor(place.x()));
    const auto r = std::int64_t(std::floor(place.y()));
    if (this->Pyramid()->TryRead({level, c, r, 2, 2}, heights.data())) {
      return level;
    }
  }
  return -1;
}

RayHit StreamedTerrain::DoIntersect(const Eigen::Vector3d& origin_S, const Eigen::Vector3d& unit_S,
                                    double maximumDistance) const {
  const double most = 1e9; // [m] that heights are within
  const RayPath path(this->Placement_, this->Posts_->Lattice(), origin_S, unit_S, maximumDistance,
                     this->HeightRangeIsExact_ ? this->DrawnHeights()[0] : -most,
                     this->HeightRangeIsExact_ ? this->DrawnHeights()[1] : most);
  const SurfaceRay::Hit found = this->Rays_->Get().Intersect(path);
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

void StreamedTerrain::Filled(const Eigen::Ref<const Rows3>& points_S,
                             Eigen::Ref<Eigen::VectorXd> filled) const {
  RequireResults(this->GetName(), points_S.allFinite(), points_S.rows(), filled.size());
  this->Posts_->Filled(this->PostsOf(points_S), filled);
}

void StreamedTerrain::FilledMap(const Eigen::Ref<const Rows2>& map,
                                Eigen::Ref<Eigen::VectorXd> filled) const {
  RequireResults(this->GetName(), map.allFinite(), map.rows(), filled.size());
  std::vector<Eigen::Vector2d> posts;
  posts.reserve(std::size_t(map.rows()));
  for (Eigen::Index i = 0; i < map.rows(); ++i) {
    posts.push_back(this->MapToPost(map.row(i)));
  }
  this->Posts_->Filled(posts, filled);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a Ref is a view that is written through
void StreamedTerrain::Roughness(const Eigen::Ref<const Rows3>& points_S, double radius,
                                Eigen::Ref<Eigen::VectorXd> roughness) const {
  if (!(radius > 0.0) || !std::isfinite(radius)) {
    throw Error(Error::Kind::InvalidArgument, this->GetName(),
                "radius " + std::to_string(radius) + " m given; accepted is a positive number");
  }
  if (points_S.rows() != roughness.size() || !points_S.allFinite()) {
    throw Error(Error::Kind::InvalidArgument, this->GetName(),
                "accepted: finite points and one result per point");
  }
  PixelRoughness::Pixels pixels;
  if (this->Pixels_) {
    pixels.lattice = this->Pixels_->Lattice();
    pixels.placement = this->PixelPlacement_;
    pixels.read = [this](const PostBlock& block, float* heights) {
      this->Pixels_->Read(block, heights, this->Deadline_);
    };
  } else {
    pixels.lattice = this->Posts_->Lattice();
    pixels.placement = this->Placement_;
    pixels.level = this->Posts_->SurfaceLevel();
    pixels.between = this->ReachesPoles() && pixels.level + 1 == this->Subdivisions();
    pixels.read = [this](const PostBlock& block, float* heights) {
      this->Posts_->ReadPixels(block, heights);
    };
  }
  const PixelRoughness ground(this->GetName(), std::move(pixels));
  for (Eigen::Index i = 0; i < points_S.rows(); ++i) {
    roughness[i] = ground.At(points_S.row(i), radius);
  }
}

GroundTracks& StreamedTerrain::RequireTracks() const {
  if (!this->Posts_->Tracks()) {
    throw Error(Error::Kind::Unsupported, this->GetName(),
                "it is the ground without wheel tracks; accepted: the terrain itself");
  }
  return *this->Posts_->Tracks();
}

void StreamedTerrain::TracksChanged(const std::vector<TrackReach>& changed) {
  this->Pyramid()->Invalidate(GroundTracks::RectanglesOf(*this->RequireTracks().Posts(), changed));
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  for (const auto& [posts, pyramid] : this->Followers_) {
    if (const auto over = pyramid.lock()) {
      over->Invalidate(GroundTracks::RectanglesOf(*posts, changed));
    }
  }
}

const std::shared_ptr<const PostSource>& StreamedTerrain::BarePosts() const {
  return this->RequireTracks().Bare();
}

std::shared_ptr<const TrackPosts>
StreamedTerrain::TrackedPosts(std::shared_ptr<const PostSource> bare,
                              const PostPlacement& placement) const {
  return this->RequireTracks().PostsOn(std::move(bare), placement);
}

void StreamedTerrain::Follow(std::shared_ptr<const TrackPosts> posts,
                             const std::shared_ptr<ElevationPyramid>& pyramid) const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->Followers_.emplace_back(std::move(posts), pyramid);
}

std::array<double, 2> StreamedTerrain::DrawnHeights() const {
  if (!this->Posts_->Tracks()) {
    return this->HeightRange_;
  }
  return {this->HeightRange_[0] - TrackProfile::MaximumSinkage - TrackProfile::MaximumTread,
          this->HeightRange_[1] + TrackProfile::MaximumRim};
}

const StreamedTerrain& StreamedTerrain::Undisturbed() const {
  if (!this->Posts_->Tracks()) {
    return *this;
  }
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  if (!this->Undisturbed_) {
    std::unique_ptr<StreamedTerrain> bare(
        new StreamedTerrain(this->GetName(), this->Source_, this->GetWarnings()));
    bare->Posts_ = this->Posts_->Bare();
    bare->Placement_ = this->Placement_;
    bare->Frame_ = this->Frame_;
    bare->Deadline_ = this->Deadline_;
    bare->HeightRange_ = this->HeightRange_;
    bare->HeightRangeIsExact_ = this->HeightRangeIsExact_;
    bare->Resampling_ = this->Resampling_;
    bare->Pixels_ = this->Pixels_;
    bare->PixelPlacement_ = this->PixelPlacement_;
    bare->Rays_ = bare->Posts_->MakeRays(bare->Placement_);
    this->Undisturbed_ = std::move(bare);
  }
  return *this->Undisturbed_;
}

int StreamedTerrain::LoadOverviews(const std::vector<std::shared_ptr<ElevationPyramid>>& others) {
  return this->Posts_->LoadOverviews(others);
}

RasterPlace PlaceOf(const StreamedTerrain& terrain) {
  const ElevationInfo& info = terrain.Info();
  return {terrain.GetName(), info.crs, info.pixelToMap, info.window.width, info.window.height};
}

} // namespace dspace
