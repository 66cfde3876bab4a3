// Time scales against SPICE's values, ERFA, and the definitions.
#include <dspace/time/TimeScales.h>

#include <cmath>
#include <fstream>
#include <random>

#include <erfa.h>
#include <gtest/gtest.h>

#include <TemporaryFolder.h>

#include <dspace/Error.h>
#include <dspace/time/UtcText.h>

namespace {

using namespace dspace;
using dspace::testing::TemporaryFolder;

TEST(TimeScales, SpiceValue) {
  // CSPICE, recorded by SpiceyPy: str2et("1997-03-20T12:53:29").
  EXPECT_NEAR(TdbFromText("1997-03-20T12:53:29", TimeScales()), -87865528.8143913, 1e-7);
}

// eraUtctai has another way to leap seconds and to the rates before 1972.
TEST(TimeScales, UtcAndTaiAsErfaHasThem) {
  const TimeScales scales;
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const double days = std::uniform_real_distribution<double>(36935.0, 64000.0)(random); // to 2034
    const int mjd = int(days);
    const double seconds = std::floor((days - mjd) * 86400.0);
    double a = 0.0, b = 0.0;
    // ERFA's quasi-JD stretches days with a leap second.
    const double length = scales.GetLeapSeconds().SecondsOfDay(mjd);
    ASSERT_GE(eraUtctai(2400000.5, mjd + seconds / length, &a, &b), 0);
    const double tai = ((a - 2451545.0) + b) * 86400.0;
    const LeapSeconds& leaps = scales.GetLeapSeconds();
    const double step = leaps.TaiMinusUtc(mjd + 1) - leaps.TaiMinusUtc(mjd, 1.0);
    if (mjd >= 41317 || std::abs(step) < 1e-6) { // ERFA spreads steps before 1972 over a day
      ASSERT_NEAR(scales.TaiFromUtc({mjd, seconds}), tai, 3e-5) << mjd; // a double of the JD
    }
    const TimeScales::UtcDay back = scales.UtcFromTai(scales.TaiFromUtc({mjd, seconds}));
    ASSERT_NEAR((back.mjd - mjd) * 86400.0 + back.seconds - seconds, 0.0, 1e-6) << mjd;
  }
}

TEST(TimeScales, TdbIsSpicesOneTerm) {
  const TimeScales scales;
  double worst = 0.0;
  for (double tt = -1.2e9; tt < 1.6e9; tt += 1.1e6) {
    const double difference = scales.TdbFromTt(tt) - tt;
    const double series = eraDtdb(2451545.0, tt / 86400.0, 0.0, 0.0, 0.0, 0.0);
    worst = std::max(worst, std::abs(difference - series));
    EXPECT_NEAR(scales.TtFromTdb(scales.TdbFromTt(tt)), tt, 2.5e-7);
  }
  EXPECT_LT(worst, 50e-6);
  EXPECT_GT(worst, 1e-6);
}

TEST(TimeScales, LeapSecond) {
  const TimeScales scales;
  const double before = TdbFromText("2016-12-31T23:59:59", scales);
  const double leap = TdbFromText("2016-12-31T23:59:60.25", scales);
  const double after = TdbFromText("2017-01-01T00:00:00Z", scales);
  EXPECT_NEAR(leap - before, 1.25, 1e-6);
  EXPECT_NEAR(after - before, 2.0, 1e-6);
  EXPECT_EQ(UtcText(leap, scales), "2016-12-31T23:59:60.250");
  EXPECT_EQ(UtcText(after, scales, 0), "2017-01-01T00:00:00");
  EXPECT_EQ(UtcText(after - 1e-5, scales), "2017-01-01T00:00:00.000"); // rounded, not 61
  EXPECT_NEAR(TdbFromText("2017-01-01T01:59:60.25+02:00", scales), leap, 1e-6);
  EXPECT_THROW(TdbFromText("2015-12-31T23:59:60", scales), Error);
  EXPECT_THROW(TdbFromText("2016-12-31T22:59:60", scales), Error);
}

