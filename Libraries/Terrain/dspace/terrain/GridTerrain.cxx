#include <dspace/terrain/GridTerrain.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <dspace/Error.h>

namespace dspace {

namespace {

Eigen::Vector2d MiddleOf(int columns, int rows, const Eigen::Affine2d& pixelToMap) {
  return pixelToMap * Eigen::Vector2d(0.5 * columns, 0.5 * rows);
}

// Post (c, r) stands at pixel coordinates (c + 0.5, r + 0.5).
Eigen::Affine2d GridToScene(const Eigen::Affine2d& pixelToMap, const SceneFrame& frame) {
  const Eigen::Vector2d first = pixelToMap * Eigen::Vector2d(0.5, 0.5);
  Eigen::Affine2d m = Eigen::Affine2d::Identity();
  m.linear() = frame.GetMetres().asDiagonal() * pixelToMap.linear();
  m.translation() = (first - frame.GetOrigin()).cwiseProduct(frame.GetMetres());
  return m;
}

// Latitudes of the corners and the middle; none where the CRS has no place there.
double GreatestLatitude(const Crs& crs, const ElevationInfo& info) {
  if (!crs.HasGeographic())
    return 0.0;
  const CrsTransform geographic(crs, crs.Geographic());
  double greatest = 0.0;
  for (double c : {0.0, 0.5, 1.0})
    for (double r : {0.0, 0.5, 1.0}) {
      const Eigen::Vector2d map =
          info.pixelToMap * Eigen::Vector2d(c * info.window.width, r * info.window.height);
      try {
        greatest = std::max(greatest, std::abs(geographic.Apply(map).y()));
      } catch (const Error&) {
        greatest = 90.0;
      }
    }
  return std::min(greatest, 90.0);
}

// Lengths in the scene are the map's: said where they differ from the ground's by over a percent.
void WarnOfScale(const Crs& crs, const Eigen::Vector2d& middle,
                 std::vector<std::string>& warnings) {
  if (crs.GetKind() != Crs::Kind::Projected)
    return;
  Eigen::Vector2d scale;
  try {
    const Eigen::Vector2d p = CrsTransform(crs, crs.Geographic()).Apply(middle);
    scale = crs.ScaleFactors(p.x(), p.y());
  } catch (const Error& error) {
    warnings.push_back(std::string("the map's scale is not known: ") + error.what());
    return;
  }
  if ((scale - Eigen::Vector2d::Ones()).cwiseAbs().maxCoeff() <= 0.01)
    return;
  std::ostringstream out;
  out.precision(4);
  out << "the map projection stretches the ground by " << scale.x() << " east-west and "
      << scale.y() << " north-south at the raster's middle; lengths and slopes are the map's";
  warnings.push_back(out.str());
}

// Kilometres without a unit look like a plain of glass.
void WarnOfFlatness(const GridTerrain& terrain, std::vector<std::string>& warnings) {
  const Eigen::AlignedBox3d box = terrain.GetBounds().scene;
  const double relief = box.sizes().z(), extent = box.sizes().head<2>().maxCoeff();
  if (extent > 1e6 && relief < 100.0)
    warnings.push_back("a relief of " + std::to_string(relief) + " m over " +
                       std::to_string(extent / 1000.0) +
                       " km is suspiciously small: for heights in kilometres give vertical scale "
                       "1000");
}

// Numbers that are no metres stand as needles. Loose ground lies at 35 degrees at most: a wall may
// stand steeper, but no half of a map at 60.
void WarnOfSteepness(const GridTerrain& terrain, std::vector<std::string>& warnings) {
  const HeightGrid& grid = terrain.Grid();
  const int columns = grid.GetColumns() - 1, rows = grid.GetRows() - 1;
  const int step = 1 + std::max(columns, rows) / 300; // at most 90,000 of them
  std::vector<double> slopes;
  for (int r = 0; r < rows; r += step)
    for (int c = 0; c < columns; c += step) {
      const HeightGrid::Facet facet = grid.FacetAt({c + 0.25, r + 0.75});
      if (facet.valid)
        slopes.push_back(grid.Slope(facet));
    }
  if (slopes.empty())
    return;
  const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
  std::nth_element(slopes.begin(), middle, slopes.end());
  const Eigen::AlignedBox3d box = terrain.GetBounds().scene;
  const bool steep = *middle > 60.0;
  if (!steep && box.sizes().z() <= 2.0 * box.sizes().head<2>().maxCoeff())
    return;
  std::ostringstream out;
  out.precision(5);
  out << "its heights span " << box.sizes().z() << " m over " << box.sizes().x() << " x "
      << box.sizes().y() << " m";
  if (steep)
    out << ", and half of its slopes are above " << *middle << " degrees";
  out << ": if its values are no metres, state vertical_scale (metres a unit)";
  warnings.push_back(out.str());
}

} // namespace

GridTerrain::GridTerrain(const std::string& name, int columns, int rows,
                         std::vector<double> heights, const Eigen::Affine2d& pixelToMap,
                         const Crs& crs, const VerticalDatum& datum,
                         const std::optional<Eigen::Vector2d>& origin, double originHeight,
                         std::vector<std::string> warnings)
    : TerrainSurface(name, crs, datum, std::move(warnings)), PixelToMap_(pixelToMap),
      Frame_(crs, origin.value_or(MiddleOf(columns, rows, pixelToMap)), originHeight),
      Grid_(name, columns, rows, std::move(heights), GridToScene(pixelToMap, this->Frame_)),
      Ray_(this->Grid_) {}

std::shared_ptr<const GridTerrain> GridTerrain::Load(const std::string& path,
                                                     const GridTerrainOptions& options) {
  const ElevationSource source(path, options.elevation);
  const ElevationInfo& info = source.Info();
  const std::string name = "terrain '" + path + "'";
  const std::size_t posts = static_cast<std::size_t>(info.window.width) * info.window.height;
  if (posts > options.maximumPosts)
    throw Error(Error::Kind::Resource, name,
                std::to_string(info.window.width) + " x " + std::to_string(info.window.height) +
                    " posts are more than the " + std::to_string(options.maximumPosts) +
                    " allowed; give a window");
  std::vector<std::string> warnings = info.warnings;
  const std::string datum =
      DatumWarning(info.verticalDatum, info.crs.GetAxes(), GreatestLatitude(info.crs, info));
  if (!datum.empty())
    warnings.push_back(datum);
  WarnOfScale(info.crs, MiddleOf(info.window.width, info.window.height, info.pixelToMap), warnings);
  // The least that is refused is refused before the raster is read.
  if (info.window.width < 2 || info.window.height < 2)
    throw Error(Error::Kind::InvalidArgument, name,
                std::to_string(info.window.width) + " x " + std::to_string(info.window.height) +
                    " posts span no surface; at least 2 x 2 are needed");
  auto terrain = std::make_shared<GridTerrain>(
      name, info.window.width, info.window.height, source.Read(), info.pixelToMap, info.crs,
      info.verticalDatum, options.origin, options.originHeight, std::move(warnings));
  std::vector<std::string> late;
  WarnOfFlatness(*terrain, late);
  WarnOfSteepness(*terrain, late);
  for (std::string& warning : late)
    terrain->AddWarning(std::move(warning));
  return terrain;
}

TerrainBounds GridTerrain::DoGetBounds() const {
  TerrainBounds bounds;
  const double c = this->Grid_.GetColumns(), r = this->Grid_.GetRows();
  for (double x : {0.5, c - 0.5})
    for (double y : {0.5, r - 0.5}) {
      const Eigen::Vector2d map = this->PixelToMap_ * Eigen::Vector2d(x, y);
      bounds.map.extend(map);
      for (double h : {this->Grid_.GetMinimum(), this->Grid_.GetMaximum()})
        bounds.scene.extend(this->Frame_.MapToScene({map.x(), map.y(), h}));
    }
  return bounds;
}

SurfaceSample GridTerrain::SampleGrid(const Eigen::Vector2d& g, const Eigen::Vector2d& xy_S) const {
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
  for (Eigen::Index i = 0; i < points_S.rows(); ++i) {
    const HeightGrid::Facet facet =
        this->Grid_.FacetAt(this->Grid_.ToGrid({points_S(i, 0), points_S(i, 1)}));
    heights[i] = facet.valid ? facet.height : std::numeric_limits<double>::quiet_NaN();
  }
}

RayHit GridTerrain::DoIntersect(const Eigen::Vector3d& origin_S, const Eigen::Vector3d& unit_S,
                                double maximumDistance) const {
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
