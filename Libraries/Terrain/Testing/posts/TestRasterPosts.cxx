// Posts of a raster: level 0 against GDAL's values, finer ones against HeightGrid's triangles,
// coarser ones against sums by hand.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/posts/RasterPosts.h>
#include <dspace/surface/GridTerrain.h>

#include "Grids.h"
#include "RasterFile.h"

namespace {

using namespace dspace;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

double Bumps(int c, int r) {
  return 100.0 * std::sin(0.3 * c) * std::cos(0.21 * r) + std::fmod(c * 7.3 + r * 3.1, 5.0);
}

std::shared_ptr<const ElevationSource> Write(const TemporaryFolder& folder, int width, int height,
                                             const std::function<double(int, int)>& value) {
  RasterFile file;
  file.width = width;
  file.height = height;
  file.noData = -9999.0;
  file.geotransform = std::array<double, 6>{0, 1, 0, 0, 0, -1};
  file.value = [&](int c, int r, int) { return value(c, r); };
  return std::make_shared<ElevationSource>(file.Write(folder / "posts.tif"));
}

std::vector<float> ReadAll(const PostSource& posts, int level) {
  const PostLattice& lattice = posts.GetLattice();
  const PostBlock block{level, 0, 0, int(lattice.ColumnsAt(level)), int(lattice.RowsAt(level))};
  std::vector<float> heights(std::size_t(block.width) * block.height);
  posts.Read(block, heights.data());
  return heights;
}

TEST(RasterPosts, Level0IsTheRasterAndBeyondItIsNothing) {
  const TemporaryFolder folder;
  const auto source = Write(folder, 37, 23, Bumps);
  const RasterPosts posts(source);
  const PostBlock block{0, -5, -4, 50, 40};
  std::vector<float> heights(50 * 40);
  posts.Read(block, heights.data());
  for (int j = 0; j < 40; ++j) {
    for (int i = 0; i < 50; ++i) {
      const int c = i - 5;
      const int r = j - 4;
      const float h = heights[j * 50 + i];
      if (c < 0 || r < 0 || c >= 37 || r >= 23) {
        EXPECT_TRUE(std::isnan(h)) << c << ", " << r;
      } else {
        EXPECT_EQ(h, float(Bumps(c, r))) << c << ", " << r;
      }
    }
  }
}

// HeightGrid evaluates its triangles by other code, in double precision.
TEST(RasterPosts, SubdividedPostsLieOnTheTriangles) {
  const TemporaryFolder folder;
  const auto holes = [](int c, int r) { return (c == 9 && r == 6) ? -9999.0 : Bumps(c, r); };
  const auto source = Write(folder, 19, 14, holes);
  RasterPostsOptions options;
  options.subdivisions = 3;
  options.levels = 4;
  const RasterPosts posts(source, options);
  ASSERT_EQ(posts.GetLattice().columns, 18 * 8 + 1);
  ASSERT_EQ(posts.GetLattice().rows, 13 * 8 + 1);
  const auto grid = GridTerrain::Load(source->Info().path);
  for (int level = 0; level <= 3; ++level) {
    const std::vector<float> heights = ReadAll(posts, level);
    const int columns = int(posts.GetLattice().ColumnsAt(level));
    int compared = 0;
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const double c = double(i % columns) * (1 << level) / 8.0;
      const double r = double(i / columns) * (1 << level) / 8.0;
      const HeightGrid::Facet facet = grid->Grid().FacetAt({c, r});
      if (facet.valid && !std::isnan(heights[i])) {
        EXPECT_NEAR(heights[i], facet.height, 2e-5) << c << ", " << r;
        ++compared;
      } else {
        // On a hole's very edge either answer is right.
        const bool edge = std::abs(c - 9.0) <= 1.0 && std::abs(r - 6.0) <= 1.0;
        EXPECT_TRUE(edge) << c << ", " << r;
      }
    }
    EXPECT_GT(compared, int(heights.size()) * 8 / 10);
  }
}

