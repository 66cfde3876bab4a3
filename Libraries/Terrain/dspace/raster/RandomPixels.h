// Pixels of a raster at random, near a number of places, so that few of its tiles are read. Not a
// public header.
#ifndef DSPACE_TERRAIN_RANDOMPIXELS_H
#define DSPACE_TERRAIN_RANDOMPIXELS_H

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <dspace/raster/ElevationSource.h>

namespace dspace {

// `use` gets column, row and height (NaN without data) of 16 pixels in each of 16 places: always
// the same ones.
template<class Use> void AtRandomPixels(const ElevationSource& source, Use use) {
  constexpr int Spots = 16;
  constexpr int SpotPixels = 16;
  constexpr int SpotSize = 32; // pixels a side
  const RasterWindow window = source.Info().window;
  std::mt19937 random(1);
  const auto below = [&](int n) { return int(random() % std::uint32_t(std::max(1, n))); };
  for (int spot = 0; spot < Spots; ++spot) {
    const RasterWindow part{below(window.width - SpotSize + 1), below(window.height - SpotSize + 1),
                            std::min(SpotSize, window.width), std::min(SpotSize, window.height)};
    const std::vector<double> heights = source.Read(part);
    for (int i = 0; i < SpotPixels; ++i) {
      const int c = below(part.width);
      const int r = below(part.height);
      use(part.column + c, part.row + r, heights[std::size_t(r) * part.width + c]);
    }
  }
}

} // namespace dspace

#endif
