// Contacts: a target whose elevation is a known function of time.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/visibility/Contacts.h>

namespace {

using namespace dspace;

constexpr double Day = 86400.0;

// Elevation 40 sin(2 pi t / day) over a mask.
std::vector<Contact> Daily(double mask, double start, double end, double step) {
  return FindContacts(
      [mask](double t) {
        const double elevation = 40.0 * std::sin(2.0 * M_PI * t / Day);
        return Sighted{
            {std::fmod(t / Day * 360.0, 360.0), elevation}, 1000.0 + t, elevation - mask};
      },
      start, end, step);
}

TEST(Contacts, RiseSetAndPeakOfASine) {
  const std::vector<Contact> found = Daily(10.0, 0.0, 3.0 * Day, 600.0);
  ASSERT_EQ(found.size(), 3u);
  const double rise = std::asin(0.25) / (2.0 * M_PI) * Day;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i].rise, i * Day + rise, 2e-3);
    EXPECT_NEAR(found[i].set, (i + 0.5) * Day - rise, 2e-3);
    EXPECT_NEAR(found[i].peak, (i + 0.25) * Day, 2.0); // flat: 2 s from it is 1e-7 degrees lower
    EXPECT_NEAR(found[i].atPeak.direction.elevation_deg, 40.0, 1e-6);
    EXPECT_NEAR(found[i].atRise.direction.elevation_deg, 10.0, 1e-5);
    EXPECT_GE(found[i].atRise.margin_deg, 0.0); // rise and set lie in the contact
    EXPECT_GE(found[i].atSet.margin_deg, 0.0);
    EXPECT_NEAR(found[i].atSet.range, 1000.0 + found[i].set, 1e-9);
    EXPECT_FALSE(found[i].sinceBefore || found[i].untilAfter);
  }
}

TEST(Contacts, ThoseCutByTheSpanSayIt) {
  const std::vector<Contact> found = Daily(0.0, 0.1 * Day, 1.2 * Day, 600.0);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_TRUE(found[0].sinceBefore);
  EXPECT_FALSE(found[0].untilAfter);
  EXPECT_DOUBLE_EQ(found[0].rise, 0.1 * Day);
  EXPECT_NEAR(found[1].rise, Day, 2e-3);
  EXPECT_TRUE(found[1].untilAfter);
  EXPECT_DOUBLE_EQ(found[1].set, 1.2 * Day);
  EXPECT_DOUBLE_EQ(found[1].peak, 1.2 * Day); // still rising
  EXPECT_EQ(Daily(41.0, 0.0, Day, 600.0).size(), 0u);
  const std::vector<Contact> always = Daily(-41.0, 0.0, Day, 600.0);
  ASSERT_EQ(always.size(), 1u);
  EXPECT_TRUE(always[0].sinceBefore && always[0].untilAfter);
}

// Above 39.999 degrees for 97 s a day; samples every 2 h. Below -39.999 likewise: a gap.
TEST(Contacts, ShorterThanAStepAreFound) {
  const double half = std::acos(39.999 / 40.0) / (2.0 * M_PI) * Day;
  const std::vector<Contact> found = Daily(39.999, 0.0, 4.0 * Day, 7000.0);
  ASSERT_EQ(found.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(found[i].set - found[i].rise, 2.0 * half, 4e-3);
  }
  const std::vector<Contact> gaps = Daily(-39.999, 0.0, 4.0 * Day, 7000.0);
  ASSERT_EQ(gaps.size(), 5u);
  EXPECT_NEAR(gaps[1].rise - gaps[0].set, 2.0 * half, 4e-3);
}

TEST(Contacts, RejectSpansAndSteps) {
  const auto rejected = [](double start, double end, double step) {
    try {
      Daily(0.0, start, end, step);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(rejected(5.0, 5.0, 1.0).find("accepted: an end after the start"), std::string::npos);
  EXPECT_NE(rejected(0.0, NAN, 1.0).find("accepted: an end after the start"), std::string::npos);
  EXPECT_NE(rejected(0.0, 1.0, 0.0).find("the step is 0"), std::string::npos);
  EXPECT_NE(rejected(0.0, 1e9, 1.0).find("at most 2,000,000 steps"), std::string::npos);
}

} // namespace
