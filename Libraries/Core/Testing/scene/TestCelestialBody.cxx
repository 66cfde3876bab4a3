// Bodies and their table.
#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/scene/GraphicsObject.h>
#include <dspace/scene/bodies/BodyTable.h>

namespace dspace {
namespace {

// J. Lambert's sphere reflects 2/3 of its normal albedo at full phase, a lunar one all of it.
TEST(CelestialBody, TheTableHasPublishedNumbers) {
  EXPECT_EQ(FindBody("o", "Moon").shape.radii, Eigen::Vector3d::Constant(1737.4e3));
  EXPECT_NEAR(FindBody("o", "EARTH").shape.radii.z(), 6356752.314, 1e-3); // WGS 84
  EXPECT_EQ(FindBody("o", "saturn").shape.radii, Eigen::Vector3d(60268e3, 60268e3, 54364e3));
  EXPECT_EQ(FindBody("o", "sun").shape.radii.x(), 695700e3); // IAU 2015 resolution B3
  EXPECT_TRUE(FindBody("o", "sun").shape.sun);
  EXPECT_NEAR(NormalAlbedo(0.3, Reflectance::Model::Lambert), 0.45, 1e-15);
  EXPECT_NEAR(NormalAlbedo(0.12, Reflectance::Model::LunarLambert), 0.12, 1e-15);
  try {
    FindBody("object 'x'", "vulcan");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("vulcan"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("mercury"), std::string::npos);
  }
}

TEST(CelestialBody, EveryBodyOfTheTableCanBeMade) {
  for (const KnownBody& known : KnownBodies()) {
    EXPECT_NO_THROW(CelestialBody("object", known.shape)) << known.name;
  }
}

TEST(CelestialBody, BoundsHoldRingsAndAir) {
  const CelestialBody saturn("saturn", FindBody("o", "saturn").shape);
  EXPECT_EQ(saturn.Bounds().radius, 136775e3);
  const CelestialBody earth("earth", FindBody("o", "earth").shape);
  EXPECT_EQ(earth.Bounds().radius, 6378.137e3 + 100e3);
}

TEST(CelestialBody, BadShapesAreRejected) {
  const BodyShape good = FindBody("o", "saturn").shape;
  const auto rejected = [&](const auto& change) {
    BodyShape shape = good;
    change(shape);
    EXPECT_THROW(CelestialBody("object 'x'", shape), Error);
  };
  rejected([](BodyShape& s) { s.radii.x() = 0.0; });
  rejected([](BodyShape& s) { s.radii.y() = std::nan(""); });
  rejected([](BodyShape& s) { s.radii.z() = 1e5; }); // a disc
  rejected([](BodyShape& s) { s.leftEdge_deg = 400.0; });
  rejected([](BodyShape& s) { s.brightness = -1.0; });
  rejected([](BodyShape& s) { s.rings[0].inner = 1e7; }); // within the body
  rejected([](BodyShape& s) { s.rings[1].inner = s.rings[0].inner; });
  rejected([](BodyShape& s) { s.rings[0].opticalDepth = -0.1; });
}

} // namespace
} // namespace dspace
