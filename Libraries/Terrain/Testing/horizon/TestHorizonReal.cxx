// Horizons of real ground against exact rays.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "HorizonTestSupport.h"
#include "TestData.h"

namespace {

using namespace dspace;
using namespace dspace::testing;

// Random posts of a terrain in random azimuths: mean, 99th of a hundred and greatest error [deg].
void ExpectExact(const StreamedTerrain& terrain, double mean, double most, double greatest,
                 int count = 400) {
  HorizonOptions options;
  options.heights = terrain.HeightRange();
  const HorizonSweep sweep(terrain.Pyramid(), terrain.Placement(), options);
  const PostLattice& lattice = terrain.Pyramid()->Lattice();
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<double> errors;
  for (int i = 0; i < count; ++i) {
    const auto c = std::int64_t(unit(random) * double(lattice.columns - 1));
    const auto r = std::int64_t(unit(random) * double(lattice.rows - 1));
    const double azimuth = 360.0 * unit(random);
    float height = 0.0f;
    terrain.Pyramid()->Read({0, c, r, 1, 1}, &height);
    if (std::isnan(height)) {
      continue;
    }
    const double exact = ExactHorizon(terrain, {double(c), double(r)}, double(height), azimuth,
                                      1e-5 * terrain.Placement().CellSize({double(c), double(r)}));
    errors.push_back(std::abs(SweptHorizon(sweep, 0, c, r, azimuth).first - exact));
  }
  std::sort(errors.begin(), errors.end());
  double sum = 0.0;
  for (const double e : errors) {
    sum += e / double(errors.size());
  }
  const double high = errors[std::size_t(0.99 * double(errors.size() - 1))];
  std::printf("%s: mean %.5f, 99 %% %.4f, most %.4f deg\n", terrain.GetName().c_str(), sum, high,
              errors.back());
  EXPECT_LT(sum, mean);
  EXPECT_LT(high, most);
  EXPECT_LT(errors.back(), greatest);
}

TEST(HorizonReal, Apollo15) {
  DSPACE_REAL_DATA(path, "terrain/moon_apollo15_nac_dtm_257.png");
  StreamedTerrainOptions options;
  options.elevation.pixelSize = 2.0;
  options.elevation.verticalScale = 49.0 / 255.0;
  options.elevation.verticalOffset = 0.0;
  options.elevation.verticalDatum = VerticalDatum::FromText("relative");
  ExpectExact(*StreamedTerrain::Open(path, options), 0.005, 0.05, 0.1);
}

TEST(HorizonReal, Gale) {
  DSPACE_REAL_DATA(path, "terrain/mars_gale_mola_128ppd_m.tif");
  StreamedTerrainOptions options;
  options.elevation.verticalScale = 1.0;
  options.elevation.verticalOffset = 0.0;
  options.elevation.verticalDatum = VerticalDatum::FromText("areoid");
  ExpectExact(*StreamedTerrain::Open(path, options), 0.005, 0.05, 0.1);
  options.onBody = true;
  ExpectExact(*StreamedTerrain::Open(path, options), 0.005, 0.05, 0.1, 200);
}

TEST(HorizonReal, MoonByLola) {
  DSPACE_REAL_DATA(path, "terrain/moon_lola_global_4ppd_km.tif");
  StreamedTerrainOptions options;
  options.elevation.verticalScale = 1000.0;
  options.elevation.verticalOffset = 0.0;
  options.elevation.verticalDatum = VerticalDatum::FromText("sphere");
  options.onBody = true;
  ExpectExact(*StreamedTerrain::Open(path, options), 0.01, 0.05, 0.13, 200);
}

} // namespace
