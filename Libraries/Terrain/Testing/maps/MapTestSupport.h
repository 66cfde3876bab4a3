// Grounds for tests of maps, and their horizons by exact rays.
#ifndef DSPACE_TEST_MAP_TEST_SUPPORT_H
#define DSPACE_TEST_MAP_TEST_SUPPORT_H

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <dspace/maps/HorizonMap.h>
#include <dspace/measure/HorizonScan.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Globe.h"
#include "RasterFile.h"
#include "TemporaryFolder.h"

namespace dspace::testing {

inline std::string BytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Hills of many sizes about a place [m], of slopes about `slope` in the mean.
inline double Hills(double x, double y, double least, double greatest, double slope) {
  double h = 0.0;
  for (double length = least; length < greatest; length *= 1.9) {
    const double k = 2.0 * M_PI / length;
    h += slope / k *
         (std::sin(k * (x + 0.4 * y) + length) + 0.8 * std::cos(k * (0.3 * x - y) + 3.0 * length));
  }
  return h;
}

// A degree grid on a sphere of `radius` metres, of `columns` x `rows` pixels of `step` degrees from
// its corner (west, north).
inline std::string WriteDegrees(const TemporaryFolder& folder, const std::string& name,
                                double radius, int columns, int rows, double west, double north,
                                double step,
                                const std::function<double(double lon, double lat)>& height) {
  RasterFile file;
  file.width = columns;
  file.height = rows;
  file.crs = "+proj=longlat +R=" + std::to_string(radius) + " +no_defs";
  file.verticalDatum = "sphere";
  file.geotransform = std::array<double, 6>{west, step, 0, north, 0, -step};
  file.value = [&](int c, int r, int) {
    return double(float(height(west + (c + 0.5) * step, north - (r + 0.5) * step)));
  };
  return file.Write((folder.Path() / name).string());
}

inline std::shared_ptr<StreamedTerrain> OnBody(const std::string& path) {
  StreamedTerrainOptions options;
  options.onBody = true;
  return StreamedTerrain::Open(path, options);
}

// 200 x 160 pixels of 243 m with hills, on the Moon's sphere from 30 degrees east and 62 degrees
// north on.
inline std::shared_ptr<StreamedTerrain> HillyMoon(const TemporaryFolder& folder) {
  const double metres = 1737400.0 * Degree;
  return OnBody(WriteDegrees(folder, "hills.tif", 1737400.0, 200, 160, 30.0, 62.0, 0.008,
                             [&](double lon, double lat) {
                               return Hills(lon * metres * 0.5, lat * metres, 900.0, 60000.0, 0.05);
                             }));
}

// The bands of a GeoTIFF, row by row.
inline std::vector<std::vector<float>> BandsOf(const std::string& path) {
  GDALAllRegister();
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(path.c_str(), GA_ReadOnly));
  const int width = dataset->GetRasterXSize();
  const int height = dataset->GetRasterYSize();
  std::vector<std::vector<float>> bands;
  for (int b = 1; b <= dataset->GetRasterCount(); ++b) {
    bands.emplace_back(std::size_t(width) * std::size_t(height));
    EXPECT_EQ(dataset->GetRasterBand(b)->RasterIO(GF_Read, 0, 0, width, height, bands.back().data(),
                                                  width, height, GDT_Float32, 0, 0, nullptr),
              CE_None);
  }
  GDALClose(dataset);
  return bands;
}

// Errors [deg] of random cells and azimuths of a map against ScanHorizon, sorted; cells without
// data must be NaN in both.
inline std::vector<double> ErrorsOf(const HorizonMap& map, const MapGround& ground,
                                    const MapCells& cells, const TerrainSurface& surface, int count,
                                    unsigned seed) {
  std::vector<double> errors;
  std::mt19937 random(seed);
  Obstacles obstacles;
  obstacles.Add(Obstacles::Ground{"ground", {std::shared_ptr<void>(), &surface}, {}});
  for (int i = 0; i < count; ++i) {
    const int c = int(random() % unsigned(cells.columns));
    const int r = int(random() % unsigned(cells.rows));
    const std::vector<float> mapped = map.Read(c, r, 1, 1);
    const Eigen::Vector2d post = cells.Post(c, r);
    float height = 0.0f;
    ground.pyramid->Read({0, std::int64_t(post.x()), std::int64_t(post.y()), 1, 1}, &height);
    if (std::isnan(height)) {
      errors.push_back(std::isnan(mapped[0]) ? 0.0 : 180.0);
      continue;
    }
    const Eigen::Vector3d place = ground.placement.ToScene(post, double(height) + map.Height());
    LevelAxes axes;
    axes.up = ground.placement.Up(place);
    axes.north = ground.placement.North(place);
    axes.east = axes.north.cross(axes.up);
    const auto exact = ScanHorizon(obstacles, place, axes, mapped.size(), "cell");
    for (std::size_t k = 0; k < mapped.size(); ++k) {
      if (mapped[k] == -90.0f && exact[k].distance < 1e-5) {
        continue; // at the border a ray from a lifted place meets the ground below itself
      }
      errors.push_back(std::abs(double(mapped[k]) - exact[k].elevation_deg));
    }
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

inline double Share(const std::vector<double>& sorted, double share) {
  return sorted[std::size_t(share * double(sorted.size() - 1))];
}

} // namespace dspace::testing

#endif
