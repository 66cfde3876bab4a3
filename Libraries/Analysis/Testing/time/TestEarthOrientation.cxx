// Tables of UT1 and polar motion. Real ones: Testing/Python/sky/test_earth_orientation.py.
#include <cmath>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/time/DayText.h>
#include <dspace/time/EarthOrientation.h>

namespace dspace {
namespace {

constexpr double Arcsec = M_PI / 648000.0;
const char* const C04 = "  a header of any text\n\n"
                        "1962   1   1  37665  -0.012700   0.213000   0.0326338   0.0017230\n"
                        "1962   1   2  37666  -0.015900   0.214100   0.0320547   0.0016690\n"
                        "1962   1   3  37667  -0.019000   0.215200   0.0315526   0.0015820\n";

TEST(EarthOrientation, RowsAndWhatLiesBetween) {
  const EarthOrientation earth = EarthOrientation::Parse(C04, "c04");
  ASSERT_EQ(earth.Rows().size(), 3u);
  EXPECT_EQ(earth.Rows()[1].ut1MinusUtc, 0.0320547);
  EXPECT_FALSE(earth.FirstPredicted());
  EXPECT_NEAR(earth.PoleAt(37665.25).x(), (0.75 * -0.0127 + 0.25 * -0.0159) * Arcsec, 1e-15);
  EXPECT_NEAR(earth.PoleAt(37667.0).y(), 0.2152 * Arcsec, 1e-15);
  EXPECT_TRUE(earth.Covers(37667.0));
  for (const double outside : {37664.9, 37667.1, std::nan("")}) {
    EXPECT_FALSE(earth.Covers(outside));
    EXPECT_THROW(earth.PoleAt(outside), Error);
  }
  EXPECT_EQ(DayText(int(earth.LastMjd())), "1962-01-03");
}

TEST(EarthOrientation, RejectsWhatIsNoTable) {
  for (const char* bad : {"", "1962   1   1  37665  -0.012700   0.213000   0.0326338   0.0017230\n",
                          // A day twice, a date that is not the day, and UT1 - UTC of hours.
                          "1962 1 1 37665 0 0 0 0\n1962 1 1 37665 0 0 0 0\n",
                          "1962 1 1 37665 0 0 0 0\n1962 1 3 37666 0 0 0 0\n",
                          "1962 1 1 37665 0 0 0 0\n1962 1 2 37666 0 0 86400 0\n"}) {
    EXPECT_THROW(EarthOrientation::Parse(bad, "bad"), Error) << bad;
  }
  EXPECT_FALSE(EarthOrientation::Recognizes("/no/such/file"));
  EXPECT_THROW(EarthOrientation::Read("/no/such/file"), Error);
}

} // namespace
} // namespace dspace
