// An image is shown whole, as large as it may be, in the middle.
#include <gtest/gtest.h>

#include <dspace/camera/FittedImage.h>

using namespace dspace;

namespace {

void Expect(const FittedImage& fitted, int x, int y, int width, int height) {
  EXPECT_EQ(fitted.x, x);
  EXPECT_EQ(fitted.y, y);
  EXPECT_EQ(fitted.width, width);
  EXPECT_EQ(fitted.height, height);
}

} // namespace

TEST(FittedImage, FillsTheShorterSide) {
  Expect(FitImage(400, 300, 400, 300), 0, 0, 400, 300);
  Expect(FitImage(400, 300, 1000, 300), 300, 0, 400, 300); // bars beside it
  Expect(FitImage(400, 300, 800, 1000), 0, 200, 800, 600); // bars above and below
  Expect(FitImage(1024, 1024, 640, 361), 139, 0, 361, 361);
  Expect(FitImage(4096, 1, 10, 10), 0, 4, 10, 1); // never less than a pixel
}
