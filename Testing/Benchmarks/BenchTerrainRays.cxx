// Rays and heights a second on plain, grouped and tracked streamed terrain, against each other and
// against rays on a grid in memory.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <random>

#include <gdal_priv.h>
#include <unistd.h>

#include <dspace/surface/GridTerrain.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Alternate.h"

using namespace dspace;

namespace {

constexpr int Side = 1024;     // pixels of the raster below
constexpr double Pixel = 10.0; // [m]
constexpr int Rays = 500;      // of a turn

double Hills(double x, double y) {
  return 120.0 * std::sin(x / 900.0) * std::cos(y / 700.0) +
         15.0 * std::sin(x / 130.0 + y / 170.0) + 1.5 * std::sin(x / 31.0) * std::sin(y / 27.0);
}

// A raster of `width` x `width` square pixels about the origin.
std::string Write(const std::string& path, int width, double pixel,
                  const std::function<double(double x, double y)>& height) {
  GDALAllRegister();
  GDALDataset* dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path.c_str(), width, width, 1, GDT_Float32, nullptr);
  const double half = 0.5 * width * pixel;
  double geo[6] = {-half, pixel, 0.0, half, 0.0, -pixel};
  dataset->SetGeoTransform(geo);
  std::vector<float> row(width);
  for (int r = 0; r < width; ++r) {
    for (int c = 0; c < width; ++c) {
      row[c] = float(height((c + 0.5) * pixel - half, half - (r + 0.5) * pixel));
    }
    if (dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, r, width, 1, row.data(), width, 1,
                                            GDT_Float32, 0, 0, nullptr) != CE_None) {
      std::abort();
    }
  }
  GDALClose(dataset);
  return path;
}

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

// Down onto the ground, or along it for kilometres, over a square about the origin.
std::vector<Ray> MakeRays(bool grazing, double reach) {
  std::mt19937 random(grazing ? 2 : 1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Ray> rays(Rays);
  for (Ray& ray : rays) {
    const double x = reach * unit(random);
    const double y = reach * unit(random);
    if (grazing) {
      const double azimuth = M_PI * unit(random);
      ray.origin << x, y, Hills(x, y) + 20.0 + 15.0 * unit(random);
      ray.direction << std::cos(azimuth), std::sin(azimuth), 0.02 + 0.02 * unit(random);
    } else {
      ray.origin << x, y, 2000.0;
      ray.direction << 0.5 * unit(random), 0.5 * unit(random), -1.0;
    }
    ray.direction.normalize();
  }
  return rays;
}

int Shoot(const TerrainSurface& surface, const std::vector<Ray>& rays) {
  int hits = 0;
  for (const Ray& ray : rays) {
    hits += surface.Intersect(ray.origin, ray.direction).hit;
  }
  return hits;
}

void Against(const char* name, const TerrainSurface& subject, const TerrainSurface& reference,
             const std::vector<Ray>& rays) {
  int hits[2] = {};
  const bench::Turns turns = bench::Alternate(
      9, [&] { hits[0] = Shoot(subject, rays); }, [&] { hits[1] = Shoot(reference, rays); });
  char behind[160];
  std::snprintf(behind, sizeof behind, "%.3g rays a second against %.3g; %d and %d of %d hit",
                Rays / bench::Median(turns.subject), Rays / bench::Median(turns.reference), hits[0],
                hits[1], Rays);
  bench::Print(name, turns, Rays, behind);
}

// Places that were never asked for before, in the patch that is coarser than the group's posts.
void ScatteredHeights(const StreamedTerrain& group, const StreamedTerrain& plain, double reach) {
  constexpr int Count = 4000;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Rows2 places(Count, 2);
  Eigen::VectorXd heights(Count);
  const auto ask = [&](const StreamedTerrain& terrain) {
    for (int i = 0; i < Count; ++i) {
      places.row(i) << reach * unit(random), reach * unit(random);
    }
    terrain.HeightsMap(places, heights);
  };
  const bench::Turns turns = bench::Alternate(
      5, [&] { ask(group); }, [&] { ask(plain); });
  char behind[160];
  std::snprintf(behind, sizeof behind, "%.3g a second against %.3g; goal <= 4",
                Count / bench::Median(turns.subject), Count / bench::Median(turns.reference));
  bench::Print("scattered heights in a coarse patch against the plain raster", turns, Count,
               behind);
}

} // namespace

int main() {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("dspace-bench-rays-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string base = Write((folder / "base.tif").string(), Side, Pixel, Hills);
  StreamedTerrainOptions options;
  const auto plain = StreamedTerrain::Open(base, options);
  const auto grid = GridTerrain::Load(base, {});
  TerrainPatch coarse; // 4 km of 5 m
  coarse.path = Write((folder / "coarse.tif").string(), 800, 5.0,
                      [](double x, double y) { return Hills(x, y) + 0.3 * std::sin(x / 12.0); });
  TerrainPatch fine; // a site of 60 m, every 0.1 m
  fine.path = Write((folder / "fine.tif").string(), 600, 0.1,
                    [](double x, double y) { return Hills(x, y) + 0.05 * std::sin(x / 0.7); });
  options.patches = {coarse, fine};
  const auto group = StreamedTerrain::Open(base, options);
  options.patches.clear();
  options.subdivisions = 8; // 4 cm
  const auto tracked = StreamedTerrain::Open(base, options);
  std::vector<TrackAddition> tracks(6);
  for (int wheel = 0; wheel < 6; ++wheel) {
    tracks[wheel].name = "wheel " + std::to_string(wheel);
    for (int i = 0; i < 4000; ++i) { // 2 km
      const double angle = i / 300.0;
      tracks[wheel].contacts.push_back(
          {{(150.0 + wheel) * std::cos(angle) + 0.1 * i, (150.0 + wheel) * std::sin(angle)}, 0.05});
    }
  }
  tracked->AddTracks(tracks);
  for (const bool grazing : {false, true}) {
    const std::vector<Ray> rays = MakeRays(grazing, 4500.0);
    const std::string kind = grazing ? "grazing rays, " : "steep rays, ";
    Against((kind + "streamed against a grid in memory").c_str(), *plain, *grid, rays);
    Against((kind + "group against plain").c_str(), *group, *plain, rays);
    Against((kind + "tracked against plain").c_str(), *tracked, *plain, rays);
    const std::vector<Ray> near = MakeRays(grazing, 400.0);
    Against((kind + "group against plain, over the patches").c_str(), *group, *plain, near);
    Against((kind + "tracked against plain, over the ruts").c_str(), *tracked, *plain, near);
  }
  ScatteredHeights(*group, *plain, 1900.0);
  std::filesystem::remove_all(folder);
  return 0;
}
