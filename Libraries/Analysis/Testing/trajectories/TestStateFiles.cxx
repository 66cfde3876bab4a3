// OEM and xyzv files: what is read, what is rejected, and two real missions.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/ephemeris/De405Source.h>
#include <dspace/ephemeris/Ephemeris.h>
#include <dspace/time/UtcText.h>
#include <dspace/trajectories/OemFile.h>
#include <dspace/trajectories/XyzvFile.h>

#include "MissingPackage.h"
#include "TemporaryFolder.h"
#include "TestData.h"

namespace dspace {
namespace {

using testing::TemporaryFolder;

const TimeScales& Scales() {
  static const TimeScales scales(LeapSeconds::FromErfa());
  return scales;
}

std::string Write(const TemporaryFolder& folder, const std::string& text) {
  const std::string path = folder / "file.oem";
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

const char* Head = "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2020-01-01T00:00:00\nORIGINATOR = TEST\n";

std::string Block(const std::string& start, const std::string& stop, const std::string& more,
                  const std::string& states, const std::string& system = "TDB") {
  return "META_START\nOBJECT_NAME = CRAFT\nOBJECT_ID = 2020-001A\nCENTER_NAME = EARTH\n"
         "REF_FRAME = EME2000\nTIME_SYSTEM = " +
         system + "\nSTART_TIME = " + start + "\nSTOP_TIME = " + stop + "\n" + more +
         "META_STOP\nCOMMENT a comment\n" + states;
}

const char* Two =
    "2020-01-01T12:00:00 7000 0 0 0 7.5 0\n2020-01-01T12:01:00 6990 450 0 -0.5 7.5 0\n";

TEST(OemFile, ReadsStatesOfEveryTimeSystem) {
  const TemporaryFolder folder;
  // 2020-01-01 12:00 TDB is 7305 days past J2000.
  const double noon = 7305.0 * 86400.0;
  for (const auto& [system, offset] : {std::pair<const char*, double>{"TDB", 0.0},
                                       {"TT", 0.0},
                                       {"TAI", 32.184},
                                       {"UTC", 32.184 + 37.0},
                                       {"GPS", 32.184 + 19.0}}) {
    const OemFile file(
        Write(folder, Head + Block("2020-01-01T12:00:00", "2020-01-01T12:01:00", "", Two, system)),
        Scales());
    const TrajectoryPtr path = file.GetTrajectory();
    EXPECT_NEAR(path->Span().begin, noon + offset, 2e-3) << system; // TDB - TT: below 1.7 ms
    EXPECT_NEAR(path->Span().end - path->Span().begin, 60.0, 1e-6);
    EXPECT_EQ(path->At(path->Span().begin).position, Eigen::Vector3d(7e6, 0, 0));
    EXPECT_EQ(path->At(path->Span().begin).velocity, Eigen::Vector3d(0, 7500, 0));
    EXPECT_EQ(file.Frame(), "J2000");
    EXPECT_EQ(file.ObjectName(), "CRAFT");
  }
}

TEST(OemFile, ReadsTheInterpolationThatItStates) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& more) {
    return OemFile(
               Write(folder, Head + Block("2020-01-01T12:00:00", "2020-01-01T12:01:00", more, Two)),
               Scales())
        .Blocks()[0]
        .table->Get()
        .interpolation;
  };
  EXPECT_EQ(read("INTERPOLATION = LINEAR\nINTERPOLATION_DEGREE = 1\n").kind,
            Interpolation::Kind::Linear);
  EXPECT_EQ(read("INTERPOLATION = Lagrange\nINTERPOLATION_DEGREE = 1\n").kind,
            Interpolation::Kind::Lagrange);
  EXPECT_EQ(read("INTERPOLATION = HERMITE\nINTERPOLATION_DEGREE = 3\n").degree, 3);
  EXPECT_EQ(read("").degree, 3); // of two states
}

TEST(OemFile, JoinsBlocksAndKeepsToTheirUseableSpans) {
  const TemporaryFolder folder;
  const std::string one = Block(
      "2020-01-01T12:00:00", "2020-01-01T12:01:00",
      "USEABLE_START_TIME = 2020-01-01T12:00:10\nUSEABLE_STOP_TIME = 2020-01-01T12:00:50\n", Two);
  const std::string next =
      Block("2020-01-01T12:00:50", "2020-01-01T12:02:00", "",
            "2020-01-01T12:00:50 1 2 3 4 5 6 0.1 0.2 0.3\n2020-01-01T12:02:00 1 2 3 4 5 6\n"
            "COVARIANCE_START\nEPOCH = 2020-01-01T12:01:00\n1\n2 3\nCOVARIANCE_STOP\n");
  const OemFile file(Write(folder, Head + one + next), Scales());
  const TrajectoryPtr path = file.GetTrajectory();
  const double noon = 7305.0 * 86400.0;
  EXPECT_NEAR(path->Span().begin, noon + 10.0, 1e-6);
  EXPECT_NEAR(path->Span().end, noon + 120.0, 1e-6);
  EXPECT_EQ(path->At(noon + 50.0).position, Eigen::Vector3d(1e3, 2e3, 3e3));
  EXPECT_GT(path->At(noon + 49.9).position.x(), 6e6);
}

TEST(OemFile, RejectsWhatTheStandardDoesNotAllow) {
  const TemporaryFolder folder;
  const auto rejected = [&](const std::string& text, Error::Kind kind, const char* words) {
    try {
      OemFile(Write(folder, text), Scales()).GetTrajectory();
      FAIL() << "accepted: " << words;
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), kind) << error.what();
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("file.oem"), std::string::npos) << error.what();
    }
  };
  const auto block = [](const std::string& more, const std::string& states,
                        const std::string& system = "TDB") {
    return Head + Block("2020-01-01T12:00:00", "2020-01-01T12:01:00", more, states, system);
  };
  using Kind = Error::Kind;
  const std::string good = block("", Two);
  rejected("", Kind::Corrupt, "empty");
  rejected("hello\n", Kind::Corrupt, "KEYWORD = value");
  rejected("CCSDS_OPM_VERS = 2.0\n", Kind::Corrupt, "CCSDS_OEM_VERS");
  rejected("CCSDS_OEM_VERS = 9.0\n", Kind::Unsupported, "9.0");
  rejected("<?xml version=\"1.0\"?>\n", Kind::Unsupported, "XML");
  rejected(Head, Kind::Corrupt, "metadata");
  rejected(block("", ""), Kind::Corrupt, "no states");
  rejected(block("", Two, "UT1"), Kind::Unsupported, "UT1");
  rejected(block("", Two, "MET"), Kind::Unsupported, "MET");
  rejected(block("INTERPOLATION = SPLINE\nINTERPOLATION_DEGREE = 3\n", Two), Kind::Corrupt,
           "SPLINE");
  rejected(block("INTERPOLATION = HERMITE\n", Two), Kind::Corrupt, "INTERPOLATION_DEGREE");
  rejected(block("INTERPOLATION = HERMITE\nINTERPOLATION_DEGREE = 2.5\n", Two), Kind::Corrupt,
           "2.5");
  rejected(block("INTERPOLATION = HERMITE\nINTERPOLATION_DEGREE = 7\n", Two), Kind::InvalidArgument,
           "4 and more");
  rejected(block("COLOR = RED\n", Two), Kind::Corrupt, "COLOR");
  rejected(block("TIME_SYSTEM = UTC\n", Two), Kind::Corrupt, "twice");
  rejected(block("", "2020-01-01T12:00:00 7000 0 0 0 7.5\n"), Kind::Corrupt, "6 words");
  rejected(block("", "2020-01-01T12:00:00 7000 0 0 0 7.5 zero\n"), Kind::Corrupt, "zero");
  rejected(block("", "2020-01-01T12:00:00 7000 0 0 0 7.5 1e999\n"), Kind::Corrupt, "1e999");
  rejected(block("", "2020-13-01T12:00:00 7000 0 0 0 7.5 0\n"), Kind::Corrupt, "line");
  rejected(block("", std::string(Two) + "2020-01-01T12:00:30 7000 0 0 0 7.5 0\n"), Kind::Corrupt,
           "not after");
  rejected(good + "COVARIANCE_START\n", Kind::Corrupt, "covariance");
  rejected(good + good.substr(std::string(Head).size()), Kind::InvalidArgument, "overlap");
  std::string other = good;
  std::string second = Block("2020-01-01T12:01:00", "2020-01-01T12:02:00", "",
                             "2020-01-01T12:01:00 1 2 3 4 5 6\n2020-01-01T12:02:00 1 2 3 4 5 6\n");
  rejected(other + std::string(second).replace(second.find("2020-001A"), 9, "2020-001B"),
           Kind::InvalidArgument, "2020-001B");
  rejected(other + std::string(second).replace(second.find("EARTH"), 5, "MOON_"), Kind::Unsupported,
           "MOON_");
  rejected(good.substr(0, good.find("META_STOP")), Kind::Corrupt, "within metadata");
  EXPECT_THROW(OemFile(folder / "absent.oem", Scales()), Error);
}

