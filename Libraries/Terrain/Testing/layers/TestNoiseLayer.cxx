// Noise that is painted: at its places, at every zoom, in every chart.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/layers/NoiseLayer.h>

namespace {

using namespace dspace;

ColorGrid Plane(double pixel) {
  Eigen::Affine2d map = Eigen::Affine2d::Identity();
  map.linear() << pixel, 0.0, 0.0, -pixel;
  map.translation() << -300.0, 200.0;
  ColorGrid grid;
  grid.placement = PostPlacement::OnPlane(map, -41.0);
  grid.rootPosts.setConstant(1024.0);
  grid.extent = Eigen::AlignedBox2d(Eigen::Vector2d(0, 0), Eigen::Vector2d(1024, 1024));
  return grid;
}

constexpr double Radius = 1000.0;

// Posts of a degree; root tiles of 180 degrees.
ColorGrid Body() {
  ColorGrid grid;
  grid.placement = PostPlacement::OnSphere({-180.0, 90.0}, {1.0, -1.0}, Radius, 180.0);
  grid.rootPosts.setConstant(180.0);
  grid.rootColumns = 2;
  grid.periodic = true;
  grid.extent = Eigen::AlignedBox2d(Eigen::Vector2d(0, 0), Eigen::Vector2d(360, 180));
  return grid;
}

ColorGrid Pole(bool south) {
  ColorGrid grid;
  grid.placement = PostPlacement::OnPole(south, 10.0, 256.0, Radius);
  grid.rootPosts.setConstant(512.0);
  grid.extent = Eigen::AlignedBox2d(Eigen::Vector2d(0, 0), Eigen::Vector2d(512, 512));
  return grid;
}

// Opacity, less than 0 where it darkens.
std::vector<int> Signed(const ColorLayer& layer, const ColorGrid& grid, const ColorBlock& block) {
  std::vector<std::uint8_t> rgba(std::size_t(4) * block.width * block.height, 77);
  std::vector<int> values(std::size_t(block.width) * block.height, 0);
  if (layer.Read(grid, block, rgba.data())) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::uint8_t* texel = rgba.data() + 4 * i;
      EXPECT_EQ(texel[0], texel[1]);
      EXPECT_EQ(texel[0], texel[2]);
      EXPECT_TRUE(texel[0] == 0 || (texel[0] == 255 && texel[3] > 0));
      values[i] = texel[0] == 255 ? texel[3] : -int(texel[3]);
    }
  } else {
    EXPECT_TRUE(std::all_of(rgba.begin(), rgba.end(), [](int v) { return v == 77; }));
  }
  return values;
}

NoiseOptions Options(double wavelength, int octaves) {
  NoiseOptions options;
  options.wavelength = wavelength;
  options.octaves = octaves;
  options.seed = 9;
  return options;
}

TEST(NoiseLayer, ATexelIsTheNoiseAtItsCentre) {
  const NoiseOptions options = Options(40.0, 3);
  const auto layer = MakeNoiseLayer(options, 0.8);
  EXPECT_EQ(layer->PixelSize(), 2.5);
  const OctaveNoise noise(options);
  const ColorGrid grid = Plane(0.5); // 512 m a side: texels of 2 m at zoom 0, of 0.5 m at zoom 2
  const ColorBlock block{2, 300, 400, 160, 120};
  const std::vector<int> values = Signed(*layer, grid, block);
  int both = 0;
  for (int y = 0; y < block.height; ++y) {
    for (int x = 0; x < block.width; ++x) {
      // The post at the grid's corner stands at (-300, 200), z is less the origin's height.
      const Eigen::Vector3d p(-300.0 + 0.5 * (300 + x + 0.5), 200.0 - 0.5 * (400 + y + 0.5), 41.0);
      const double expected = 255.0 * 0.8 * noise.At(p, 0.5) / 1.75;
      ASSERT_NEAR(values[std::size_t(y) * 160 + x], expected, 0.5 + 1e-6);
      both |= expected > 20.0 ? 1 : expected < -20.0 ? 2 : 0;
    }
  }
  EXPECT_EQ(both, 3);
}

