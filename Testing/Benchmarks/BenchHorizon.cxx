// Far shadows: the sweep for horizons against exact rays, and a Sun that creeps against a full
// sweep.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>

#include <unistd.h>

#include <dspace/clipmap/ClipmapHorizon.h>
#include <dspace/horizon/HorizonSweep.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Alternate.h"
#include "BenchHills.h"

using namespace dspace;

namespace {

constexpr int Side = 2048;    // pixels
constexpr double Pixel = 2.0; // [m]
constexpr int Window = 128;   // posts a side that are swept

double Seconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

// One thread: post-steps a second, of those that are followed and of all with those that bounds
// skip.
void Steps(const HorizonSweep& sweep) {
  std::vector<float> all(std::size_t(Window) * Window);
  std::vector<float> distant(all.size());
  std::vector<double> marched;
  std::vector<double> covered;
  std::vector<double> seconds;
  for (int i = 0; i < 24; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const HorizonReport report =
        sweep.Sweep({0, 900, 700, Window, Window}, 7.3 + 15.0 * i, all.data(), distant.data());
    const double spent = Seconds(begin);
    if (i >= 4) { // tiles are there
      marched.push_back(double(report.steps) / spent);
      covered.push_back(double(report.steps + report.skipped) / spent);
      seconds.push_back(spent);
    }
  }
  const auto [low, high] = std::minmax_element(marched.begin(), marched.end());
  std::printf(
      "horizon sweep, one thread: %.3g post-steps a second (%.3g..%.3g), %.3g with those that "
      "are skipped; goal >= 2e7; %.1f ms for %d x %d posts in one azimuth\n",
      bench::Median(marched), *low, *high, bench::Median(covered), 1e3 * bench::Median(seconds),
      Window, Window);
}

// A sweep for all posts of a block against one ray a post towards the Sun.
void AgainstRays(const HorizonSweep& sweep, const StreamedTerrain& terrain) {
  constexpr int Rays = 512;
  std::vector<float> all(1024);
  std::mt19937 random(4);
  std::uniform_int_distribution<int> place(0, 31);
  double azimuth = 3.0;
  int hits = 0;
  const bench::Turns turns = bench::Alternate(
      9,
      [&] {
        azimuth += 37.7;
        for (int i = 0; i < 8; ++i) {
          sweep.Sweep({0, 900 + 32 * i, 700, 32, 32}, azimuth, all.data(), nullptr);
        }
      },
      [&] {
        for (int i = 0; i < Rays; ++i) {
          const Eigen::Vector2d post(900.0 + place(random), 700.0 + place(random));
          const Eigen::Vector3d from = terrain.Placement().ToScene(
              post, terrain.Sample(terrain.Placement().ToScene(post, 0.0)).height + 1e-3);
          const double a = azimuth * M_PI / 180.0;
          hits += terrain.Intersect(from, Eigen::Vector3d(std::sin(a), std::cos(a), 0.09)).hit;
        }
      });
  char behind[160];
  std::snprintf(behind, sizeof behind, "a post: %.2f us swept against %.2f us of one ray at 5 deg",
                1e6 * bench::Median(turns.subject) / 8192,
                1e6 * bench::Median(turns.reference) / Rays);
  bench::Print("8192 posts swept against 512 rays", turns, 1, behind);
}

// All levels of a view: a hundred steps of the Sun by 0.01 degrees against as many full sweeps.
void Creeping(const StreamedTerrain& terrain) {
  constexpr int Steps = 100;
  ClipmapLevels levels(terrain.Pyramid(), 124);
  ClipmapLevels::View view;
  view.place = {0.5 * Side, 0.5 * Side};
  view.height = 30.0;
  view.cellSize = Pixel;
  view.wait = 60.0;
  const ClipmapLevels::State state =
      levels.Update(view, [](int, const ClipmapUpdate&, const ClipmapTexel*) {});
  HorizonOptions options;
  options.heights = terrain.HeightRange();
  const auto blocks = std::make_shared<HorizonBlocks>(
      HorizonSweep(terrain.Pyramid(), terrain.Placement(), options));
  ClipmapHorizon horizon(blocks);
  double azimuth = 11.013;
  const auto update = [&](double elevation) {
    const double a = azimuth * M_PI / 180.0;
    const double e = elevation * M_PI / 180.0;
    horizon.Update(levels, state,
                   {std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)}, 600.0,
                   [](int, const std::vector<HorizonTexel>&) {});
  };
  const bench::Turns turns = bench::Alternate(
      7,
      [&] {
        for (int i = 0; i < Steps; ++i) {
          azimuth += 0.01;
          update(5.0);
        }
      },
      [&] {
        azimuth += 2.0;
        update(5.0);
      });
  std::vector<double> ratios;
  for (std::size_t i = 0; i < turns.ratio.size(); ++i) {
    ratios.push_back(turns.ratio[i] / Steps);
  }
  std::printf(
      "Sun moved by 0.01 deg against a full sweep: ratio %.4f; %.3f ms against %.1f ms of %d "
      "levels in 2 threads; goal <= 0.1\n",
      bench::Median(ratios), 1e3 * bench::Median(turns.subject) / Steps,
      1e3 * bench::Median(turns.reference), levels.Count() - state.finest);
}

} // namespace

int main() {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                       ("dspace-bench-horizon-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const auto terrain =
      StreamedTerrain::Open(bench::WriteHills((folder / "hills.tif").string(), Side, Pixel));
  HorizonOptions options;
  options.heights = terrain->HeightRange();
  const HorizonSweep sweep(terrain->Pyramid(), terrain->Placement(), options);
  Steps(sweep);
  AgainstRays(sweep, *terrain);
  Creeping(*terrain);
  std::filesystem::remove_all(folder);
  return 0;
}
