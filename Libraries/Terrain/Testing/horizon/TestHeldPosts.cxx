// Posts in memory, and bounds of their heights.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <dspace/horizon/HeldPosts.h>

#include "FormulaPosts.h"

namespace dspace::testing {
namespace {

// Bounds hold all heights of a block, and none beyond a block three times as wide about it.
TEST(HeldPosts, SpansBoundTheHeightsOfBlocks) {
  std::mt19937 random(11);
  for (const bool periodic : {false, true}) {
    const int columns = 150;
    const int rows = 97;
    ElevationPyramid pyramid(
        std::make_shared<FormulaPosts>(columns, rows, periodic, [](double c, double r) {
          return 40.0 * std::sin(0.31 * c) * std::cos(0.23 * r) + 0.2 * std::sin(7.0 * c + 3.0 * r);
        }));
    const auto held = HeldPosts::Read(pyramid, 1, 1, {});
    ASSERT_TRUE(held);
    const PostBlock& place = held->Place();
    const auto bounds = [&](std::int64_t left, std::int64_t top, int width, int height) {
      HeightSpan span{std::numeric_limits<float>::infinity(),
                      -std::numeric_limits<float>::infinity()};
      for (std::int64_t r = std::max<std::int64_t>(top, place.row);
           r < std::min<std::int64_t>(top + height, place.row + place.height); ++r) {
        for (std::int64_t c = std::max<std::int64_t>(left, place.column);
             c < std::min<std::int64_t>(left + width, place.column + place.width); ++c) {
          const float h = held->Heights()[held->At(c, r)];
          span.least = h < span.least ? h : span.least;
          span.greatest = h > span.greatest ? h : span.greatest;
        }
      }
      return span;
    };
    for (int k = 0; k < 400; ++k) {
      const int width = 1 + int(random() % 60);
      const int height = 1 + int(random() % 60);
      const std::int64_t left = std::int64_t(random() % columns) - 10;
      const std::int64_t top = std::int64_t(random() % rows) - 10;
      const HeightSpan span = held->SpanOf({0, left, top, width, height});
      const HeightSpan inner = bounds(left, top, width, height);
      const int about = std::max({width, height, 8});
      const HeightSpan outer =
          bounds(left - about, top - about, width + 2 * about, height + 2 * about);
      EXPECT_LE(span.least, inner.least);
      EXPECT_GE(span.greatest, inner.greatest);
      EXPECT_GE(span.least, outer.least);
      EXPECT_LE(span.greatest, outer.greatest);
    }
    // Where no post is, nothing is bounded.
    const HeightSpan none = held->SpanOf({0, 10, place.row, 5, 5});
    EXPECT_GT(none.least, none.greatest);
  }
}

} // namespace
} // namespace dspace::testing
