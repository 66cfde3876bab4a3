// Which bodies eclipse the Sun, and how much of it they leave.
#include <gtest/gtest.h>

#include <dspace/ephemeris/BodyNames.h>
#include <dspace/sky/KernelSet.h>
#include <dspace/sky/SkyEclipse.h>

namespace dspace {
namespace {

TEST(SkyEclipse, TheEarthAndTheMoonEclipseOverEachOther) {
  EXPECT_EQ(EclipserOver(301), 399);
  EXPECT_EQ(EclipserOver(399), 301);
  EXPECT_FALSE(EclipserOver(499));
  EXPECT_FALSE(EclipserOver(BodySun));
}

// A Sun where the Moon stands, smaller and larger than it, and beside it. Over Mars there is none.
TEST(SkyEclipse, DiscsThatMeetLeaveAPart) {
  const KernelSet kernels;
  const Ephemeris& ephemeris = kernels.GetEphemeris();
  const Frames& frames = kernels.GetFrames();
  SkyPlace place = {399, "IAU_EARTH",
                    AxesAt({10.0, 40.0, 0.0, LatitudeKind::Planetocentric},
                           Eigen::Vector3d::Constant(6371000.0))};
  const SkyBody moon = Look(ephemeris, frames, place, 301, 0.0);
  SkyBody sun = moon;
  sun.radius_deg = 0.5 * moon.radius_deg;
  EXPECT_EQ(SunLeftOver(ephemeris, frames, place, sun, 0.0), 0.0);
  sun.radius_deg = 2.0 * moon.radius_deg; // a ring: three quarters
  EXPECT_NEAR(SunLeftOver(ephemeris, frames, place, sun, 0.0), 0.75, 1e-9);
  sun.eastNorthUp = -sun.eastNorthUp;
  EXPECT_EQ(SunLeftOver(ephemeris, frames, place, sun, 0.0), 1.0);
  place.body = 499;
  EXPECT_EQ(SunLeftOver(ephemeris, frames, place, moon, 0.0), 1.0);
}

} // namespace
} // namespace dspace