TEST(TimeScales, Texts) {
  const TimeScales scales;
  EXPECT_NEAR(TdbFromText("2000-01-01T12:00:00 TDB", scales), 0.0, 1e-9);
  EXPECT_NEAR(TdbFromText("JD 2451545.0 TDB", scales), 0.0, 1e-9);
  EXPECT_NEAR(TdbFromText("JD 2471184.5 TDB", scales), 19639.5 * 86400.0, 1e-6);
  // TT = TAI + 32.184 s by definition; UTC was 32 s behind TAI in 2000.
  const double tt = TdbFromText("2000-01-01T12:00:00 TT", scales);
  EXPECT_NEAR(TdbFromText("2000-01-01T11:59:27.816 TAI", scales), tt, 1e-7);
  EXPECT_NEAR(TdbFromText("2000-01-01T11:58:55.816", scales), tt, 1e-7);
  EXPECT_NEAR(TdbFromText("2000-001 11:58:55.816 UTC", scales), tt, 1e-7);
  EXPECT_NEAR(TdbFromText("2000-01-01T13:58:55.816+02:00", scales), tt, 1e-7);
  EXPECT_NEAR(TdbFromText("2000-01-01", scales) + 43200.0 - 64.184, tt, 1e-4);
  EXPECT_EQ(UtcText(0.0, scales, 6), "2000-01-01T11:58:55.816073"); // TDB - TT = -73 us
  const double last = TdbFromText("9999-12-31T23:59:59", scales);
  EXPECT_EQ(UtcText(last, scales, 0), "9999-12-31T23:59:59");
  for (const char* bad :
       {"", "2000", "2000-13-01", "2001-02-29", "2001-366", "2000-01-01T24:00:01",
        "2000-01-01T12:60", "2000-01-01T12:00:00 XYZ", "10000-01-01", "JD 2451545",
        "1959-12-31T00:00:00", "2000-01-01T12:00:00+25:00", "0000-01-01"}) {
    EXPECT_THROW(TdbFromText(bad, scales), Error) << bad;
  }
  EXPECT_THROW(UtcText(std::nan(""), scales), Error);
  EXPECT_THROW(UtcText(1e13, scales), Error);
}

TEST(TimeScales, Ut1NeedsRows) {
  TimeScales scales;
  EXPECT_THROW(scales.Convert(0.0, TimeScale::Tdb, TimeScale::Ut1), Error);
  scales.SetUt1({{57753.0, -0.4}, {57755.0, 0.6}}); // over the leap second of 2017-01-01
  const double utc = (57754.0 - 51544.5) * 86400.0;
  EXPECT_NEAR(scales.Convert(utc, TimeScale::Utc, TimeScale::Ut1) - utc, 0.6, 1e-5);
  const double noonBefore = utc - 43200.0;
  EXPECT_NEAR(scales.Convert(noonBefore, TimeScale::Utc, TimeScale::Ut1) - noonBefore, -0.4, 1e-5);
  EXPECT_THROW(scales.Convert(0.0, TimeScale::Utc, TimeScale::Ut1), Error);
  EXPECT_THROW(scales.SetUt1({{57755.0, 0.0}, {57753.0, 0.0}}), Error);
}

TEST(LeapSeconds, ListsAreReadAndExpire) {
  TemporaryFolder folder;
  const auto list = [&](const std::string& text) {
    std::ofstream(folder / "list") << text;
    return LeapSeconds::FromList(folder / "list");
  };
  // NTP seconds: 2272060800 is 1972-01-01, 2287785600 is 1972-07-01; it expires on 1973-01-01.
  const LeapSeconds leaps = list("#$ 2272060800\n#@ 2303683200\n2272060800 10 # 1 Jan 1972\n"
                                 "2287785600 11 # 1 Jul 1972\n");
  EXPECT_EQ(leaps.TaiMinusUtc(41498), 10.0);
  EXPECT_EQ(leaps.TaiMinusUtc(41499), 11.0);
  EXPECT_EQ(leaps.SecondsOfDay(41498), 86401);
  EXPECT_EQ(leaps.WarningAt(41682), "");
  EXPECT_NE(leaps.WarningAt(41683).find("known up to 1973-01-01"), std::string::npos)
      << leaps.WarningAt(41683);
  for (const char* bad : {"", "2272060800\n", "2272060800 10\n2287785600 13\n", "1 10\n",
                          "#@ soon\n2272060800 10\n", "2287785600 10\n"}) {
    EXPECT_THROW(list(bad), Error) << bad;
  }
  EXPECT_EQ(LeapSeconds::FromErfa().TaiMinusUtc(57754), 37.0);
  EXPECT_EQ(LeapSeconds::FromErfa().TaiMinusUtc(57753), 36.0);
  EXPECT_THROW(LeapSeconds::FromErfa().TaiMinusUtc(36933), Error);
}

} // namespace
