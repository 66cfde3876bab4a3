// The hills that horizons are measured on.
#ifndef DSPACE_BENCH_HILLS_H
#define DSPACE_BENCH_HILLS_H

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <gdal_priv.h>

namespace dspace::bench {

// Writes `side` x `side` pixels of `pixel` metres: hills of wavelengths from 3 pixels to the side,
// 10 degrees steep in the mean. Returns the path.
inline std::string WriteHills(const std::string& path, int side, double pixel) {
  GDALAllRegister();
  GDALDataset* dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path.c_str(), side, side, 1, GDT_Float32, nullptr);
  double geo[6] = {0.0, pixel, 0.0, 0.0, 0.0, -pixel};
  dataset->SetGeoTransform(geo);
  std::vector<float> row(static_cast<std::size_t>(side));
  for (int r = 0; r < side; ++r) {
    for (int c = 0; c < side; ++c) {
      double h = 0.0;
      for (double length = 3.0; length < side; length *= 1.7) {
        const double k = 2.0 * M_PI / length;
        h += 0.008 * pixel * length *
             (std::sin(k * (c + 0.4 * r) + length) + std::cos(k * (0.3 * c - r)));
      }
      row[std::size_t(c)] = float(h);
    }
    if (dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, r, side, 1, row.data(), side, 1,
                                            GDT_Float32, 0, 0, nullptr) != CE_None) {
      std::abort();
    }
  }
  GDALClose(dataset);
  return path;
}

} // namespace dspace::bench

#endif
