// A raster without overviews, a cache folder, and means summed pixel by pixel.
#ifndef DSPACE_TEST_CACHEDRASTER_H
#define DSPACE_TEST_CACHEDRASTER_H

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/raster/ElevationCache.h>

#include "RasterFile.h"

namespace dspace::testing {

namespace fs = std::filesystem;

constexpr int Width = 1101;
constexpr int Height = 830;
constexpr double NoData = -9999.0;

// Whole numbers; a hole that cuts cells in every way.
inline double Value(int c, int r) {
  const bool hole = (c > 301 && c < 622 && r > 199 && r < 475) || (c + r) % 97 == 0;
  return hole ? NoData : (c * 7919 + r * 104729 + c * r % 977) % 30011 - 10000;
}

class CachedRaster : public ::testing::Test {
protected:
  RasterFile File() const {
    RasterFile file;
    file.width = Width;
    file.height = Height;
    file.type = GDT_Int16;
    file.geotransform = std::array<double, 6>{0, 1, 0, 0, 0, -1};
    file.crs = "+proj=eqc +R=1737400 +type=crs";
    file.noData = NoData;
    file.scale = 0.5;
    file.offset = 3.0;
    file.value = [](int c, int r, int) { return Value(c, r); };
    return file;
  }
  ElevationOptions Cached() const {
    ElevationOptions options;
    options.overviewCache = this->Overviews;
    return options;
  }
  int Files(const std::string& folder) const {
    return int(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  TemporaryFolder Folder;
  std::string Overviews = Folder / "cache/dspace";
  ElevationCache Builder{Overviews};
};

// All pixels of a cell, one by one; no data where under half of them have.
inline double MeanByHand(int column, int row, int factor, double (*value)(int, int)) {
  double sum = 0.0;
  int count = 0;
  int all = 0;
  for (int r = row * factor; r < std::min((row + 1) * factor, Height); ++r) {
    for (int c = column * factor; c < std::min((column + 1) * factor, Width); ++c, ++all) {
      if (value(c, r) != NoData) {
        sum += value(c, r) * 0.5 + 3.0;
        ++count;
      }
    }
  }
  return 2 * count < all ? std::nan("") : sum / count;
}

// Reads the window at `factor`; how many cells differ from the means.
inline int WrongCells(const ElevationSource& source, const RasterWindow& w, int factor,
                      double (*value)(int, int) = Value) {
  const std::vector<double> heights = source.ReadReduced(w, factor);
  const int columns = 1 + (w.width - 1) / factor;
  int wrong = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double mean = MeanByHand(w.column / factor + int(i) % columns,
                                   w.row / factor + int(i) / columns, factor, value);
    // Means up to 20,000 as floats, halved.
    wrong += std::isnan(mean) ? !std::isnan(heights[i]) : !(std::abs(heights[i] - mean) < 1e-3);
  }
  return wrong;
}

inline int WrongCells(const ElevationSource& source) {
  int wrong = 0;
  for (const int factor : {2, 4, 8}) {
    wrong += WrongCells(source, {0, 0, Width, Height}, factor);
  }
  return wrong;
}

} // namespace dspace::testing

#endif
