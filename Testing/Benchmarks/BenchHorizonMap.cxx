// Maps of horizons against a scan of single rays, viewsheds against GDAL's, and illumination.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <unistd.h>

#include <dspace/maps/Illumination.h>
#include <dspace/maps/Viewshed.h>
#include <dspace/measure/HorizonScan.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Alternate.h"
#include "BenchHills.h"

using namespace dspace;

namespace {

constexpr int Side = 1024;    // pixels
constexpr double Pixel = 5.0; // [m]

MapControl OneThread() {
  MapControl control;
  control.threads = 1;
  control.replace = true;
  return control;
}

// Cells x azimuths a second, one thread each.
void Horizons(const MapGround& ground, const TerrainSurface& surface, const std::string& path) {
  constexpr int Scanned = 16; // cells
  HorizonMapOptions options;
  options.cells.column = 300;
  options.cells.row = 400;
  options.cells.columns = options.cells.rows = 64;
  options.height = 2.0;
  options.azimuths = 72;
  Obstacles obstacles;
  obstacles.Add(Obstacles::Ground{"ground", {std::shared_ptr<void>(), &surface}, {}});
  std::mt19937 random(5);
  double sum = 0.0;
  const bench::Turns turns = bench::Alternate(
      7, [&] { WriteHorizonMap(ground, options, path, OneThread()); },
      [&] {
        for (int i = 0; i < Scanned; ++i) {
          const Eigen::Vector2d post = options.cells.Post(int(random() % 64), int(random() % 64));
          const double height = surface.Sample(ground.placement.ToScene(post, 0.0)).height;
          const Eigen::Vector3d place = ground.placement.ToScene(post, height + 2.0);
          sum += ScanHorizon(obstacles, place, {}, std::size_t(options.azimuths), "p")[0]
                     .elevation_deg;
        }
      });
  const double ours = 64.0 * 64.0 * options.azimuths / bench::Median(turns.subject);
  const double scan = double(Scanned) * options.azimuths / bench::Median(turns.reference);
  std::printf("horizon map, one thread, survey and file included: %.3g cell-azimuths a second "
              "against %.3g of exact bisected rays: %.1f times as fast\n",
              ours, scan, ours / scan);
}

void Viewsheds(const MapGround& ground, const std::string& raster, const std::string& path) {
  ViewshedOptions options;
  options.cells = FindCells(ground, std::nullopt, 0.0);
  options.observers = {{{500.0, 480.0}, 20.0}};
  GDALDataset* dataset = static_cast<GDALDataset*>(GDALOpen(raster.c_str(), GA_ReadOnly));
  const bench::Turns turns = bench::Alternate(
      5, [&] { WriteViewshed(ground, options, path, OneThread()); },
      [&] {
        const std::string out = path + ".gdal.tif";
        GDALDatasetH made =
            GDALViewshedGenerate(dataset->GetRasterBand(1), "GTiff", out.c_str(), nullptr,
                                 500.5 * Pixel, -480.5 * Pixel, 20.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0,
                                 GVM_Edge, 0.0, nullptr, nullptr, GVOT_NORMAL, nullptr);
        GDALClose(made);
      });
  GDALClose(dataset);
  char behind[160];
  std::snprintf(behind, sizeof behind, "%d x %d cells: %.2f s of exact lines against %.2f s", Side,
                Side, bench::Median(turns.subject), bench::Median(turns.reference));
  bench::Print("viewshed of every cell against GDALViewshedGenerate, one thread", turns, 1, behind);
}

// 18.6 years by hours of four tiles, whose rate is that of larger maps.
void Illuminate(const MapGround& ground, const std::string& horizons, const std::string& path) {
  constexpr int Hours = int(18.6 * 365.25 * 24.0);
  constexpr int Cells = 128; // a side
  HorizonMapOptions sweeping;
  sweeping.cells.column = 300;
  sweeping.cells.row = 400;
  sweeping.cells.columns = sweeping.cells.rows = Cells;
  sweeping.height = 2.0;
  MapControl control;
  control.replace = true;
  WriteHorizonMap(ground, sweeping, horizons, control);
  const HorizonMap map(horizons);
  IlluminationOptions options;
  for (int k = 0; k < Hours; ++k) { // a polar Sun
    const double azimuth = 2.0 * M_PI * k / 708.7;
    const double elevation = 0.027 * std::sin(2.0 * M_PI * k / 8310.0);
    options.sun_S.push_back(1.496e11 * Eigen::Vector3d(std::sin(azimuth) * std::cos(elevation),
                                                       std::cos(azimuth) * std::cos(elevation),
                                                       std::sin(elevation)));
  }
  using Q = IlluminationOptions::Quantity;
  options.quantities = {Q::LitFraction, Q::LongestNight};
  for (const int threads : {1, 0}) {
    control.threads = threads;
    std::vector<double> rates;
    for (int i = 0; i < 3; ++i) {
      const auto begin = std::chrono::steady_clock::now();
      WriteIllumination(map, options, path, control);
      rates.push_back(
          double(Cells) * Cells * Hours /
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    const double rate = bench::Median(rates);
    std::printf("illumination of 18.6 years by hours, %s: %.3g cell-hours a second, so %.0f s for "
                "1024 x 1024 cells; goal >= 3e8\n",
                threads == 1 ? "one thread" : "all threads", rate, 1024.0 * 1024.0 * Hours / rate);
  }
}

} // namespace

int main() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                       ("dspace-bench-horizon-map-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string raster = bench::WriteHills((folder / "hills.tif").string(), Side, Pixel);
  const auto terrain = StreamedTerrain::Open(raster);
  const MapGround ground = MapGroundOf(*terrain);
  const std::string horizons = (folder / "horizons.tif").string();
  Horizons(ground, *terrain, horizons);
  Viewsheds(ground, raster, (folder / "view.tif").string());
  Illuminate(ground, horizons, (folder / "lit.tif").string());
  std::filesystem::remove_all(folder);
  return 0;
}
