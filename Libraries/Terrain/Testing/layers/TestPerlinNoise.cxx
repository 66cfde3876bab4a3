// Gradient noise against the paper's definition, and its octaves.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/layers/PerlinNoise.h>

namespace {

using dspace::NoiseOptions;
using dspace::OctaveNoise;
using dspace::PerlinNoise;
using Eigen::Vector3d;

// The permutation of Perlin's reference implementation (2002).
const PerlinNoise::Permutation Published = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103,
    30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,
    197, 62,  94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174,
    20,  125, 136, 171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231,
    83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143,
    54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196,
    135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124,
    123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,
    182, 189, 28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101,
    155, 167, 43,  172, 9,   129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185,
    112, 104, 218, 246, 97,  228, 251, 34,  242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,
    51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,  181, 199, 106, 157, 184, 84,  204, 176,
    115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114, 67,  29,  24,  72,  243,
    141, 128, 195, 78,  66,  215, 61,  156, 180};

// The first is widely published for the reference implementation; all were computed from the
// paper's definition as a sum of eight weighted ramps, in another language.
TEST(PerlinNoise, HasTheReferencesValues) {
  const PerlinNoise noise(Published);
  EXPECT_NEAR(noise.At({3.14, 42.0, 7.0}), 0.13691995878400012, 1e-14);
  EXPECT_NEAR(noise.At({0.5, 0.5, 0.5}), -0.25, 1e-14);
  EXPECT_NEAR(noise.At({12.25, 100.75, 200.125}), -0.03862234251573682, 1e-13);
  EXPECT_NEAR(noise.At({254.9, 17.3, 88.6}), 0.27896898125322434, 1e-13);
  EXPECT_NEAR(noise.At({0.1, 0.9, 0.3}), -0.03419991416432711, 1e-14);
}

TEST(PerlinNoise, SeedsShuffleAsStated) {
  const auto starts = [](std::uint32_t seed, std::initializer_list<int> first,
                         std::initializer_list<int> last, double value) {
    const PerlinNoise::Permutation table = PerlinNoise::Shuffled(seed);
    EXPECT_TRUE(std::equal(first.begin(), first.end(), table.begin())) << seed;
    EXPECT_TRUE(std::equal(last.begin(), last.end(), table.end() - 4)) << seed;
    EXPECT_NEAR(PerlinNoise(seed).At({12.25, 100.75, 200.125}), value, 1e-13) << seed;
    std::array<int, 256> seen = {};
    for (const std::uint8_t value8 : table) {
      ++seen[value8];
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), 256);
  };
  starts(0, {130, 157, 1, 180, 243, 154, 40, 111}, {245, 6, 110, 226}, 0.13791348389349878);
  starts(1, {52, 74, 69, 87, 54, 16, 242, 158}, {112, 246, 190, 145}, 0.41738955106120557);
  starts(4294967295U, {161, 220, 46, 151, 67, 202, 78, 74}, {18, 236, 96, 115},
         -0.10712224245071411);
}

// At whole points it is 0 and its gradient one of the cube's edges; values, slopes and curvatures
// run on across the faces of cells, also those where the table is taken from elsewhere.
TEST(PerlinNoise, IsSmoothAcrossCellsAndBlocks) {
  const PerlinNoise noise(7);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const double from : {-1.0, 0.0, 5.0, -257.0, 255.0, 511.0, 1e6 * 256.0 - 1.0}) {
    for (int i = 0; i < 40; ++i) {
      const Vector3d corner(from + 1.0, std::floor(300.0 * unit(random)), -3.0);
      EXPECT_EQ(noise.At(corner), 0.0);
      Vector3d gradient;
      constexpr double H = 1.0 / 4096.0; // exact at any of these places
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d step = H * Vector3d::Unit(axis);
        gradient[axis] = (noise.At(corner + step) - noise.At(corner - step)) / (2.0 * H);
        EXPECT_NEAR(gradient[axis], std::round(gradient[axis]), 1e-5);
      }
      EXPECT_NEAR(gradient.squaredNorm(), 2.0, 1e-4);
      // Through the face x = from + 1, at any place of it.
      const Vector3d p = corner + Vector3d(0.0, unit(random), unit(random));
      constexpr double D = 1.0 / 1024.0;
      const auto at = [&](int k) { return noise.At(p + Vector3d(k * D, 0.0, 0.0)); };
      const double before = (at(0) - at(-1)) / D, after = (at(1) - at(0)) / D;
      EXPECT_NEAR(before, after, 0.02); // a kink would be of the order of 1
      EXPECT_NEAR(at(0), 0.5 * (at(1) + at(-1)), 1e-4);
    }
  }
}

