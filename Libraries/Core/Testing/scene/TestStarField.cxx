// Stars of a scene: their order, their colours, and what is rejected.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include <dspace/Error.h>
#include <dspace/scene/stars/StarColor.h>
#include <dspace/scene/stars/StarField.h>

using dspace::Star;
using dspace::StarColor;
using dspace::StarField;
using dspace::StarLook;

namespace {

Star Of(float magnitude) {
  Star star;
  star.magnitude = magnitude;
  return star;
}

std::string MessageOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const dspace::Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

// Linear light of a chromaticity, of any luminance.
Eigen::Vector3d LightOf(double x, double y) {
  Eigen::Matrix3d linear;
  linear << 3.2406, -1.5372, -0.4986, -0.9689, 1.8758, 0.0415, 0.0557, -0.2040, 1.0570;
  return linear * Eigen::Vector3d(x / y, 1.0, (1.0 - x - y) / y);
}

} // namespace

TEST(StarField, TheBrightestComeFirst) {
  const StarField field("object 'stars'", {Of(5.0f), Of(-1.5f), Of(2.0f), Of(2.0f)});
  ASSERT_EQ(field.Stars().size(), 4u);
  EXPECT_EQ(field.Stars().front().magnitude, -1.5f);
  EXPECT_EQ(field.Stars().back().magnitude, 5.0f);
}

TEST(StarField, RejectsWhatIsNoStar) {
  Star longer = Of(1.0f);
  longer.direction = {1.0f, 0.1f, 0.0f};
  EXPECT_NE(MessageOf([&] {
              StarField("object 'sky'", {Of(1.0f), longer});
            }).find("object 'sky', star 1"),
            std::string::npos);
  EXPECT_NE(MessageOf([&] { StarField("sky", {Of(std::nanf(""))}); }).find("-30 to 40"),
            std::string::npos);
  EXPECT_NE(MessageOf([&] { StarField("sky", {}); }).find("1 or more"), std::string::npos);
  StarField field("sky", {Of(1.0f)});
  const std::uint64_t before = field.Revision();
  StarLook look;
  look.spread = 0.0;
  EXPECT_NE(MessageOf([&] { field.SetLook("sky", look); }).find("0.2 to 20"), std::string::npos);
  look = {};
  look.gain = -1.0;
  EXPECT_NE(MessageOf([&] { field.SetLook("sky", look); }).find("0 to 1e12"), std::string::npos);
  EXPECT_EQ(field.Revision(), before);
  EXPECT_EQ(field.Look().gain, 1.0);
}

// Ballesteros 2012, table 1: Vega, the Sun and Betelgeuse among others.
TEST(StarColor, TemperaturesAreThoseOfThePaper) {
  EXPECT_NEAR(dspace::StarTemperature(0.0), 10125.0, 2.0);
  EXPECT_NEAR(dspace::StarTemperature(0.653), 5767.0, 10.0);
  EXPECT_NEAR(dspace::StarTemperature(1.85), 3341.0, 60.0);
}

TEST(StarColor, TheSunIsWhiteAndOthersAreOnTheLocusOfBlackBodies) {
  for (const float channel : StarColor(0.653)) {
    EXPECT_NEAR(channel, 1.0f, 1e-5f);
  }
  for (const float channel : StarColor(std::numeric_limits<double>::quiet_NaN())) {
    EXPECT_EQ(channel, 1.0f);
  }
  // Chromaticities of black bodies of 10,000 K, 5,770 K and 4,000 K (G. Wyszecki, W. Stiles,
  // "Color Science", Planckian locus).
  const Eigen::Vector3d sun = LightOf(0.3265, 0.3358);
  struct {
    double index;
    double x;
    double y;
  } const others[] = {{0.0100, 0.2807, 0.2884}, {1.3950, 0.3805, 0.3768}};
  for (const auto& other : others) {
    Eigen::Vector3d expected = LightOf(other.x, other.y).cwiseQuotient(sun);
    expected /= Eigen::Vector3d(0.2126, 0.7152, 0.0722).dot(expected);
    const auto color = StarColor(other.index);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(color[std::size_t(i)], expected[i], 0.02 * expected[i])
          << other.index << " " << i;
    }
  }
}
