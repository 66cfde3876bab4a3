#include <dspace/terrain/DrapeImage.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>

#include "RampColor.h"

namespace dspace {

namespace {

[[noreturn]] void Refuse(const std::string& message) {
  throw Error(Error::Kind::InvalidArgument, "shaded relief", message);
}

void Check(const ShadedReliefOptions& o) {
  if (!std::isfinite(o.sunAzimuth_deg))
    Refuse("the sun's azimuth is not finite");
  if (!(o.sunElevation_deg >= 0.0 && o.sunElevation_deg <= 90.0))
    Refuse("sun elevation " + std::to_string(o.sunElevation_deg) + " given; accepted is 0 to 90");
  if (!(o.ambient >= 0.0 && o.ambient <= 1.0))
    Refuse("ambient " + std::to_string(o.ambient) + " given; accepted is 0 to 1");
  if (!(o.exaggeration > 0.0) || !std::isfinite(o.exaggeration))
    Refuse("exaggeration " + std::to_string(o.exaggeration) +
           " given; accepted is a positive number");
  if (o.ramp.empty())
    Refuse("the colour ramp is empty; at least one colour is needed");
  for (const auto& color : o.ramp)
    for (double v : color)
      if (!(v >= 0.0 && v <= 1.0))
        Refuse("a colour of the ramp is outside 0 to 1");
  if ((o.rampLow && !std::isfinite(*o.rampLow)) || (o.rampHigh && !std::isfinite(*o.rampHigh)) ||
      (o.rampLow && o.rampHigh && !(*o.rampLow < *o.rampHigh)))
    Refuse("the ramp's limits must be finite and ascending");
}

} // namespace

std::array<double, 3> ColorAt(const ColorRamp& ramp, double where) {
  const double at = std::clamp(where, 0.0, 1.0) * static_cast<double>(ramp.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), ramp.size() - 1);
  const std::size_t next = std::min(i + 1, ramp.size() - 1);
  const double f = at - static_cast<double>(i);
  std::array<double, 3> color;
  for (int k = 0; k < 3; ++k)
    color[k] = ramp[i][k] * (1.0 - f) + ramp[next][k] * f;
  return color;
}

ColorRamp TerrainRamp() {
  return {{0.16, 0.35, 0.28}, {0.45, 0.58, 0.33}, {0.82, 0.74, 0.48},
          {0.66, 0.44, 0.28}, {0.55, 0.45, 0.42}, {0.97, 0.97, 0.97}};
}

std::array<int, 2> DrapeSize(int columns, int rows, int maximumSize) {
  if (maximumSize < 1 || maximumSize > 32768)
    throw Error(Error::Kind::InvalidArgument, "drape image",
                "a size of " + std::to_string(maximumSize) +
                    " pixels given; accepted is 1 to 32768");
  const double factor = std::min(1.0, static_cast<double>(maximumSize) / std::max(columns, rows));
  const auto scaled = [&](int n) { return std::max(1, static_cast<int>(std::round(n * factor))); };
  return {scaled(columns), scaled(rows)};
}

RasterPlace PlaceOf(const GridTerrain& terrain) {
  return {terrain.GetName(), terrain.GetCrs(), terrain.PixelToMap(), terrain.Grid().GetColumns(),
          terrain.Grid().GetRows()};
}

DrapeImage ShadedRelief(const GridTerrain& terrain, const ShadedReliefOptions& options) {
  Check(options);
  const HeightGrid& grid = terrain.Grid();
  const auto [width, height] = DrapeSize(grid.GetColumns(), grid.GetRows(), options.maximumSize);
  const double degree = M_PI / 180.0;
  const double azimuth = options.sunAzimuth_deg * degree;
  const double elevation = options.sunElevation_deg * degree;
  const Eigen::Vector3d sun(std::sin(azimuth) * std::cos(elevation),
                            std::cos(azimuth) * std::cos(elevation), std::sin(elevation));
  const double low = options.rampLow.value_or(grid.GetMinimum());
  const double high = options.rampHigh.value_or(grid.GetMaximum());

  DrapeImage image;
  image.width = width;
  image.height = height;
  image.pixels.reserve(static_cast<std::size_t>(width) * height * 3);
  const auto post = [](int pixel, int pixels, int posts) {
    return std::min(static_cast<int>((pixel + 0.5) * posts / pixels), posts - 1);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int c = post(x, width, grid.GetColumns()), r = post(y, height, grid.GetRows());
      if (!grid.HasPost(c, r)) {
        image.pixels.insert(image.pixels.end(), options.holeColor.begin(), options.holeColor.end());
        continue;
      }
      Eigen::Vector3d n = grid.PostNormal(c, r);
      n.head<2>() *= options.exaggeration;
      const double lambert = std::max(0.0, n.normalized().dot(sun));
      const double light = options.ambient + (1.0 - options.ambient) * lambert;
      const double where = high > low ? (grid.At(c, r) - low) / (high - low) : 0.0;
      for (double v : ColorAt(options.ramp, where))
        image.pixels.push_back(static_cast<std::uint8_t>(std::lround(255.0 * v * light)));
    }
  return image;
}

} // namespace dspace
