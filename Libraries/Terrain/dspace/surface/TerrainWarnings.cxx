#include <dspace/surface/TerrainWarnings.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <dspace/Error.h>
#include <dspace/crs/CrsTransform.h>

namespace dspace {

namespace {

// Latitudes of the corners and the middle; none where the CRS has no place there.
double GreatestLatitude(const ElevationInfo& info) {
  const Crs& crs = info.crs;
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
void WarnOfFlatness(const Eigen::AlignedBox3d& box, std::vector<std::string>& warnings) {
  const double relief = box.sizes().z(), extent = box.sizes().head<2>().maxCoeff();
  if (extent > 1e6 && relief < 100.0)
    warnings.push_back("a relief of " + std::to_string(relief) + " m over " +
                       std::to_string(extent / 1000.0) +
                       " km is suspiciously small: for heights in kilometres give vertical scale "
                       "1000");
}

// Numbers that are no metres stand as needles. Loose ground lies at 35 degrees at most: a wall may
// stand steeper, but no half of a map at 60.
void WarnOfSteepness(const HeightGrid& grid, const Eigen::AlignedBox3d& box,
                     std::vector<std::string>& warnings) {
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
  const bool steep = *middle > 60.0;
  if (!steep && box.sizes().z() <= 2.0 * box.sizes().head<2>().maxCoeff())
    return;
  std::ostringstream out;
  out.precision(5);
  out << "its heights span " << box.sizes().z() << " m over " << box.sizes().x() << " x "
      << box.sizes().y() << " m";
  if (steep)
    out << ", and half of its slopes are above " << *middle << " degrees";
  out << ": if its values are not in metres, state vertical_scale (metres per unit)";
  warnings.push_back(out.str());
}

} // namespace

std::vector<std::string> WarningsOfPlace(const ElevationInfo& info, bool onPlane) {
  std::vector<std::string> warnings = info.warnings;
  const std::string datum =
      DatumWarning(info.verticalDatum, info.crs.GetAxes(), GreatestLatitude(info));
  if (!datum.empty())
    warnings.push_back(datum);
  if (onPlane)
    WarnOfScale(info.crs,
                info.pixelToMap *
                    Eigen::Vector2d(0.5 * info.window.width, 0.5 * info.window.height),
                warnings);
  return warnings;
}

std::vector<std::string> WarningsOfRelief(const HeightGrid& grid,
                                          const Eigen::AlignedBox3d& scene) {
  std::vector<std::string> warnings;
  WarnOfFlatness(scene, warnings);
  WarnOfSteepness(grid, scene, warnings);
  return warnings;
}

} // namespace dspace
