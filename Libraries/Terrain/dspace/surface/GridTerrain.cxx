#include <dspace/surface/GridTerrain.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>

#include <dspace/surface/TerrainWarnings.h>

namespace dspace {

namespace {

Eigen::Vector2d MiddleOf(int columns, int rows, const Eigen::Affine2d& pixelToMap) {
  return pixelToMap * Eigen::Vector2d(0.5 * columns, 0.5 * rows);
}

} // namespace

GridTerrain::GridTerrain(const std::string& name, int columns, int rows,
                         std::vector<double> heights, const Eigen::Affine2d& pixelToMap,
                         const Crs& crs, const VerticalDatum& datum,
                         const std::optional<Eigen::Vector2d>& origin, double originHeight,
                         std::vector<std::string> warnings)
    : TerrainSurface(name, crs, datum, std::move(warnings)), PixelToMap_(pixelToMap),
      Frame_(crs, origin.value_or(MiddleOf(columns, rows, pixelToMap)), originHeight),
      Grid_(name, columns, rows, std::move(heights), this->Frame_.PostToScene(pixelToMap)),
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
  std::vector<std::string> warnings = WarningsOfPlace(info, true);
  // The least that is rejected is rejected before the raster is read.
  if (info.window.width < 2 || info.window.height < 2)
    throw Error(Error::Kind::InvalidArgument, name,
                std::to_string(info.window.width) + " x " + std::to_string(info.window.height) +
                    " posts span no surface; at least 2 x 2 are needed");
  auto terrain = std::make_shared<GridTerrain>(
      name, info.window.width, info.window.height, source.Read(), info.pixelToMap, info.crs,
      info.verticalDatum, options.origin, options.originHeight, std::move(warnings));
  for (std::string& warning : WarningsOfRelief(terrain->Grid(), terrain->GetBounds().scene))
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
