// Text of VRML against the measures of its font.
#include "VrmlTestSupport.h"

namespace dspace::testing {
namespace {

TEST(VrmlLetters, TextFollowsItsFontStyle) {
  const TempFolder folder;
  const auto box = [&](const std::string& fields, const std::string& style) {
    const Model model = Read(folder, Head2 + Shape("Text { string [ \"HH\", \"H\" ] " + fields +
                                                   " fontStyle FontStyle { " + style + " } }"));
    EXPECT_TRUE(model.warnings.empty());
    return model.Bounds();
  };
  // DejaVu Sans: an H is 1493 of 2048 units of the font high, 1540 wide with its sides, and its
  // stems begin at 201.
  const double height = 1493.0 / 2048.0, advance = 1540.0 / 2048.0, side = 201.0 / 2048.0;
  Eigen::AlignedBox3d b = box("", "size 2");
  EXPECT_NEAR(b.max().y(), 2 * height, 1e-3); // the first baseline is at 0
  EXPECT_NEAR(b.min().y(), -2.0, 1e-3);       // the second a size below it
  EXPECT_NEAR(b.min().x(), 2 * side, 1e-3);
  EXPECT_NEAR(b.max().x(), 2 * (2 * advance - side), 1e-3);
  EXPECT_EQ(b.sizes().z(), 0.0);
  b = box("", "size 2 spacing 3");
  EXPECT_NEAR(b.min().y(), -6.0, 1e-3);
  b = box("", "size 2 justify \"END\"");
  EXPECT_NEAR(b.max().x(), -2 * side, 1e-3);
  b = box("", "size 2 justify [ \"MIDDLE\", \"MIDDLE\" ]");
  EXPECT_NEAR(b.center().x(), 0.0, 1e-3);
  b = box("", "size 2 justify [ \"BEGIN\", \"BEGIN\" ]");
  EXPECT_NEAR(b.max().y(), 2 * (height - 1), 1e-3);
  b = box("", "size 2 justify [ \"BEGIN\", \"END\" ]");
  EXPECT_NEAR(b.min().y(), 0.0, 1e-3);
  b = box("length [ 10 ]", "size 2"); // the first line, its sides stretched too
  EXPECT_NEAR(b.max().x(), 10 * (1 - side / (2 * advance)), 1e-3);
  b = box("maxExtent 1", "size 2");
  EXPECT_NEAR(b.max().x(), 1 - side / (2 * advance), 1e-3);
  // Of VRML 1.0.
  const Model ascii =
      Read(folder, Head1 + "Separator { FontStyle { size 2 } AsciiText { string [ \"HH\", "
                           "\"H\" ] justification RIGHT spacing 2 } }");
  EXPECT_NEAR(ascii.Bounds().max().x(), -2 * side, 1e-3);
  EXPECT_NEAR(ascii.Bounds().min().y(), -4.0, 1e-3);
  EXPECT_NEAR(Read(folder, Head1 + "AsciiText { string \"H\" }").Bounds().max().y(), 10 * height,
              1e-2);
}

} // namespace
} // namespace dspace::testing