// Each pixel's share of the box about a post, summed one by one.
TEST(RasterPosts, CoarserPostsAreMeansOverTheirBoxes) {
  const TemporaryFolder folder;
  const int width = 61;
  const int height = 45;
  const auto holed = [](int c, int r) {
    return (c > 20 && c < 35 && r > 10 && r < 20) ? -9999.0 : Bumps(c, r);
  };
  const auto source = Write(folder, width, height, holed);
  RasterPostsOptions options;
  options.levels = 4;
  const RasterPosts posts(source, options);
  for (int level = 1; level <= 3; ++level) {
    const std::vector<float> heights = ReadAll(posts, level);
    const int columns = int(posts.GetLattice().ColumnsAt(level));
    const double half = 0.5 * (1 << level);
    int holes = 0;
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const double x = std::min<double>((i % columns) << level, width - 1) + 0.5;
      const double y = std::min<double>((i / columns) << level, height - 1) + 0.5;
      double sum = 0.0;
      double weight = 0.0;
      double area = 0.0;
      for (int r = 0; r < height; ++r) {
        for (int c = 0; c < width; ++c) {
          const double w = std::min(x + half, c + 1.0) - std::max(x - half, double(c));
          const double h = std::min(y + half, r + 1.0) - std::max(y - half, double(r));
          if (w > 0.0 && h > 0.0) {
            area += w * h;
            if (holed(c, r) > -9999.0) {
              weight += w * h;
              sum += w * h * holed(c, r);
            }
          }
        }
      }
      if (weight < 0.5 * area) {
        EXPECT_TRUE(std::isnan(heights[i])) << level << ": " << x << ", " << y;
        ++holes;
      } else {
        EXPECT_NEAR(heights[i], sum / weight, 1e-4) << level << ": " << x << ", " << y;
      }
    }
    EXPECT_GT(holes, 0) << level;
  }
}

// A plane's mean over a box is its value in the box's middle. Where only every n-th pixel is read,
// the reading's own offset of half a pixel remains.
TEST(RasterPosts, FarLevelsOfAPlaneStayOnIt) {
  const TemporaryFolder folder;
  const auto plane = [](int c, int r) { return 0.5 * c - 0.25 * r + 3.0; };
  const auto source = Write(folder, 1025, 513, plane);
  RasterPostsOptions options;
  options.levels = 7;
  const RasterPosts posts(source, options);
  for (int level = 1; level < 7; ++level) {
    const PostLattice& lattice = posts.GetLattice();
    const std::vector<float> heights = ReadAll(posts, level);
    const auto columns = lattice.ColumnsAt(level);
    for (std::int64_t r = 1; r + 1 < lattice.RowsAt(level); ++r) {
      for (std::int64_t c = 1; c + 1 < columns; ++c) {
        const double expected =
            plane(int(lattice.ColumnPlace(level, c)), int(lattice.RowPlace(level, r)));
        EXPECT_NEAR(heights[r * columns + c], expected, level <= 3 ? 1e-3 : 0.5 * 0.75 + 1e-3);
      }
    }
  }
}

TEST(RasterPosts, OverviewsAreReadWhereTheFileHasThem) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 512;
  file.height = 512;
  file.geotransform = std::array<double, 6>{0, 1, 0, 0, 0, -1};
  file.value = [](int, int, int) { return 1.0; };
  const std::string path = file.Write(folder / "overviews.tif");
  {
    auto* dataset = GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE);
    ASSERT_NE(dataset, nullptr);
    int factor = 4;
    ASSERT_EQ(dataset->BuildOverviews("NEAREST", 1, &factor, 0, nullptr, nullptr, nullptr),
              CE_None);
    // Values that the pixels themselves do not have.
    GDALRasterBand* overview = dataset->GetRasterBand(1)->GetOverview(0);
    ASSERT_EQ(overview->GetXSize(), 128);
    overview->Fill(77.0);
    GDALClose(dataset);
  }
  RasterPostsOptions options;
  options.levels = 6;
  const RasterPosts posts(std::make_shared<ElevationSource>(path), options);
  for (int level = 0; level < 6; ++level) {
    const float expected = level <= 4 ? 1.0f : 77.0f; // from level 5 on, four pixels are one
    for (const float h : ReadAll(posts, level)) {
      ASSERT_EQ(h, expected) << level;
    }
  }
}

TEST(RasterPosts, APeriodicRasterGoesOnAcrossItsEdge) {
  const TemporaryFolder folder;
  const auto source = Write(folder, 64, 33, Bumps);
  RasterPostsOptions options;
  options.periodic = true;
  options.levels = 4;
  const RasterPosts posts(source, options);
  ASSERT_EQ(posts.GetLattice().columns, 64);
  for (int level = 0; level < 4; ++level) {
    const int columns = int(posts.GetLattice().ColumnsAt(level));
    const int rows = int(posts.GetLattice().RowsAt(level));
    ASSERT_EQ(columns, 64 >> level);
    const std::vector<float> once = ReadAll(posts, level);
    std::vector<float> around(std::size_t(3 * columns) * rows);
    posts.Read({level, -columns, 0, 3 * columns, rows}, around.data());
    for (std::size_t i = 0; i < around.size(); ++i) {
      const std::size_t r = i / (3 * columns);
      ASSERT_EQ(around[i], once[r * columns + i % columns]) << level;
    }
  }
  // The mean about column 0 takes in the last column, half of it at level 1.
  const std::vector<float> level1 = ReadAll(posts, 1);
  const int r = 10;
  double sum = 0.0;
  for (const auto& [row, rowWeight] : {std::pair(2 * r - 1, 0.5), {2 * r, 1.0}, {2 * r + 1, 0.5}}) {
    sum += rowWeight * (0.5 * Bumps(63, row) + Bumps(0, row) + 0.5 * Bumps(1, row));
  }
  EXPECT_NEAR(level1[r * 32], sum / 4.0, 1e-4);
}