// The time and the distance at which a function of time is largest, by golden section from samples.
std::pair<double, double> Largest(const TimeSpan& span, double step,
                                  const std::function<double(double)>& f) {
  double best = span.begin;
  for (double t = span.begin; t <= span.end; t += step) {
    best = f(t) > f(best) ? t : best;
  }
  double low = std::max(span.begin, best - step);
  double high = std::min(span.end, best + step);
  while (high - low > 1e-3) {
    const double a = high - 0.618 * (high - low);
    const double b = low + 0.618 * (high - low);
    (f(a) > f(b) ? high : low) = f(a) > f(b) ? b : a;
  }
  return {low, f(low)};
}

// sky_checks.json, artemis1_as_flown: NASA's farthest distance, a radius of 438585.5 km.
TEST(OemFile, ArtemisIWasFarthestWhenAndWhereNasaSaid) {
  DSPACE_REAL_DATA(path, "ephemeris/artemis1_orion_asflown_20221213_OEM.asc");
  const OemFile file(path, Scales());
  EXPECT_EQ(file.ObjectName(), "EM1");
  EXPECT_FALSE(file.Blocks()[0].interpolationStated);
  const TrajectoryPtr orion = file.GetTrajectory();
  const auto [when, radius] =
      Largest(orion->Span(), 600.0, [&](double t) { return orion->At(t).position.norm(); });
  EXPECT_NEAR(radius, 438585.5e3, 60.0); // the value's own rounding is 50 m
  // The time is that of the file's farthest row, of one every four minutes: the apex is within two.
  const double row = TdbFromText("2022-11-28T21:04:34", Scales());
  EXPECT_NEAR(when, row, 120.0) << UtcText(when, Scales());
  const StateTable::Content& rows = file.Blocks()[0].table->Get();
  const auto farthest = std::max_element(
      rows.positions.begin(), rows.positions.end(),
      [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.norm() < b.norm(); });
  EXPECT_NEAR(rows.times[std::size_t(farthest - rows.positions.begin())], row, 1e-4);
  EXPECT_NEAR(farthest->norm(), 438585.5e3, 50.0);
  // The span is the useable one: the STOP_TIME after it has no states.
  EXPECT_NEAR(orion->Span().end, TdbFromText("2022-12-11T17:19:52.617", Scales()), 1e-4);
}

