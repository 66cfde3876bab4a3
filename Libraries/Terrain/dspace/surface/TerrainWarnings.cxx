#include <dspace/surface/TerrainWarnings.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>
#include <utility>

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

// The values at one end of the range of heights.
struct End {
  double value = 0.0;    // [m] of the end itself
  double next = 0.0;     // the nearest other one
  std::size_t count = 0; // of heights with the value
};

// `sign` is 1 for the lowest and -1 for the highest.
End FindEnd(const std::vector<double>& heights, double sign) {
  const double infinity = std::numeric_limits<double>::infinity();
  End end{infinity, infinity, 0};
  for (const double height : heights) {
    const double h = sign * height;
    if (h < end.value) {
      end.next = end.value;
      end.value = h;
      end.count = 1;
    } else if (h == end.value) {
      ++end.count;
    } else if (h < end.next) {
      end.next = h;
    }
  }
  end.value *= sign;
  end.next *= sign;
  return end;
}

bool IsUsualFill(double value) {
  const double usual[] = {-32768, -32767, 32767, 65535, -999, -9999, -99999, -2147483648.0};
  return std::any_of(std::begin(usual), std::end(usual), [&](double u) { return u == value; });
}

} // namespace

std::vector<std::string> WarningsOfFill(const std::vector<double>& heights,
                                        const ElevationInfo& info) {
  std::vector<std::string> warnings;
  const End low = FindEnd(heights, 1.0), high = FindEnd(heights, -1.0);
  const auto count = std::size_t(
      std::count_if(heights.begin(), heights.end(), [](double h) { return !std::isnan(h); }));
  const double datum =
      info.verticalDatum.kind == VerticalDatum::Kind::Radius ? info.verticalDatum.radius : 0.0;
  for (const auto& [end, other] : {std::pair(low, high), std::pair(high, low)}) {
    const double gap = std::abs(end.value - end.next), rest = std::abs(other.value - end.next);
    if (!std::isfinite(gap) || !(gap > 0.0)) {
      continue; // level, or without heights
    }
    // As the file stores it: a whole number is not to become 32767.999999999996.
    double value = (end.value + datum - info.verticalOffset) / info.verticalScale;
    if (std::abs(value - std::round(value)) < 1e-9 * std::abs(value)) {
      value = std::round(value);
    }
    // Ground of two heights only, and what most of the ground is, are no marks.
    const bool many =
        end.count >= 3 && end.count * 2000 >= count && end.count * 2 < count && rest > 0.0;
    if (IsUsualFill(value) ? gap <= 0.25 * rest : !many || gap <= 2.0 * rest) {
      continue;
    }
    std::ostringstream out;
    out.precision(9);
    out << end.count << " of the " << count << " values looked at are " << value << ", ";
    out.precision(4);
    out << gap << " m from all others: if this value marks pixels without data, state no_data=";
    out.precision(9);
    out << value;
    warnings.push_back(out.str());
  }
  return warnings;
}

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
