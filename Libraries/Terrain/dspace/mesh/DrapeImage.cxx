#include <dspace/mesh/DrapeImage.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <dspace/Error.h>

namespace dspace {

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

DrapeImage Over(const DrapeImage& top, const DrapeImage& bottom) {
  if (bottom.width < 1 || bottom.height < 1)
    throw Error(Error::Kind::InvalidArgument, "drape image", "the lower image is empty");
  DrapeImage image = top;
  if (top.coverage.empty())
    return image;
  for (int y = 0; y < top.height; ++y)
    for (int x = 0; x < top.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * top.width + x;
      const int a = top.coverage[i];
      const int bx = static_cast<int>((x + 0.5) * bottom.width / top.width);
      const int by = static_cast<int>((y + 0.5) * bottom.height / top.height);
      const std::size_t j = static_cast<std::size_t>(by) * bottom.width + bx;
      for (int k = 0; k < 3; ++k)
        image.pixels[3 * i + k] = static_cast<std::uint8_t>(
            (top.pixels[3 * i + k] * a + bottom.pixels[3 * j + k] * (255 - a) + 127) / 255);
    }
  image.coverage = bottom.coverage.empty() ? std::vector<std::uint8_t>() : image.coverage;
  return image;
}

} // namespace dspace