// The flybys of the Moon, with the Moon of DE405; NASA's times are whole minutes.
TEST(OemFile, ArtemisIPassedTheMoonWhenNasaSaid) {
  DSPACE_REAL_DATA(path, "ephemeris/artemis1_orion_asflown_20221213_OEM.asc");
  if (!De405Source::IsInstalled()) {
    DSPACE_MISSING_PACKAGE("casacore-data-jpl-de405");
  }
  const TrajectoryPtr orion = OemFile(path, Scales()).GetTrajectory();
  Ephemeris ephemeris;
  ephemeris.Load(std::make_shared<De405Source>());
  const auto nearness = [&](double t) {
    return -(orion->At(t).position - ephemeris.Find("MOON", "EARTH", t).position).norm();
  };
  const double outbound = TdbFromText("2022-11-21T12:57", Scales());
  const auto [first, distance] = Largest({outbound - 7200.0, outbound + 7200.0}, 30.0, nearness);
  EXPECT_NEAR(first, outbound, 60.0) << UtcText(first, Scales());
  EXPECT_NEAR(-distance - 1737.4e3, 130.5e3, 3e3); // NASA: 81.1 miles above the surface
  // NASA's minute of the return flyby, 16:42, is two minutes before that of its own file: the rows
  // of 16:43:19.643 and 16:44:21.643 approach the Moon and leave it.
  const double approaching = TdbFromText("2022-12-05T16:43:19.643", Scales());
  const double leaving = TdbFromText("2022-12-05T16:44:21.643", Scales());
  for (const double row : {approaching, leaving}) {
    const State state = orion->At(row) - ephemeris.Find("MOON", "EARTH", row);
    EXPECT_EQ(state.position.dot(state.velocity) < 0.0, row == approaching);
  }
  const auto [second, nearest] =
      Largest({approaching - 7200.0, approaching + 7200.0}, 30.0, nearness);
  EXPECT_GT(second, approaching) << UtcText(second, Scales());
  EXPECT_LT(second, leaving) << UtcText(second, Scales());
  EXPECT_NEAR(-nearest - 1737.4e3, 127.5e3, 3e3); // NASA: 79.2 miles
}