TEST(PerlinNoise, KeepsItsBoundHasMeanZeroAndDoesNotRepeat) {
  const PerlinNoise noise(11);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-1000.0, 1000.0);
  double sum = 0.0, squares = 0.0, repeated = 0.0, most = 0.0;
  constexpr int Count = 100000;
  for (int i = 0; i < Count; ++i) {
    const Vector3d p(anywhere(random), anywhere(random), anywhere(random));
    const double value = noise.At(p);
    sum += value;
    squares += value * value;
    repeated += value * noise.At(p + Vector3d(256.0, 0.0, 0.0));
    most = std::max(most, std::abs(value));
  }
  const double rms = std::sqrt(squares / Count);
  EXPECT_NEAR(sum / Count, 0.0, 4.0 * rms / std::sqrt(double(Count)));
  EXPECT_GT(rms, 0.2);
  EXPECT_LT(rms, 0.35);
  EXPECT_LE(most, PerlinNoise::Most);
  EXPECT_NEAR(repeated / squares, 0.0, 0.02);
  // The greatest that any gradients give at a place, found by going through them all.
  double bound = 0.0;
  for (int x = 0; x <= 40; ++x) {
    for (int y = x; y <= 40; ++y) {
      for (int z = y; z <= 40; ++z) {
        const Vector3d f(x / 40.0, y / 40.0, z / 40.0);
        double total = 0.0;
        for (int c = 0; c < 8; ++c) {
          double weight = 1.0;
          Vector3d d;
          for (int axis = 0; axis < 3; ++axis) {
            const double t = f[axis];
            const double w = ((6.0 * t - 15.0) * t + 10.0) * t * t * t;
            weight *= c >> axis & 1 ? w : 1.0 - w;
            d[axis] = std::abs(t - (c >> axis & 1));
          }
          total += weight * (d.sum() - d.minCoeff());
        }
        bound = std::max(bound, total);
      }
    }
  }
  EXPECT_LE(bound, PerlinNoise::Most);
  EXPECT_GT(bound, PerlinNoise::Most - 1e-3);
}

TEST(PerlinNoise, OctavesComeInAsSamplesResolveThem) {
  NoiseOptions options;
  options.wavelength = 16.0;
  options.octaves = 3; // 16, 8 and 4 m
  options.gain = 0.5;
  options.seed = 5;
  const OctaveNoise noise(options);
  EXPECT_EQ(noise.Most(), 1.75);
  EXPECT_EQ(noise.ShortestWavelength(), 4.0);
  options.octaves = 2;
  const OctaveNoise two(options);
  const Vector3d p(123.4, -77.7, 3.3);
  EXPECT_EQ(noise.At(p, 0.9), noise.At(p, 1e-3)); // all of them whole
  EXPECT_EQ(noise.At(p, 2.0), two.At(p, 2.0));    // 4 m at 2 m: left out
  EXPECT_EQ(two.At(p, 2.0), two.At(p, 0.1));
  EXPECT_NE(noise.At(p, 1.9), two.At(p, 1.9));
  EXPECT_EQ(noise.At(p, 8.0), 0.0);
  EXPECT_TRUE(noise.Silent(8.0));
  EXPECT_FALSE(noise.Silent(7.9));
  // Evenly, without a step, from none at 2 m to all at 1 m; half way in zooms half of it.
  const double none = noise.At(p, 2.0), all = noise.At(p, 1.0);
  EXPECT_NEAR(noise.At(p, std::sqrt(2.0)), 0.5 * (none + all), 1e-12);
  EXPECT_NEAR(noise.At(p, 2.0 - 1e-4), none, 1e-9);
  EXPECT_NEAR(noise.At(p, 1.0 + 1e-4), all, 1e-9);
}

TEST(PerlinNoise, BadOptionsAreRejected) {
  const auto rejected = [](double wavelength, int octaves, double gain) {
    NoiseOptions options;
    options.wavelength = wavelength;
    options.octaves = octaves;
    options.gain = gain;
    EXPECT_THROW(OctaveNoise{options}, dspace::Error) << wavelength << octaves << gain;
  };
  rejected(0.0, 1, 0.5);
  rejected(std::nan(""), 1, 0.5);
  rejected(2e7, 1, 0.5);
  rejected(1.0, 0, 0.5);
  rejected(1.0, 17, 0.5);
  rejected(1.0, 1, 0.0);
  rejected(1.0, 1, 1.01);
}

} // namespace
