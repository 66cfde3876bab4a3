// Values of a field a second, for arrays of places, against one GDAL read of the four pixels around
// each place.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <vector>

#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <unistd.h>

#include <dspace/crs/CrsTransform.h>
#include <dspace/layers/raster/RasterField.h>

#include "Alternate.h"

using namespace dspace;

namespace {

constexpr int Side = 4096; // pixels
constexpr int Count = 200000;

std::string Write(const std::string& path) {
  GDALAllRegister();
  const char* const options[] = {"TILED=YES", "COMPRESS=DEFLATE", nullptr};
  GDALDataset* dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path.c_str(), Side, Side, 1, GDT_Float32, const_cast<char**>(options));
  OGRSpatialReference srs;
  srs.SetFromUserInput("+proj=stere +lat_0=-90 +R=1737400 +units=m +no_defs");
  dataset->SetSpatialRef(&srs);
  double geo[6] = {-10.0 * Side, 20.0, 0.0, 10.0 * Side, 0.0, -20.0};
  dataset->SetGeoTransform(geo);
  std::vector<float> row(Side);
  for (int r = 0; r < Side; ++r) {
    for (int c = 0; c < Side; ++c) {
      row[std::size_t(c)] = float(std::sin(c / 90.0) * std::cos(r / 70.0));
    }
    if (dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, r, Side, 1, row.data(), Side, 1,
                                            GDT_Float32, 0, 0, nullptr) != CE_None) {
      std::abort();
    }
  }
  GDALClose(dataset);
  return path;
}

// Bilinear between the four pixels around each place, of a raster whose CRS is the places'.
double ByGdal(GDALRasterBand& band, const Eigen::Matrix2Xd& map) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < map.cols(); ++i) {
    const double x = (map(0, i) + 10.0 * Side) / 20.0 - 0.5;
    const double y = (10.0 * Side - map(1, i)) / 20.0 - 0.5;
    const int c = int(x);
    const int r = int(y);
    float p[4];
    if (band.RasterIO(GF_Read, c, r, 2, 2, p, 2, 2, GDT_Float32, 0, 0, nullptr) != CE_None) {
      std::abort();
    }
    const double u = x - c;
    const double v = y - r;
    sum += (1.0 - v) * ((1.0 - u) * p[0] + u * p[1]) + v * ((1.0 - u) * p[2] + u * p[3]);
  }
  return sum;
}

void Compare(const char* name, const RasterField& field, GDALRasterBand& band,
             const Eigen::Matrix2Xd& places, const Eigen::Matrix2Xd& map, const char* goal) {
  double sums[2] = {};
  const bench::Turns turns = bench::Alternate(
      7, [&] { sums[0] = field.Values(places).sum(); }, [&] { sums[1] = ByGdal(band, map); });
  char behind[200];
  std::snprintf(behind, sizeof behind,
                "%.3g values a second against %.3g; sums %.6f and %.6f; goal %s",
                Count / bench::Median(turns.subject), Count / bench::Median(turns.reference),
                sums[0], sums[1], goal);
  bench::Print(name, turns, Count, behind);
}

} // namespace

int main() {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                       ("dspace-bench-fields-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string path = Write((folder / "field.tif").string());
  GDALDataset* dataset = GDALDataset::Open(path.c_str(), GDAL_OF_RASTER);
  RasterPlace terrain;
  terrain.name = "terrain 'same'";
  terrain.crs = Crs::FromOgr(*dataset->GetSpatialRef());
  terrain.pixelToMap.linear() << 20.0, 0.0, 0.0, -20.0;
  terrain.pixelToMap.translation() << -10.0 * Side, 10.0 * Side;
  terrain.columns = terrain.rows = Side;
  const RasterField same("same", path, terrain);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> inside(-9.9 * Side, 9.9 * Side);
  Eigen::Matrix2Xd map(2, Count);
  for (Eigen::Index i = 0; i < map.size(); ++i) {
    map.data()[i] = inside(random);
  }
  Compare("random places", same, *dataset->GetRasterBand(1), map, map, "<= 1");
  Eigen::Matrix2Xd near = 0.02 * map;
  Compare("places within a few tiles", same, *dataset->GetRasterBand(1), near, near, "<= 0.2");
  RasterPlace globe; // the same places through another projection
  globe.name = "terrain 'globe'";
  globe.crs = terrain.crs.Geographic();
  globe.pixelToMap.linear() << 1.0, 0.0, 0.0, -1.0;
  globe.pixelToMap.translation() << -180.0, 90.0;
  globe.columns = 360;
  globe.rows = 180;
  const RasterField other("other", path, globe);
  Eigen::Matrix2Xd degrees = near;
  CrsTransform(terrain.crs, globe.crs).TryApply(degrees);
  Compare("the same through another projection", other, *dataset->GetRasterBand(1), degrees, near,
          "<= 1");
  GDALClose(dataset);
  std::filesystem::remove_all(folder);
}