// A whole body: rows of pixels at half pixels from the poles; levels 0 to 2 divide pixels by 8
// to 2.
TEST(RasterPosts, PolesCloseTheLattice) {
  const TemporaryFolder folder;
  const int width = 32;
  const int height = 16;
  const auto source = Write(folder, width, height, Bumps);
  RasterPostsOptions options;
  options.periodic = true;
  options.poles = true;
  options.subdivisions = 3;
  options.levels = 7;
  const RasterPosts posts(source, options);
  ASSERT_EQ(posts.GetLattice().rows, height * 8 + 1);
  ASSERT_EQ(posts.GetLattice().columns, width * 8);
  const auto rowMean = [&](int from, int to) {
    double sum = 0.0;
    for (int r = from; r < to; ++r) {
      for (int c = 0; c < width; ++c) {
        sum += Bumps(c, r);
      }
    }
    return sum / ((to - from) * width);
  };
  // By pixel coordinates: along rows first within the triangle, or from the pole.
  const auto expected = [&](double x, double y) {
    const auto pixel = [&](int c, int r) { return Bumps(c % width, r); };
    const int c = int(x);
    const double u = x - c;
    if (y < 0.0 || y > height - 1.0) {
      const int row = y < 0.0 ? 0 : height - 1;
      const double pole = rowMean(row, row + 1);
      const double along = (1.0 - u) * pixel(c, row) + u * pixel(c + 1, row);
      const double away = y < 0.0 ? (y + 0.5) / 0.5 : (height - 0.5 - y) / 0.5;
      return (1.0 - away) * pole + away * along;
    }
    const int r = std::min(int(y), height - 2);
    const double v = y - r;
    const double corner = u > v ? pixel(c + 1, r) : pixel(c, r + 1);
    return (1.0 - std::max(u, v)) * pixel(c, r) + std::min(u, v) * pixel(c + 1, r + 1) +
           std::abs(u - v) * corner;
  };
  for (int level = 0; level < 3; ++level) {
    const std::vector<float> heights = ReadAll(posts, level);
    const auto columns = int(posts.GetLattice().ColumnsAt(level));
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const double x = double(i % columns) * (1 << level) / 8.0;
      const double y = double(i / columns) * (1 << level) / 8.0 - 0.5;
      ASSERT_NEAR(heights[i], expected(x, y), 2e-5) << level << ": " << x << ", " << y;
    }
  }
  // Coarser ones are means over boxes that end at the raster; those of a pole are of a whole cap.
  for (int level = 3; level < 7; ++level) {
    const std::vector<float> heights = ReadAll(posts, level);
    const auto columns = int(posts.GetLattice().ColumnsAt(level));
    const auto rows = int(posts.GetLattice().RowsAt(level));
    const double box = (1 << level) / 8.0;
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const double y = std::min(j * box, double(height));
        double sum = 0.0;
        double area = 0.0;
        for (int r = 0; r < height; ++r) {
          for (int c = -width; c < 2 * width; ++c) {
            const double x = i * box + 0.5;
            const double w = std::min(x + box / 2, c + 1.0) - std::max(x - box / 2, double(c));
            const double h = std::min(y + box / 2, r + 1.0) - std::max(y - box / 2, double(r));
            if (w > 0.0 && h > 0.0) {
              sum += w * h * Bumps((c + width) % width, r);
              area += w * h;
            }
          }
        }
        const int reach = std::max(1, int(box / 2));
        const double mean = j == 0          ? rowMean(0, reach)
                            : j == rows - 1 ? rowMean(height - reach, height)
                                            : sum / area;
        ASSERT_NEAR(heights[std::size_t(j) * columns + i], mean, 1e-4)
            << level << ": " << i << ", " << j;
      }
    }
  }
  options.subdivisions = 0;
  EXPECT_THROW(RasterPosts(source, options), Error);
  options.subdivisions = 1;
  options.periodic = false;
  EXPECT_THROW(RasterPosts(source, options), Error);
}

TEST(RasterPosts, WhatCannotBeHalvedIsRejected) {
  const TemporaryFolder folder;
  const auto source = Write(folder, 36, 20, Bumps);
  RasterPostsOptions options;
  options.periodic = true;
  options.levels = 4; // 36 = 4 x 9
  EXPECT_THROW(RasterPosts(source, options), Error);
  options.levels = 3;
  EXPECT_EQ(RasterPosts(source, options).GetLattice().ColumnsAt(2), 9);
  options.subdivisions = -1;
  EXPECT_THROW(RasterPosts(source, options), Error);
}

} // namespace
