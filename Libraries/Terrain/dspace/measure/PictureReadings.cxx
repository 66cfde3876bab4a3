#include <dspace/measure/PictureReadings.h>

#include <algorithm>
#include <cmath>

namespace dspace {
namespace {

constexpr double PerDegree = M_PI / 180.0;

} // namespace

HorizonReading ReadHorizon(const std::vector<float>& range, int size, double right_deg) {
  const double half = 0.5 * size; // [pixels] per unit of tangent
  const double tangent = std::tan(right_deg * PerDegree);
  const int column = std::clamp(int(std::floor(half + half * tangent)), 0, size - 1);
  const double middle = (column + 0.5 - half) / half; // tangent of the column's own azimuth
  HorizonReading reading;
  reading.column = column;
  for (int row = 0; row < size; ++row) {
    const float found = range[std::size_t(row) * std::size_t(size) + std::size_t(column)];
    if (std::isfinite(found)) {
      // The upper edge of the row lies `half - row` pixels above the middle.
      reading.elevation_deg = std::atan2((half - row) / half, std::hypot(1.0, middle)) / PerDegree;
      reading.range = found;
      reading.row = row;
      reading.over = row == 0;
      break;
    }
  }
  return reading;
}

double PixelAngle(int size) {
  return std::atan(2.0 / size) / PerDegree;
}

std::size_t CountLabel(const std::vector<std::uint32_t>& labels, std::uint32_t label) {
  return std::size_t(std::count(labels.begin(), labels.end(), label));
}

} // namespace dspace
