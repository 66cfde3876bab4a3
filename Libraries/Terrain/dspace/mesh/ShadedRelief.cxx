#include <dspace/mesh/ShadedRelief.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <dspace/Error.h>
#include <dspace/RowThreads.h>

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
  image.pixels.resize(static_cast<std::size_t>(width) * height * 3);
  const auto post = [](int pixel, int pixels, int posts) {
    return std::min(static_cast<int>((pixel + 0.5) * posts / pixels), posts - 1);
  };
  const auto row = [&](int y, std::uint8_t* pixel) {
    const int r = post(y, height, grid.GetRows());
    for (int x = 0; x < width; ++x, pixel += 3) {
      const int c = post(x, width, grid.GetColumns());
      if (!grid.HasPost(c, r)) {
        std::copy(options.holeColor.begin(), options.holeColor.end(), pixel);
        continue;
      }
      Eigen::Vector3d n = grid.PostNormal(c, r);
      n.head<2>() *= options.exaggeration;
      const double lambert = std::max(0.0, n.normalized().dot(sun));
      const double light = options.ambient + (1.0 - options.ambient) * lambert;
      const double where = high > low ? (grid.At(c, r) - low) / (high - low) : 0.0;
      const std::array<double, 3> color = ColorAt(options.ramp, where);
      for (int k = 0; k < 3; ++k)
        pixel[k] = static_cast<std::uint8_t>(255.0 * color[k] * light + 0.5); // rounded
    }
  };
  ForRows(height, width, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      row(y, image.pixels.data() + static_cast<std::size_t>(y) * width * 3);
  });
  return image;
}

} // namespace dspace
