#include <dspace/mesh/ShadedRelief.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>

namespace dspace {

namespace {

[[noreturn]] void RejectRelief(const std::string& message) {
  throw Error(Error::Kind::InvalidArgument, "shaded relief", message);
}

void Check(const ShadedReliefOptions& o) {
  if (!std::isfinite(o.sunAzimuth_deg))
    RejectRelief("the sun's azimuth is not finite");
  if (!(o.sunElevation_deg >= 0.0 && o.sunElevation_deg <= 90.0))
    RejectRelief("sun elevation " + std::to_string(o.sunElevation_deg) +
                 " given; accepted is 0 to 90");
  if (!(o.ambient >= 0.0 && o.ambient <= 1.0))
    RejectRelief("ambient " + std::to_string(o.ambient) + " given; accepted is 0 to 1");
  if (!(o.exaggeration > 0.0) || !std::isfinite(o.exaggeration))
    RejectRelief("exaggeration " + std::to_string(o.exaggeration) +
                 " given; accepted is a positive number");
  if (o.ramp.empty())
    RejectRelief("the colour ramp is empty; at least one colour is needed");
  for (const auto& color : o.ramp)
    for (double v : color)
      if (!(v >= 0.0 && v <= 1.0))
        RejectRelief("a colour of the ramp is outside 0 to 1");
  if ((o.rampLow && !std::isfinite(*o.rampLow)) || (o.rampHigh && !std::isfinite(*o.rampHigh)) ||
      (o.rampLow && o.rampHigh && !(*o.rampLow < *o.rampHigh)))
    RejectRelief("the ramp's limits must be finite and ascending");
}

} // namespace

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
