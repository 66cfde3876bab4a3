// The body of a coordinate reference system.
#include <gtest/gtest.h>

#include <fstream>

#include <dspace/Error.h>
#include <dspace/crs/Crs.h>
#include <dspace/sky/KernelSet.h>
#include <dspace/state/TerrainBody.h>

#include "TemporaryFolder.h"

namespace dspace::session {
namespace {

Crs Degrees(double radius) {
  return Crs::FromText("+proj=longlat +R=" + std::to_string(radius) + " +no_defs");
}

TEST(TerrainBody, ByItsNameOrRadius) {
  const KernelSet kernels;
  EXPECT_EQ(FindBody(kernels, Degrees(1737400.0)), 301);
  EXPECT_EQ(FindBody(kernels, Degrees(3396190.0)), 499);
  EXPECT_EQ(FindBody(kernels, Crs::FromText("EPSG:4326")), 399);
  EXPECT_FALSE(FindBody(kernels, Degrees(123456.0)));
  EXPECT_THROW(BodyOf(kernels, Degrees(123456.0), "terrain 'x'"), Error);
}

TEST(TerrainBody, AnotherBodyThanTheCrsTellsIsWarnedOf) {
  const KernelSet kernels;
  std::string warning;
  const auto warn = [&](const std::string& text) { warning = text; };
  EXPECT_EQ(BodyFor(kernels, Degrees(1737400.0), "", "terrain 'x'", warn), 301);
  EXPECT_EQ(BodyFor(kernels, Degrees(1737400.0), "Moon", "terrain 'x'", warn), 301);
  EXPECT_EQ(BodyFor(kernels, Degrees(123456.0), "mars", "terrain 'x'", warn), 499);
  EXPECT_EQ(warning, "");
  EXPECT_EQ(BodyFor(kernels, Degrees(1737400.0), "mars", "terrain 'x'", warn), 499);
  EXPECT_NE(warning.find("terrain 'x': the command names body 'mars'"), std::string::npos);
  EXPECT_THROW(BodyFor(kernels, Degrees(1737400.0), "nowhere", "terrain 'x'", warn), Error);
}

// Wrong radii of the Earth are none of Mars's business.
TEST(TerrainBody, AKernelThatIsWrongOfAnotherBodyDoesNotCount) {
  const dspace::testing::TemporaryFolder folder;
  const std::string path = (folder.Path() / "wrong.tpc").string();
  std::ofstream(path) << "KPL/PCK\n\\begindata\nBODY399_RADII = ( 6378.1 )\n";
  const std::shared_ptr<const KernelSet> kernels = KernelSet().With(path);
  EXPECT_EQ(FindBody(*kernels, Degrees(3396190.0)), 499);
  const auto turn = InertialFromFixed(*kernels, Degrees(3396190.0), 0.0);
  ASSERT_TRUE(turn);
  EXPECT_TRUE((*turn * turn->transpose()).isIdentity(1e-12));
  EXPECT_FALSE(InertialFromFixed(*kernels, Degrees(123456.0), 0.0));
}

} // namespace
} // namespace dspace::session
