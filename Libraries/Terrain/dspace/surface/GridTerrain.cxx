#include <dspace/surface/GridTerrain.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>
#include <dspace/raster/OpeningLimit.h>

#include <dspace/posts/GridPosts.h>
#include <dspace/posts/PostsBetween.h>
#include <dspace/surface/TerrainWarnings.h>
#include <dspace/tracks/GroundTracks.h>

namespace dspace {

namespace {

Eigen::Vector2d MiddleOf(int columns, int rows, const Eigen::Affine2d& pixelToMap) {
  return pixelToMap * Eigen::Vector2d(0.5 * columns, 0.5 * rows);
}

// The posts of a grid with those between them, `parts` a cell.
std::vector<double> Refined(const std::vector<double>& heights, int columns, int rows, int parts) {
  std::vector<double> refined;
  refined.reserve((std::size_t(columns - 1) * parts + 1) * (std::size_t(rows - 1) * parts + 1));
  for (int j = 0; j <= (rows - 1) * parts; ++j)
    for (int i = 0; i <= (columns - 1) * parts; ++i) {
      const int c = i / parts, r = j / parts;
      const auto at = [&](int cc, int rr) { // beyond the last ones nothing counts
        return heights[std::size_t(std::min(rr, rows - 1)) * columns + std::min(cc, columns - 1)];
      };
      refined.push_back(OnTriangles(at(c, r), at(c + 1, r), at(c, r + 1), at(c + 1, r + 1),
                                    double(i % parts) / parts, double(j % parts) / parts));
    }
  return refined;
}

} // namespace

GridTerrain::GridTerrain(const std::string& name, int columns, int rows,
                         std::vector<double> heights, const Eigen::Affine2d& pixelToMap,
                         const Crs& crs, const VerticalDatum& datum,
                         const std::optional<Eigen::Vector2d>& origin, double originHeight,
                         std::vector<std::string> warnings, const WheelTracksOptions& tracks)
    : TerrainSurface(name, crs, datum, std::move(warnings)), PixelToMap_(pixelToMap),
      Frame_(crs, origin.value_or(MiddleOf(columns, rows, pixelToMap)), originHeight),
      Grid_(name, columns, rows, std::move(heights), this->Frame_.PostToScene(pixelToMap)),
      Ray_(this->Grid_),
      // Heights come from the undisturbed grid: only the lattice of these posts is used.
      Tracks_(std::make_unique<GroundTracks>(name, std::make_shared<GridPosts>(name, this->Grid_),
                                             this->Frame_.PostToScene(pixelToMap), this->Frame_,
                                             crs, tracks)) {}

GridTerrain::~GridTerrain() = default;

std::shared_ptr<GridTerrain> GridTerrain::Load(const std::string& path,
                                               const GridTerrainOptions& options) {
  const ElevationSource source(path, options.elevation);
  const ElevationInfo& info = source.Info();
  const std::string name = "terrain '" + path + "'";
  if (options.subdivisions < 0 || options.subdivisions > 12)
    throw Error(Error::Kind::InvalidArgument, name,
                std::to_string(options.subdivisions) +
                    " subdivisions are rejected; accepted is 0 to 12");
  const int parts = 1 << options.subdivisions;
  const auto across = [parts](int pixels) {
    return (std::int64_t(std::max(pixels, 1)) - 1) * parts + 1;
  };
  const std::int64_t columns = across(info.window.width), rows = across(info.window.height);
  if (double(columns) * double(rows) > double(options.maximumPosts))
    throw Error(Error::Kind::Resource, name,
                std::to_string(columns) + " x " + std::to_string(rows) +
                    " posts are more than the " + std::to_string(options.maximumPosts) +
                    " allowed; give a window" + (parts > 1 ? " or fewer subdivisions" : ""));
  std::vector<std::string> warnings = WarningsOfPlace(info, true);
  // The least that is rejected is rejected before the raster is read.
  if (info.window.width < 2 || info.window.height < 2)
    throw Error(Error::Kind::InvalidArgument, name,
                std::to_string(info.window.width) + " x " + std::to_string(info.window.height) +
                    " posts span no surface; at least 2 x 2 are needed");
  const OpeningLimit limit;
  std::vector<double> heights = source.Read();
  for (std::string& warning : WarningsOfFill(heights, info))
    warnings.push_back(std::move(warning));
  Eigen::Affine2d pixelToMap = info.pixelToMap;
  if (parts > 1) {
    heights = Refined(heights, info.window.width, info.window.height, parts);
    // Its first pixel's centre stays where it is.
    pixelToMap = pixelToMap * Eigen::Translation2d(0.5 - 0.5 / parts, 0.5 - 0.5 / parts) *
                 Eigen::Scaling(1.0 / parts);
  }
  auto terrain = std::make_shared<GridTerrain>(
      name, int(columns), int(rows), std::move(heights), pixelToMap, info.crs, info.verticalDatum,
      options.origin.value_or(MiddleOf(info.window.width, info.window.height, info.pixelToMap)),
      options.originHeight, std::move(warnings), options.tracks);
  terrain->Subdivisions_ = options.subdivisions;
  for (std::string& warning : WarningsOfRelief(terrain->Grid(), terrain->GetBounds().scene))
    terrain->AddWarning(std::move(warning));
  return terrain;
}

std::shared_lock<std::shared_mutex> GridTerrain::Reading() const {
  if (this->Writing_) { // else new readers would hold the lock for ever, one after the other
    const std::lock_guard<std::mutex> turn(this->Turn_);
  }
  return std::shared_lock<std::shared_mutex>(this->Mutex_);
}

TerrainBounds GridTerrain::DoGetBounds() const {
  const auto lock = this->Reading();
  TerrainBounds bounds;
  const double c = this->Grid_.GetColumns(), r = this->Grid_.GetRows();
  const std::array<double, 2> heights =
      !this->Disturbed_ ? std::array<double, 2>{this->Grid_.GetMinimum(), this->Grid_.GetMaximum()}
                        : this->Ray_.Range();
  for (double x : {0.5, c - 0.5})
    for (double y : {0.5, r - 0.5}) {
      const Eigen::Vector2d map = this->PixelToMap_ * Eigen::Vector2d(x, y);
      bounds.map.extend(map);
      for (double h : heights)
        bounds.scene.extend(this->Frame_.MapToScene({map.x(), map.y(), h}));
    }
  return bounds;
}

void GridTerrain::TracksChanged(const std::vector<TrackReach>& reaches) {
  constexpr std::int64_t MostRows = 64; // at a time
  const std::vector<PostRectangle> changed =
      GroundTracks::RectanglesOf(*this->Tracks_->Posts(), reaches);
  if (changed.empty()) {
    return;
  }
  const std::lock_guard<std::mutex> turn(this->Turn_);
  this->Writing_ = true;
  const std::unique_lock<std::shared_mutex> lock(this->Mutex_);
  this->Writing_ = false; // later readers wait for the lock
  this->Disturbed_ = !this->Tracks_->Empty();
  const std::int64_t columns = this->Grid_.GetColumns(), rows = this->Grid_.GetRows();
  if (!this->Undisturbed_) {
    this->Rolled_.assign(this->Grid_.GetHeights().size(), -1.0f);
    this->Undisturbed_ = std::make_shared<const GridTerrain>(
        this->GetName(), int(columns), int(rows), this->Grid_.GetHeights(), this->PixelToMap_,
        this->GetCrs(), this->GetVerticalDatum(), this->Frame_.GetOrigin(),
        this->Frame_.GetOriginHeight(), this->GetWarnings());
  }
  const HeightGrid& bare = this->Undisturbed_->Grid();
  for (const PostRectangle& rectangle : changed) {
    const std::int64_t c0 = std::max<std::int64_t>(rectangle.column, 0);
    const std::int64_t r0 = std::max<std::int64_t>(rectangle.row, 0);
    const std::int64_t c1 = std::min(rectangle.column + rectangle.width, columns); // not included
    const std::int64_t r1 = std::min(rectangle.row + rectangle.height, rows);
    if (rectangle.levels == 0 || c0 >= c1 || r0 >= r1) {
      continue;
    }
    for (std::int64_t first = r0; first < r1; first += MostRows) {
      const PostBlock block{0, c0, first, int(c1 - c0), int(std::min(MostRows, r1 - first))};
      std::vector<float> change(std::size_t(block.width) * block.height, 0.0f);
      std::vector<float> rolled(change.size(), -1.0f);
      this->Tracks_->Posts()->Lower(block, change.data(), rolled.data());
      for (std::size_t i = 0; i < change.size(); ++i) {
        const int c = int(c0) + int(i) % block.width;
        const int r = int(first) + int(i) / block.width;
        const bool reached = rolled[i] >= 0.0f && bare.HasPost(c, r);
        this->Grid_.Move(c, r, bare.At(c, r) + (reached ? double(change[i]) : 0.0));
        this->Rolled_[std::size_t(r) * std::size_t(columns) + std::size_t(c)] =
            reached ? rolled[i] : -1.0f;
      }
    }
    this->Ray_.Update({int(c0), int(r0)}, {int(c1) - 1, int(r1) - 1});
    this->Changes_.push_back({c0, r0, c1 - c0, r1 - r0, 1, 0});
  }
  ++this->Version_;
}

SurfaceSample GridTerrain::SampleGrid(const Eigen::Vector2d& g, const Eigen::Vector2d& xy_S) const {
  const auto lock = this->Reading();
  const HeightGrid::Facet facet = this->Grid_.FacetAt(g);
  SurfaceSample sample;
  if (!facet.valid)
    return sample;
  sample.valid = true;
  sample.level = 0;
  sample.height = facet.height;
  sample.slope_deg = this->Grid_.Slope(facet);
  sample.position_S << xy_S, facet.height - this->Frame_.GetOriginHeight();
  sample.normal_S = this->Grid_.Normal(facet);
  return sample;
}

SurfaceSample GridTerrain::DoSample(const Eigen::Vector3d& p_S) const {
  return this->SampleGrid(this->Grid_.ToGrid(p_S.head<2>()), p_S.head<2>());
}

SurfaceSample GridTerrain::DoSampleMap(const Eigen::Vector2d& map) const {
  return this->DoSample(this->Frame_.MapToScene({map.x(), map.y(), 0.0}));
}

void GridTerrain::DoHeights(const Eigen::Ref<const Rows3>& points_S,
                            Eigen::Ref<Eigen::VectorXd> heights) const {
  const auto lock = this->Reading();
  for (Eigen::Index i = 0; i < points_S.rows(); ++i) {
    const HeightGrid::Facet facet =
        this->Grid_.FacetAt(this->Grid_.ToGrid({points_S(i, 0), points_S(i, 1)}));
    heights[i] = facet.valid ? facet.height : std::numeric_limits<double>::quiet_NaN();
  }
}

RayHit GridTerrain::DoIntersect(const Eigen::Vector3d& origin_S, const Eigen::Vector3d& unit_S,
                                double maximumDistance) const {
  const auto lock = this->Reading();
  const Eigen::Vector3d lift(0.0, 0.0, this->Frame_.GetOriginHeight());
  const GridRay::Hit found = this->Ray_.Intersect(origin_S + lift, unit_S, maximumDistance);
  RayHit hit;
  if (!found.hit)
    return hit;
  hit.hit = true;
  hit.fromBelow = found.fromBelow;
  hit.distance = found.distance;
  hit.position_S = origin_S + found.distance * unit_S;
  hit.normal_S = this->Grid_.Normal(found.facet);
  return hit;
}

Eigen::Vector3d GridTerrain::DoMapToScene(const Eigen::Vector3d& map) const {
  return this->Frame_.MapToScene(map);
}

Eigen::Vector3d GridTerrain::DoSceneToMap(const Eigen::Vector3d& p_S) const {
  return this->Frame_.SceneToMap(p_S);
}

Eigen::Vector3d GridTerrain::DoUp(const Eigen::Vector3d&) const {
  return Eigen::Vector3d::UnitZ();
}

int GridTerrain::DoResidentLevel(const Eigen::Vector2d& map) const {
  return this->DoSampleMap(map).valid ? 0 : -1;
}

} // namespace dspace