TEST(OemFile, ReadsTheOtherMissions) {
  DSPACE_REAL_DATA(mgs, "ephemeris/oem_jpl_mgs_cov.oem");
  const OemFile file(mgs, Scales());
  EXPECT_EQ(file.Blocks()[0].center, "MARS BARYCENTER");
  EXPECT_EQ(file.Blocks()[0].table->Get().interpolation.degree, 7);
  EXPECT_EQ(file.Blocks()[0].table->Get().times.size(), 4u);
  DSPACE_REAL_DATA(lro, "ephemeris/oem_lro_nyx.oem");
  EXPECT_EQ(OemFile(lro, Scales()).Blocks()[0].center, "MOON");
}

// The descent of Curiosity as msl-edl.xyzv has it. Its header names predicted trajectories: it ends
// on the target of the landing, from which Curiosity landed 2.3 km away (NASA: "2.4 km from the
// centre of the ellipse"). Positions are of IAU_MARS; the radius is from the centre, no height
// above any datum.
TEST(XyzvFile, MslEndsOnItsTarget) {
  DSPACE_REAL_DATA(path, "ephemeris/msl-edl.xyzv");
  const XyzvFile file(path);
  EXPECT_EQ(file.Center(), "MARS");
  EXPECT_EQ(file.Frame(), "IAU_MARS");
  EXPECT_EQ(file.Target(), "MARS SCIENCE LABORATORY");
  const auto& table = file.GetTrajectory();
  // The header: "End date: 2012-Aug-06 05:19:04 TDB", five decimals of a Julian date.
  EXPECT_NEAR(table->Span().end, TdbFromText("2012-08-06T05:19:04 TDB", Scales()), 0.9);
  const Eigen::Vector3d end = table->At(table->Span().end).position;
  const double latitude = std::asin(end.z() / end.norm());
  const double longitude = std::atan2(end.y(), end.x());
  EXPECT_NEAR(latitude * 180.0 / M_PI, -4.592, 5e-4);
  EXPECT_NEAR(longitude * 180.0 / M_PI, 137.404, 5e-4);
  EXPECT_NEAR(end.norm(), 3391150.0, 5.0);
  const double east = (137.4417 * M_PI / 180.0 - longitude) * std::cos(latitude) * 3391150.0;
  const double north = (-4.5895 * M_PI / 180.0 - latitude) * 3391150.0;
  EXPECT_NEAR(std::hypot(east, north), 2240.0, 100.0);
  EXPECT_LT(table->At(table->Span().end).velocity.norm(), 1e-3); // it stands
}

TEST(XyzvFile, RejectsDamage) {
  const TemporaryFolder folder;
  const auto rejected = [&](const std::string& text, const char* words) {
    try {
      XyzvFile(Write(folder, text));
      FAIL() << "accepted: " << words;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  rejected("# only a comment\n", "0 states");
  rejected("2451545.0 1 2 3 4 5\n", "6 words");
  rejected("2451545.0 1 2 3 4 5 x\n", "'x'");
  rejected("2451546.0 1 2 3 4 5 6\n2451545.0 1 2 3 4 5 6\n", "before");
  const XyzvFile merged(
      Write(folder, "2451545.0 1 2 3 4 5 6\n2451545.0 9 2 3 4 5 6\n2451546.0 1 2 3 4 5 6\n"));
  EXPECT_EQ(merged.Merged(), 1u);
  EXPECT_EQ(merged.GetTrajectory()->At(0.0).position.x(), 9e3);
}

} // namespace
} // namespace dspace
