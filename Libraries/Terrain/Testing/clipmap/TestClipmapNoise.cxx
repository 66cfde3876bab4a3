// Noise on the posts that a clipmap draws, without OpenGL.
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>

#include "FormulaPosts.h"

namespace dspace::testing {
namespace {

constexpr int Cells = 28;
constexpr double Post = 0.5; // [m]

double Swell(double c, double r) {
  return 5.0 * std::sin(0.02 * c) * std::cos(0.03 * r);
}

PostPlacement Plane() {
  Eigen::Affine2d map = Eigen::Affine2d::Identity();
  map.linear() << Post, 0.0, 0.0, -Post;
  map.translation() << -700.0, 700.0;
  return PostPlacement::OnPlane(map, 12.5);
}

// 4096 columns around a body of 1 km: 1.5 m apart.
constexpr double Radius = 1000.0;
constexpr double Step = 360.0 / 4096.0; // [deg]
PostPlacement Body() {
  return PostPlacement::OnSphere({-180.0, 60.0}, {Step, -Step}, Radius, 2048.0);
}

ClipmapStyle::Noise Noise(double wavelength, int octaves, double amplitude) {
  ClipmapStyle::Noise noise;
  noise.options.wavelength = wavelength;
  noise.options.octaves = octaves;
  noise.options.seed = 3;
  noise.amplitude = amplitude;
  return noise;
}

const ClipmapLevels::Upload None = [](int, const ClipmapUpdate&, const ClipmapTexel*) {};

ClipmapLevels::View Over(const Eigen::Vector2d& place, double cellSize) {
  ClipmapLevels::View view;
  view.place = place;
  view.height = 2.0;
  view.cellSize = cellSize;
  view.wait = 60.0;
  return view;
}

// What a texture would hold.
struct Textures {
  ClipmapGeometry geometry{Cells};
  std::vector<std::vector<ClipmapTexel>> texels;
  std::size_t uploaded = 0;
  explicit Textures(int levels)
      : texels(std::size_t(levels),
               std::vector<ClipmapTexel>(std::size_t(geometry.Texels()) * geometry.Texels())) {}
  ClipmapLevels::Upload Upload() {
    return [this](int level, const ClipmapUpdate& u, const ClipmapTexel* from) {
      const int side = this->geometry.Texels();
      for (int j = 0; j < u.height; ++j) {
        std::copy_n(from + std::size_t(j) * u.width, u.width,
                    this->texels[std::size_t(level)].begin() + std::ptrdiff_t(u.y + j) * side +
                        u.x);
      }
      this->uploaded += std::size_t(u.width) * u.height;
    };
  }
  // Byte for byte, with border.
  void ExpectAs(const ClipmapLevels& other, int finest) {
    for (int level = finest; level < other.Count(); ++level) {
      const ClipmapWindow& window = other.Window(level);
      for (std::int64_t r = window.row - 1; r <= window.row + Cells + 1; ++r) {
        for (std::int64_t c = window.column - 1; c <= window.column + Cells + 1; ++c) {
          const std::size_t at = std::size_t(this->geometry.Texel(r)) * this->geometry.Texels() +
                                 this->geometry.Texel(c);
          ASSERT_EQ(std::memcmp(&this->texels[std::size_t(level)][at], &other.Texel(level, c, r),
                                sizeof(ClipmapTexel)),
                    0)
              << "level " << level << ", post " << c << ", " << r;
        }
      }
    }
  }
};

TEST(ClipmapNoise, APostHasTheNoiseOfItsPlaceAndSlopesFollow) {
  const auto posts = std::make_shared<FormulaPosts>(2801, 2801, false, Swell, Cells);
  const ClipmapStyle::Noise noise = Noise(8.0, 3, 0.3); // 8, 4, 2 m; posts of 0.5, 1, 2, 4 m
  ClipmapLevels levels(std::make_shared<ElevationPyramid>(posts), Cells);
  levels.SetNoise(noise, Plane());
  const ClipmapLevels::State state = levels.Update(Over({1400.3, 1399.8}, Post), None);
  ASSERT_EQ(state.finest, 0);
  const OctaveNoise octaves(noise.options);
  for (int level = 0; level < 4; ++level) {
    const ClipmapWindow& window = levels.Window(level);
    const double spacing = std::ldexp(Post, level);
    double most = 0.0;
    for (std::int64_t r = window.row; r <= window.row + Cells; ++r) {
      for (std::int64_t c = window.column; c <= window.column + Cells; ++c) {
        const auto height = [&](std::int64_t column, std::int64_t row) {
          const double x = std::ldexp(double(column), level), y = std::ldexp(double(row), level);
          // z is less the origin's height.
          const Eigen::Vector3d p(-700.0 + Post * x, 700.0 - Post * y, -12.5);
          most = std::max(most, std::abs(octaves.At(p, spacing)));
          return Swell(x, y) + 0.3 * octaves.At(p, spacing);
        };
        const ClipmapTexel& texel = levels.Texel(level, c, r);
        ASSERT_NEAR(texel.height, height(c, r), 1e-6);
        const double posts2 = std::ldexp(2.0, level); // level-0 posts between the neighbours
        ASSERT_NEAR(texel.slopeColumn, (height(c + 1, r) - height(c - 1, r)) / posts2, 3e-6);
        ASSERT_NEAR(texel.slopeRow, (height(c, r + 1) - height(c, r - 1)) / posts2, 3e-6);
      }
    }
    if (level < 3) {
      EXPECT_GT(most, 0.1) << level;
      EXPECT_LE(most, 1.75);
    } else {
      EXPECT_EQ(most, 0.0); // two posts a wavelength of the longest
    }
  }
}

// Flying about, on a plane and around a body, and turning noise on, over and off again: what was
// uploaded is what a first upload gives.
TEST(ClipmapNoise, TexturesAreThoseOfAFullUpload) {
  for (const bool body : {false, true}) {
    const auto posts = body ? std::make_shared<FormulaPosts>(4096, 1367, true, Swell, Cells)
                            : std::make_shared<FormulaPosts>(2801, 2801, false, Swell, Cells);
    const PostPlacement placement = body ? Body() : Plane();
    const double cell = body ? Radius * Step * M_PI / 180.0 : Post;
    const auto pyramid = std::make_shared<ElevationPyramid>(posts);
    ClipmapLevels levels(pyramid, Cells);
    Textures textures(levels.Count());
    std::mt19937 random(4);
    Eigen::Vector2d place(body ? 4090.0 : 1400.0, 700.0);
    std::optional<ClipmapStyle::Noise> noise;
    for (int move = 0; move < 60; ++move) {
      const double reach = move % 10 == 9 ? 300.0 : 5.0;
      std::uniform_real_distribution<double> step(-reach, reach);
      place += Eigen::Vector2d(step(random), step(random));
      place.y() = std::clamp(place.y(), 0.0, 1366.0);
      if (move % 15 == 5) {
        noise = Noise(40.0 * cell, 5, 0.1 + 0.01 * move);
      } else if (move % 15 == 10) {
        noise.reset();
      }
      levels.SetNoise(noise, placement);
      textures.uploaded = 0;
      const ClipmapLevels::State state = levels.Update(Over(place, cell), textures.Upload());
      if (move % 5 == 0 && move % 15 != 0) { // a change: all of it
        EXPECT_EQ(textures.uploaded, std::size_t(levels.Count() - state.finest) * 31u * 31u);
      }
      ClipmapLevels fresh(pyramid, Cells);
      fresh.SetNoise(noise, placement);
      const ClipmapLevels::View view = Over(state.place, cell);
      ASSERT_EQ(fresh.Update(view, None).finest, state.finest);
      textures.ExpectAs(fresh, state.finest);
      if (::testing::Test::HasFatalFailure()) {
        return;
      }
    }
  }
}

// The same post in two turns around a body.
TEST(ClipmapNoise, TurnsAgreeAndHolesStay) {
  const auto posts = std::make_shared<FormulaPosts>(
      4096, 1367, true,
      [](double c, double r) { return c > 5.0 && c < 9.0 && r > 690.0 ? std::nan("") : 0.0; },
      Cells);
  ClipmapLevels levels(std::make_shared<ElevationPyramid>(posts), Cells);
  levels.SetNoise(Noise(30.0, 2, 1.0), Body());
  levels.Update(Over({4095.0, 700.0}, 1.5), None); // up to 14 posts to the east: 4109
  ClipmapLevels east(std::make_shared<ElevationPyramid>(posts), Cells);
  east.SetNoise(Noise(30.0, 2, 1.0), Body());
  east.Update(Over({3.0, 700.0}, 1.5), None); // the same posts, counted from 0
  int holes = 0;
  for (std::int64_t r = 690; r < 710; ++r) {
    for (std::int64_t c = 0; c < 10; ++c) {
      ASSERT_EQ(
          std::memcmp(&levels.Texel(0, 4096 + c, r), &east.Texel(0, c, r), sizeof(ClipmapTexel)),
          0);
      holes += east.Texel(0, c, r).hole == 1.0f;
    }
  }
  EXPECT_EQ(holes, 3 * 19);
}

TEST(ClipmapNoise, ABadStyleIsRejected) {
  const auto rejected = [](double wavelength, int octaves, double amplitude, const char* told) {
    ClipmapStyle style;
    style.noise = Noise(wavelength, octaves, amplitude);
    try {
      style.Check("terrain 'x'");
      ADD_FAILURE() << told;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(told), std::string::npos) << error.what();
      EXPECT_EQ(error.GetObjectName(), "terrain 'x'");
    }
  };
  rejected(0.0, 3, 0.1, "wavelength");
  rejected(1.0, 0, 0.1, "octaves");
  rejected(1.0, 3, 0.0, "amplitude");
  rejected(1.0, 3, 2e6, "amplitude");
  rejected(1.0, 3, std::nan(""), "amplitude");
  ClipmapStyle style;
  style.noise = Noise(1.0, 3, 0.1);
  style.Check("terrain 'x'");
  EXPECT_TRUE(style.Empty()); // nothing is laid over its colour
}

} // namespace
} // namespace dspace::testing
