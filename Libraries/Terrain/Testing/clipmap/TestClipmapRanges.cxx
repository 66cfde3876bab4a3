// The heights of blocks hold all of their ground, and are theirs alone.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "FormulaPosts.h"

#include <dspace/clipmap/ClipmapRanges.h>
#include <dspace/clipmap/arithmetic/ClipmapIndices.h>

namespace dspace::testing {
namespace {

constexpr int RangeCells = 60;

double Slope(double c, double r) {
  return 0.5 * c - 0.25 * r + 3.0 * std::sin(0.4 * c) * std::cos(0.3 * r);
}

} // namespace

TEST(ClipmapRanges, HoldTheGroundOfEachBlockWhileTheViewMoves) {
  const auto posts = std::make_shared<FormulaPosts>(701, 701, false, Slope, RangeCells);
  ClipmapLevels levels(std::make_shared<ElevationPyramid>(posts), RangeCells);
  ClipmapRanges ranges;
  const auto upload = [&](int level, const ClipmapUpdate&, const ClipmapTexel*) {
    ranges.Changed(level);
  };
  const int across = ClipmapIndices::BlocksOf(RangeCells);
  // The last two windows reach beyond the lattice.
  for (const Eigen::Vector2d& place : {Eigen::Vector2d(350, 350), Eigen::Vector2d(362, 341),
                                       Eigen::Vector2d(3, 20), Eigen::Vector2d(698, 690)}) {
    ClipmapLevels::View view;
    view.place = place;
    view.height = 0.5;
    view.cellSize = 1.0;
    view.wait = 60.0;
    const ClipmapLevels::State state = levels.Update(view, upload);
    for (int level = state.finest; level < levels.Count(); ++level) {
      const ClipmapWindow& window = levels.Window(level);
      const std::int64_t step = std::int64_t(1) << level;
      for (int row = 0; row < across; ++row) {
        for (int column = 0; column < across; ++column) {
          const ClipmapRanges::Range range = ranges.Of(levels, level, column, row);
          double low = std::numeric_limits<double>::infinity();
          double high = -low;
          for (int j = 0; j <= ClipmapIndices::BlockCells; ++j) {
            for (int i = 0; i <= ClipmapIndices::BlockCells; ++i) {
              const std::int64_t c = window.column + column * ClipmapIndices::BlockCells + i;
              const std::int64_t r = window.row + row * ClipmapIndices::BlockCells + j;
              if (c < 0 || r < 0 || c >= levels.Lattice().ColumnsAt(level) ||
                  r >= levels.Lattice().RowsAt(level) || c > window.column + RangeCells ||
                  r > window.row + RangeCells) {
                continue;
              }
              const double height = levels.Texel(level, c, r).height;
              low = std::min(low, height);
              high = std::max(high, height);
            }
          }
          EXPECT_LE(range[0], low) << level << " " << column << " " << row;
          EXPECT_GE(range[1], high) << level << " " << column << " " << row;
          // Two posts of the coarser level more, on a slope of 1.8 m a post at the most.
          EXPECT_EQ(range[0] > range[1], low > high);
          if (low < high) {
            EXPECT_LT(range[1] - range[0], high - low + 8.0 * 1.8 * double(step)) << level;
          }
        }
      }
    }
  }
}

} // namespace dspace::testing