// A coarser zoom shows what it resolves: where all is resolved, the mean of what the finer has.
TEST(NoiseLayer, ZoomsAgree) {
  const auto layer = MakeNoiseLayer(Options(64.0, 2), 1.0);
  const ColorGrid grid = Plane(0.5);
  const std::vector<int> coarse = Signed(*layer, grid, {2, 10, 20, 32, 32}); // 0.5 m
  const std::vector<int> fine = Signed(*layer, grid, {3, 20, 40, 64, 64});
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      double mean = 0.0;
      for (const int j : {0, 1}) {
        for (const int i : {0, 1}) {
          mean += 0.25 * fine[std::size_t(2 * y + j) * 64 + 2 * x + i];
        }
      }
      ASSERT_NEAR(coarse[std::size_t(y) * 32 + x], mean, 1.3); // rounding of five values
    }
  }
  // 64 and 32 m, texels of 32 m and more: nothing.
  ColorGrid wide = Plane(8.0);
  wide.rootPosts.setConstant(8192.0);
  EXPECT_EQ(Signed(*layer, wide, {3, 0, 0, 8, 8}), std::vector<int>(64, 0));
  EXPECT_NE(Signed(*layer, wide, {4, 0, 0, 8, 8}), std::vector<int>(64, 0));
}

TEST(NoiseLayer, ABodyHasNoSeam) {
  const auto layer = MakeNoiseLayer(Options(200.0, 2), 1.0);
  const ColorGrid grid = Body();
  const int zoom = 2; // 1024 texels over 180 degrees, 3 m
  const std::int64_t around = 2048;
  const std::vector<int> here = Signed(*layer, grid, {zoom, -20, 400, 40, 30});
  EXPECT_EQ(Signed(*layer, grid, {zoom, around - 20, 400, 40, 30}), here);
  for (int y = 0; y < 30; ++y) {
    for (int x = 1; x < 40; ++x) { // 255 over a quarter of the shorter wavelength is far more
      ASSERT_LT(std::abs(here[std::size_t(y) * 40 + x] - here[std::size_t(y) * 40 + x - 1]), 25);
    }
  }
}

TEST(NoiseLayer, ChartsShowTheSame) {
  const auto layer = MakeNoiseLayer(Options(200.0, 3), 1.0);
  const ColorGrid body = Body();
  const int zoom = 5; // 8192 texels over 180 degrees
  for (const bool south : {false, true}) {
    const ColorGrid pole = Pole(south);
    int seen = 0;
    for (const double lon : {-179.9, -100.0, 0.3, 45.0, 178.0}) {
      for (const double lat : {59.0, 70.0, 85.0, 89.7}) {
        const double l = lon * M_PI / 180.0, p = (south ? -lat : lat) * M_PI / 180.0;
        const Eigen::Vector3d at = Radius * Eigen::Vector3d(std::cos(p) * std::cos(l),
                                                            std::cos(p) * std::sin(l), std::sin(p));
        const auto value = [&](const ColorGrid& grid) {
          const Eigen::Vector2d texel = grid.TexelToPost(zoom).inverse() *
                                        Eigen::Vector2d(grid.placement.ToPosts(at).head<2>());
          return Signed(*layer, grid,
                        {zoom, std::int64_t(std::floor(texel.x())),
                         std::int64_t(std::floor(texel.y())), 1, 1})[0];
        };
        // Centres of the texels are up to 0.7 m apart, of a shortest wavelength of 50 m.
        EXPECT_NEAR(value(pole), value(body), 8) << lon << " " << lat << " " << south;
        seen |= std::abs(value(body)) > 20;
      }
    }
    EXPECT_TRUE(seen);
  }
}

TEST(NoiseLayer, BadOptionsAreRejected) {
  EXPECT_THROW(MakeNoiseLayer(Options(0.0, 2), 0.5), Error);
  EXPECT_THROW(MakeNoiseLayer(Options(1.0, 2), -0.1), Error);
  EXPECT_THROW(MakeNoiseLayer(Options(1.0, 2), 1.1), Error);
  EXPECT_THROW(MakeNoiseLayer(Options(1.0, 2), std::nan("")), Error);
  EXPECT_EQ(Signed(*MakeNoiseLayer(Options(10.0, 2), 0.0), Plane(0.5), {3, 0, 0, 4, 4}),
            std::vector<int>(16, 0));
}

} // namespace
