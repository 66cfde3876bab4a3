// Two discs against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include <dspace/DiscLeft.h>

namespace dspace {
namespace {

TEST(DiscLeft, TwoDiscsLeaveWhatClosedFormsSay) {
  EXPECT_EQ(DiscLeft(1.0, 1.0, 2.0), 1.0);
  EXPECT_EQ(DiscLeft(1.0, 2.0, 0.5), 0.0);
  EXPECT_NEAR(DiscLeft(1.0, 0.5, 0.2), 0.75, 1e-15);
  // Equal circles at the distance of their radius: the lens 2 pi / 3 - sqrt(3) / 2 of pi.
  EXPECT_NEAR(DiscLeft(1.0, 1.0, 1.0), 1.0 - (2.0 * M_PI / 3.0 - std::sqrt(3.0) / 2.0) / M_PI,
              1e-14);
  // A very large one is a straight edge: through the centre it leaves half, less its bulge.
  EXPECT_NEAR(DiscLeft(1.0, 1e6, 1e6), 0.5, 1e-6);
  for (double d = 999.0; d <= 1001.0; d += 0.01) { // steady in the least differences
    EXPECT_GE(DiscLeft(1.0, 1e3, d + 0.005), DiscLeft(1.0, 1e3, d)) << d;
  }
}

} // namespace
} // namespace dspace
