// States against CSPICE's and Horizons' recorded values, and against the definitions of light time
// and aberration.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>

#include <Eigen/Geometry>

#include <erfa.h>
#include <erfam.h>
#include <gtest/gtest.h>

#include <MissingPackage.h>
#include <TestData.h>

#include <dspace/Error.h>
#include <dspace/ephemeris/De405Source.h>
#include <dspace/ephemeris/Ephemeris.h>
#include <dspace/ephemeris/ErfaSource.h>
#include <dspace/ephemeris/Fallbacks.h>
#include <dspace/ephemeris/SpkSource.h>
#include <dspace/time/UtcText.h>

#include "JplTestVectors.h"

namespace {

using namespace dspace;

constexpr double Au = 149597870700.0;

State InKilometres(const double (&s)[6]) {
  return {1e3 * Eigen::Vector3d(s[0], s[1], s[2]), 1e3 * Eigen::Vector3d(s[3], s[4], s[5])};
}

// spice_checks.json, in both byte orders. A double of the time resolves 1e-8 s, in which Mars moves
// 0.1 mm.
TEST(Ephemeris, MarsAsSpiceHasIt) {
  const State geometric =
      InKilometres({73826216.4145559966564, -27128030.5524311661720, -18741973.8849752545357,
                    -6.80950358877040429206, 7.51381423681132254444, 3.00129002640705921934});
  const State apparent =
      InKilometres({73822235.3105354905128, -27127918.9984722770751, -18741306.3014898747206,
                    -6.80851334001380692484, 7.51399612408221173609, 3.00129849265935222391});
  for (const char* name : {"de405s_littleendian.bsp", "de405s_bigendian.bsp"}) {
    DSPACE_REAL_DATA(path, std::string("ephemeris/spice_test_kernels/") + name);
    Ephemeris ephemeris;
    ephemeris.Load(std::make_shared<SpkSource>(path));
    const double tdb = TdbFromText("2003-07-04T19:00:00", TimeScales());
    Ephemeris::Query query;
    query.target = ephemeris.Names().IdOf("mars");
    query.observer = ephemeris.Names().IdOf("Earth");
    Ephemeris::Result result = ephemeris.Find(query, tdb);
    EXPECT_LT((result.state.position - geometric.position).norm(), 1e-3);
    EXPECT_LT((result.state.velocity - geometric.velocity).norm(), 1e-8);
    EXPECT_NEAR(result.lightTime, 269.70264751151603, 1e-11);
    query.correction = Correction::LightTimeStar;
    result = ephemeris.Find(query, tdb);
    EXPECT_LT((result.state.position - apparent.position).norm(), 1e-3);
    // SPICE differentiates the aberration with the acceleration by differences, as we do.
    EXPECT_LT((result.state.velocity - apparent.velocity).norm(), 1e-6);
    EXPECT_NEAR(result.lightTime, 269.6898813661505, 1e-11);
  }
}

// horizons_checks.json.
TEST(Ephemeris, CallistoAsHorizonsHasIt) {
  DSPACE_REAL_DATA(path, "ephemeris/jup310_excerpt_2053-10-08.bsp");
  Ephemeris ephemeris;
  ephemeris.Load(std::make_shared<SpkSource>(path));
  const Ephemeris::Query query{504, 399, "J2000", Correction::None};
  const double tdb = (2471184.5 - 2451545.0) * 86400.0;
  const State state = ephemeris.Find(query, tdb).state;
  const Eigen::Vector3d position =
      Au * Eigen::Vector3d(-4.884815926454119, -3.705745549073268, -1.493487818022234);
  const Eigen::Vector3d velocity =
      Au / 86400.0 *
      Eigen::Vector3d(9.604665478763035e-03, -1.552997751083403e-02, -6.678445860769302e-03);
  EXPECT_LT((state.position - position).norm(), 1.0);
  EXPECT_LT((state.velocity - velocity).norm(), 1e-5);

  // Astrometric, at JD 2471184.5007775929 TT.
  const double tt = (2471184.0 - 2451545.0) * 86400.0 + 0.5007775929 * 86400.0;
  const double seen = TimeScales().Convert(tt, TimeScale::Tt, TimeScale::Tdb);
  const Eigen::Vector3d p =
      ephemeris.Find({504, 399, "J2000", Correction::Converged}, seen).state.position;
  EXPECT_NEAR(p.norm(), 6.31079291776184 * Au, 0.2);
  const double degrees = 180.0 / M_PI;
  const double rightAscension = std::atan2(p.y(), p.x()) * degrees + 360.0;
  const double declination = std::asin(p.z() / p.norm()) * degrees;
  EXPECT_NEAR(rightAscension, 217.1839292, 0.001 / 3600.0);
  EXPECT_NEAR(declination, -13.6892791, 0.001 / 3600.0);
}

// horizons_checks.json: the Moon from Boston. The place turns by ERFA's precession and nutation.
TEST(Ephemeris, MoonFromBostonAsHorizonsHasIt) {
  DSPACE_REAL_DATA(path, "ephemeris/de430_excerpt_2015-03-02.bsp");
  Ephemeris ephemeris;
  ephemeris.Load(std::make_shared<SpkSource>(path));
  TimeScales scales;
  const double tdb = TdbFromText("2015-03-02T00:00:00 TDB", scales);
  const double tt = scales.Convert(tdb, TimeScale::Tdb, TimeScale::Tt);
  // Delta T as UT1 - UTC: TT - UTC is 67.184 s at this time.
  scales.SetUt1({{57083.0, 67.184 - 67.7139857}});
  const double ut1 = scales.Convert(tdb, TimeScale::Tdb, TimeScale::Ut1);
  EXPECT_NEAR(tt - ut1, 67.7139857, 1e-6);
  const double arcsecond = M_PI / 180.0 / 3600.0;
  double turn[3][3], place[3];
  eraC2t06a(2451545.0, tt / 86400.0, 2451545.0, ut1 / 86400.0, 0.003483 * arcsecond,
            0.358609 * arcsecond, turn);
  const double longitude = -(71.0 + 3.0 / 60.0 + 24.8 / 3600.0) * M_PI / 180.0;
  const double latitude = (42.0 + 21.0 / 60.0 + 24.1 / 3600.0) * M_PI / 180.0;
  ASSERT_EQ(eraGd2gc(ERFA_WGS84, longitude, latitude, 0.0, place), 0);
  const Eigen::Vector3d boston =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&turn[0][0]).transpose() *
      Eigen::Map<const Eigen::Vector3d>(place);
  const Eigen::Vector3d moon = ephemeris.Find("moon", "earth", tdb).position - boston;
  const Eigen::Vector3d truth =
      Au * Eigen::Vector3d(-0.001341501206552443, 0.002190483327459023, 0.0006839177007993498);
  // Horizons' place is rounded to 0.1", 3 m: skyfield is 1.147 m off, too, and the tolerance is
  // that of each component.
  EXPECT_LT((moon - truth).cwiseAbs().maxCoeff(), 1.1);
  EXPECT_NEAR((moon - truth).norm(), 1.1468, 1e-3); // skyfield 1.45, with the same Delta T
}

// Debian's table against NAIF's kernel of the same ephemeris.
TEST(Ephemeris, De405IsTheKernel) {
  DSPACE_REAL_DATA(path, "ephemeris/spice_test_kernels/de405s_littleendian.bsp");
  if (!De405Source::IsInstalled()) {
    DSPACE_MISSING_PACKAGE("casacore-data-jpl-de405");
  }
  Ephemeris table, kernel;
  table.Load(std::make_shared<De405Source>());
  kernel.Load(std::make_shared<SpkSource>(path));
  double begin = -1e300, end = 1e300;
  for (const auto& coverage : kernel.Sources()[0]->Coverages()) {
    begin = std::max(begin, coverage.begin);
    end = std::min(end, coverage.end);
  }
  std::mt19937_64 random(405);
  std::uniform_real_distribution<double> any(begin, end);
  for (const int body : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 301, 399}) {
    const int observer = body == 301 ? 399 : body == 399 ? 3 : 0;
    double position = 0.0, velocity = 0.0, distance = 0.0;
    for (int i = 0; i < 500; ++i) {
      const double tdb = i == 0 ? begin : i == 1 ? end : any(random);
      const State a = table.Find({body, observer}, tdb).state;
      const State b = kernel.Find({body, observer}, tdb).state;
      position = std::max(position, (a.position - b.position).norm());
      velocity = std::max(velocity, (a.velocity - b.velocity).norm());
      distance = std::max(distance, b.position.norm());
    }
    EXPECT_LT(position, 1e-3 + 1e-15 * distance) << body;
    EXPECT_LT(velocity, 1e-8) << body;
  }
}

// What De405Source::Accuracy states.
TEST(Ephemeris, De405AgainstDe430) {
  DSPACE_REAL_DATA(path, "ephemeris/de430_excerpt_2015-03-02.bsp");
  if (!De405Source::IsInstalled()) {
    DSPACE_MISSING_PACKAGE("casacore-data-jpl-de405");
  }
  Ephemeris de405, de430;
  de405.Load(std::make_shared<De405Source>());
  de430.Load(std::make_shared<SpkSource>(path));
  const double tdb = (57083.0 - 51544.5) * 86400.0;
  struct Stated {
    int body, observer;
    double kilometres;
  };
  for (const Stated& stated :
       {Stated{301, 399, 0.0105}, Stated{1, 10, 1.0}, Stated{2, 10, 1.0}, Stated{399, 10, 1.0},
        Stated{4, 10, 1.0}, Stated{5, 10, 130.0}, Stated{6, 10, 620.0}, Stated{7, 10, 2300.0},
        Stated{8, 10, 5000.0}, Stated{9, 10, 12400.0}}) {
    const Ephemeris::Query query{stated.body, stated.observer};
    const double difference =
        (de405.Find(query, tdb).state.position - de430.Find(query, tdb).state.position).norm();
    EXPECT_LT(difference, 1e3 * stated.kilometres) << stated.body;
    EXPECT_GT(difference, 0.4e3 * stated.kilometres) << stated.body;
  }
}

// ERFA's series stay within their stated errors of DE405, and their warnings say so.
TEST(Ephemeris, ErfaWithinItsStatedErrors) {
  if (!De405Source::IsInstalled()) {
    DSPACE_MISSING_PACKAGE("casacore-data-jpl-de405");
  }
  Ephemeris de405, erfa;
  de405.Load(std::make_shared<De405Source>());
  const auto source = std::make_shared<ErfaSource>();
  erfa.Load(source);
  struct Stated {
    int body, observer;
    double kilometres, least; // `least`: so far off they are, or the comparison is none
  };
  for (const Stated& stated :
       {Stated{301, 399, 32.0, 5.0}, Stated{399, 10, 11.2, 0.5}, Stated{399, 0, 13.4, 0.5},
        Stated{1, 10, 1.5e3, 500.0}, Stated{2, 10, 3.2e3, 1e3}, Stated{4, 10, 27e3, 9e3},
        Stated{5, 10, 180e3, 5e4}, Stated{6, 10, 540e3, 1e5}, Stated{7, 10, 970e3, 2e5},
        Stated{8, 10, 260e3, 9e4}}) {
    double worst = 0.0, velocity = 0.0;
    for (double tdb = -1.26e9; tdb < 1.89e9; tdb += 0.9e6) { // 1960 to 2059
      const Ephemeris::Query query{stated.body, stated.observer};
      const State difference = erfa.Find(query, tdb).state - de405.Find(query, tdb).state;
      worst = std::max(worst, difference.position.norm());
      velocity = std::max(velocity, difference.velocity.norm());
    }
    EXPECT_LT(worst, 1e3 * stated.kilometres) << stated.body;
    EXPECT_GT(worst, 1e3 * stated.least) << stated.body;
    EXPECT_LT(velocity, 6.0) << stated.body;
  }
  EXPECT_NE(source->Warning(301).find("32 km"), std::string::npos);
  EXPECT_NE(source->Warning(499).find("27,000 km"), std::string::npos);
  // The rates are those of the positions.
  for (const int body : {10, 301, 399, 3, 1, 2, 4, 5, 6, 7, 8}) {
    const Eigen::Vector3d after = source->Find(body, 3e8 + 60.0)->state.position;
    const Eigen::Vector3d before = source->Find(body, 3e8 - 60.0)->state.position;
    EXPECT_LT((source->Find(body, 3e8)->state.velocity - (after - before) / 120.0).norm(), 0.05)
        << body;
  }
}

// A body on a straight line, in units that are easy to follow.
class Straight final : public StateSource {
public:
  Straight(std::string name, int body, const State& atZero, int center = 0, double begin = -1e9,
           double end = 1e9)
      : Name_(std::move(name)), AtZero_(atZero) {
    this->Coverages_.push_back({body, center, 1, begin, end, "line"});
  }
  const std::string& Name() const override { return this->Name_; }
  std::string Accuracy(int /*body*/) const override { return "exact"; }
  const std::vector<Coverage>& Coverages() const override { return this->Coverages_; }
  std::optional<Link> Find(int body, double tdb) const override {
    const Coverage& c = this->Coverages_[0];
    if (body != c.body || tdb < c.begin || tdb > c.end) {
      return std::nullopt;
    }
    return Link{c.center,
                1,
                {this->AtZero_.position + tdb * this->AtZero_.velocity, this->AtZero_.velocity},
                0};
  }

private:
  std::string Name_;
  State AtZero_;
  std::vector<Coverage> Coverages_;
};

// |p + v (t - L) - q| = c L has a closed form on a straight line, and aberration turns by
// asin(|u x w| / c).
TEST(Ephemeris, LightTimeAndAberrationInClosedForm) {
  const State target{{4e11, -3e11, 1e11}, {2.1e6, 3.2e6, -0.7e6}}; // 1 % of c
  const State observer{{-1e11, 0.5e11, 2e10}, {-20e3, 15e3, 12e3}};
  Ephemeris ephemeris;
  ephemeris.Load(std::make_shared<Straight>("target", 1000, target));
  ephemeris.Load(std::make_shared<Straight>("observer", 1001, observer));
  const auto geometricAt = [&](double t) -> Eigen::Vector3d {
    return target.position + t * target.velocity - observer.position - t * observer.velocity;
  };
  const auto lightTimeAt = [&](double t) {
    const Eigen::Vector3d d = geometricAt(t);
    const double c = SpeedOfLight;
    const double a = c * c - target.velocity.squaredNorm();
    const double b = d.dot(target.velocity);
    return (-b + std::sqrt(b * b + a * d.squaredNorm())) / a;
  };
  const auto seenAt = [&](double t, bool star) -> Eigen::Vector3d {
    const Eigen::Vector3d p = geometricAt(t) - lightTimeAt(t) * target.velocity;
    if (!star) {
      return p;
    }
    const Eigen::Vector3d axis = p.cross(observer.velocity);
    const double sine = axis.norm() / p.norm() / SpeedOfLight;
    return Eigen::AngleAxisd(std::asin(sine), axis.normalized()) * p;
  };
  for (const double t : {0.0, 12345.0, -4e4}) {
    for (const bool star : {false, true}) {
      const Ephemeris::Query query{1000, 1001, "J2000",
                                   star ? Correction::ConvergedStar : Correction::Converged};
      const Ephemeris::Result result = ephemeris.Find(query, t);
      EXPECT_NEAR(result.lightTime, lightTimeAt(t), 1e-9);
      EXPECT_LT((result.state.position - seenAt(t, star)).norm(), 1e-2);
      const Eigen::Vector3d rate = (seenAt(t + 5.0, star) - seenAt(t - 5.0, star)) / 10.0;
      EXPECT_LT((result.state.velocity - rate).norm(), 1e-4) << star;
    }
    // One iteration: the light time to where the target was a geometric light time ago.
    const double geometric = geometricAt(t).norm() / SpeedOfLight;
    const double once = (geometricAt(t) - geometric * target.velocity).norm() / SpeedOfLight;
    const Ephemeris::Result lt = ephemeris.Find({1000, 1001, "J2000", Correction::LightTime}, t);
    EXPECT_NEAR(lt.lightTime, once, 1e-9);
    EXPECT_GT(std::abs(once - lightTimeAt(t)), 1e-5); // it does differ
  }
}

TEST(Ephemeris, CorrectionsByName) {
  EXPECT_EQ(CorrectionOf("lt+s"), Correction::LightTimeStar);
  EXPECT_STREQ(CorrectionText(Correction::ConvergedStar), "CN+S");
  EXPECT_THROW(CorrectionOf("XLT"), Error);
}

TEST(Ephemeris, LaterSourcesWinAndTheOthersAreNamed) {
  const auto at = [](double x) { return State{{x, 0.0, 0.0}, {0.0, 0.0, 0.0}}; };
  Ephemeris ephemeris;
  ephemeris.Load(std::make_shared<Straight>("first", 7, at(1.0)));
  ephemeris.Load(std::make_shared<Straight>("second", 7, at(2.0), 0, 0.0, 10.0));
  ephemeris.Load(std::make_shared<Straight>("fallback", 7, at(3.0)), Ephemeris::Priority::Last);
  EXPECT_EQ(ephemeris.FromBarycenter(7, 5.0).position.x(), 2.0);
  EXPECT_EQ(ephemeris.FromBarycenter(7, 11.0).position.x(), 1.0); // the second does not know it
  const auto used = ephemeris.Explain({7, 0}, 5.0);
  ASSERT_EQ(used.size(), 1u);
  EXPECT_EQ(used[0].source, "second");
  EXPECT_EQ(used[0].segment, "line");
  EXPECT_EQ(used[0].accuracy, "exact");
  EXPECT_EQ(used[0].hidden, (std::vector<std::string>{"first", "fallback"}));
  EXPECT_THROW(ephemeris.Load(std::make_shared<Straight>("first", 8, at(0.0))), Error);
  ephemeris.Unload("second");
  EXPECT_EQ(ephemeris.FromBarycenter(7, 5.0).position.x(), 1.0);
  EXPECT_THROW(ephemeris.Unload("second"), Error);
}

// Of each vector the number that the ephemeris has for it.
double NumberFor(const Ephemeris& ephemeris, const JplTestVector& vector) {
  const double tdb = (vector.jed - 2451545.0) * 86400.0;
  const State state = ephemeris.Find({vector.target, vector.center}, tdb).state;
  return vector.coordinate < 3 ? state.position[vector.coordinate] / JplAu
                               : state.velocity[vector.coordinate - 3] * 86400.0 / JplAu;
}

// JPL's criterion is 1e-13 (TESTEPH.F); the 13 decimals of the file are worth half of it.
constexpr double JplTolerance = 1.5e-13;

TEST(Ephemeris, JplsTestVectorsThroughDe405) {
  if (!De405Source::IsInstalled()) {
    DSPACE_MISSING_PACKAGE("casacore-data-jpl-de405");
  }
  const auto de405 = std::make_shared<De405Source>();
  Ephemeris ephemeris;
  ephemeris.Load(de405);
  int librations = 0;
  for (const JplTestVector& vector : JplTestVectors) {
    if (vector.target != Libration) {
      EXPECT_NEAR(NumberFor(ephemeris, vector), vector.value, JplTolerance) << vector.jed;
      continue;
    }
    const auto found = de405->LibrationAt((vector.jed - 2451545.0) * 86400.0);
    ASSERT_TRUE(found);
    const double value = vector.coordinate < 3 ? found->angles[vector.coordinate]
                                               : found->rates[vector.coordinate - 3] * 86400.0;
    // The third angle has turned 2,648 rad, of which a double has 5e-13.
    EXPECT_NEAR(value, vector.value, vector.coordinate == 2 ? 1e-12 : JplTolerance) << vector.jed;
    ++librations;
  }
  EXPECT_EQ(librations, 6);
}

TEST(Ephemeris, JplsTestVectorsThroughSpk) {
  for (const char* name : {"de405s_littleendian.bsp", "de405s_bigendian.bsp"}) {
    DSPACE_REAL_DATA(path, std::string("ephemeris/spice_test_kernels/") + name);
    Ephemeris ephemeris;
    ephemeris.Load(std::make_shared<SpkSource>(path));
    int compared = 0;
    for (const JplTestVector& vector : JplTestVectors) {
      if (vector.target != Libration) {
        EXPECT_NEAR(NumberFor(ephemeris, vector), vector.value, JplTolerance) << vector.jed;
        ++compared;
      }
    }
    EXPECT_EQ(compared, 80);
  }
}

// A source with a warning behind one that ends at 100 s.
class Worse final : public StateSource {
public:
  explicit Worse(int body) : Line_("worse", body, {{3e10, 0.0, 0.0}, {0.0, 0.0, 0.0}}) {}
  const std::string& Name() const override { return this->Line_.Name(); }
  std::string Accuracy(int /*body*/) const override { return "7 km off"; }
  std::string Warning(int /*body*/) const override { return "worse, 7 km off"; }
  const std::vector<Coverage>& Coverages() const override { return this->Line_.Coverages(); }
  std::optional<Link> Find(int body, double tdb) const override {
    return this->Line_.Find(body, tdb);
  }

private:
  Straight Line_;
};

TEST(Fallbacks, EveryTimeIsLookedAt) {
  Ephemeris ephemeris;
  const State far{{3e10, 0.0, 0.0}, {0.0, 0.0, 0.0}}; // 100 s of light
  ephemeris.Load(std::make_shared<Straight>("good", 7, far, 0, 0.0, 1000.0));
  ephemeris.Load(std::make_shared<Worse>(7), Ephemeris::Priority::Last);
  ephemeris.Load(std::make_shared<Straight>("seer", 8, State{}));
  const auto warnings = [&](const std::vector<double>& times, Correction correction) {
    const FallbackScope scope;
    std::vector<Ephemeris::Result> results(times.size());
    ephemeris.FindMany({7, 8, "J2000", correction}, times.data(), times.size(), results.data());
    ephemeris.Explain({7, 8}, times[0]); // adds nothing
    return scope.Warnings(TimeScales());
  };
  EXPECT_TRUE(warnings({0.0, 500.0, 1000.0}, Correction::None).empty());
  // It starts inside and ends outside.
  const auto late = warnings({500.0, 900.0, 1100.0, 1200.0}, Correction::None);
  ASSERT_EQ(late.size(), 1u);
  EXPECT_EQ(late[0].find("worse, 7 km off (at 2 of 4 times: "), 0u) << late[0];
  EXPECT_NE(
      late[0].find(TimeLabel(1100.0, TimeScales()) + " to " + TimeLabel(1200.0, TimeScales())),
      std::string::npos)
      << late[0];
  // And the other way round: the last time is not counted.
  const auto early = warnings({1100.0, 900.0}, Correction::None);
  ASSERT_EQ(early.size(), 1u);
  EXPECT_NE(early[0].find("(at 1 of 2 times: " + TimeLabel(1100.0, TimeScales()) + ")"),
            std::string::npos)
      << early[0];
  // The light left before the good source begins.
  EXPECT_TRUE(warnings({50.0}, Correction::None).empty());
  for (const Correction correction : {Correction::LightTime, Correction::ConvergedStar}) {
    EXPECT_EQ(warnings({50.0}, correction), std::vector<std::string>{"worse, 7 km off"});
    EXPECT_TRUE(warnings({150.0, 900.0}, correction).empty());
  }
}

// As DE405 does behind kernels: it has an accuracy, and no warning of its own.
class Plain final : public StateSource {
public:
  explicit Plain(int body) : Line_("plain", body, {{1e10, 0.0, 0.0}, {0.0, 0.0, 0.0}}) {}
  const std::string& Name() const override { return this->Line_.Name(); }
  std::string Accuracy(int /*body*/) const override { return "10 m off"; }
  const std::vector<Coverage>& Coverages() const override { return this->Line_.Coverages(); }
  std::optional<Link> Find(int body, double tdb) const override {
    return this->Line_.Find(body, tdb);
  }

private:
  Straight Line_;
};

TEST(Fallbacks, WhatStandsInForAKernelIsNamed) {
  Ephemeris ephemeris;
  ephemeris.Load(std::make_shared<Plain>(7), Ephemeris::Priority::Last);
  const auto warnings = [&](double tdb) {
    const FallbackScope scope;
    Ephemeris::Result result;
    ephemeris.FindMany({7, 0}, &tdb, 1, &result);
    return scope.Warnings(TimeScales());
  };
  EXPECT_TRUE(warnings(1100.0).empty()); // nothing else was loaded for the body
  ephemeris.Load(std::make_shared<Straight>("kernel", 7, State{}, 0, 0.0, 1000.0));
  ephemeris.Load(std::make_shared<Straight>("other", 9, State{}, 0, 0.0, 1000.0));
  EXPECT_TRUE(warnings(900.0).empty());
  EXPECT_EQ(warnings(1100.0),
            std::vector<std::string>{"body URANUS BARYCENTER is taken from plain (10 m off), since "
                                     "kernel does not cover the time"});
  EXPECT_EQ(ephemeris.Explain({7, 0}, 1100.0)[0].warning, warnings(1100.0)[0]);
  ephemeris.Unload("kernel");
  EXPECT_TRUE(warnings(1100.0).empty());
}

TEST(Fallbacks, TheInnermostScopeCollects) {
  const FallbackScope outer;
  {
    const FallbackScope inner;
    FallbackScope::Note("inside");
    FallbackScope::Note("");
    EXPECT_EQ(FallbackScope::Noted(), std::vector<std::string>{"inside"});
  }
  EXPECT_TRUE(FallbackScope::Noted().empty());
}

std::string MessageOf(const Ephemeris& ephemeris, const Ephemeris::Query& query, double tdb) {
  try {
    ephemeris.Find(query, tdb);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Ephemeris, ErrorsStateTheSpans) {
  const State line{{1e9, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  Ephemeris ephemeris;
  ephemeris.Load(std::make_shared<Straight>("a", 7, line, 0, 0.0, 86400.0));
  ephemeris.Load(std::make_shared<Straight>("b", 7, line, 0, 43200.0, 2 * 86400.0));
  ephemeris.Load(std::make_shared<Straight>("c", 7, line, 0, 5 * 86400.0, 6 * 86400.0));
  const std::string outside = MessageOf(ephemeris, {7, 0}, 3 * 86400.0);
  // J2000 is 11:58:55.816 UTC; the spans of a and b are joined.
  EXPECT_NE(outside.find("accepted: 2000-01-01T11:58:55.816 UTC to 2000-01-03T11:58:55.816 UTC, "
                         "2000-01-06T11:58:55.816 UTC to 2000-01-07T11:58:55.816 UTC"),
            std::string::npos)
      << outside;
  const std::string unknown = MessageOf(ephemeris, {8, 0}, 0.0);
  EXPECT_NE(unknown.find("NEPTUNE BARYCENTER (8)"), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("accepted: URANUS BARYCENTER"), std::string::npos) << unknown;
  EXPECT_NE(MessageOf(ephemeris, {7, 0}, std::nan("")).find("finite"), std::string::npos);
  EXPECT_THROW(ephemeris.Find({7, 0, "NO_FRAME"}, 0.0), Error);
  EXPECT_THROW(ephemeris.Names().IdOf("nowhere"), Error);
  EXPECT_EQ(ephemeris.Names().IdOf("mars_barycenter"), 4);
  EXPECT_EQ(ephemeris.Names().IdOf("-82"), -82);
}

TEST(Ephemeris, CirclesOfCentresAreRejected) {
  const State line{{1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  Ephemeris ephemeris;
  ephemeris.Load(std::make_shared<Straight>("a", 71, line, 72));
  ephemeris.Load(std::make_shared<Straight>("b", 72, line, 71));
  EXPECT_NE(MessageOf(ephemeris, {71, 0}, 0.0).find("circle"), std::string::npos);
  // Where the ways meet before, there is no circle.
  EXPECT_EQ(ephemeris.Find({71, 72}, 0.0).state.position.x(), 1.0);
}

TEST(Ephemeris, ReadsRealSegmentsOfEveryType) {
  struct Kernel {
    const char* name;
    int type;
  };
  for (const Kernel& kernel :
       {Kernel{"130212AP_SK_13043_13058.bsp", 1}, Kernel{"mar022-1.bsp", 3},
        Kernel{"de405s_bigendian.bsp", 2}, Kernel{"earthstns_itrf93_050714.bsp", 8}}) {
    DSPACE_REAL_DATA(path, std::string("ephemeris/spice_test_kernels/") + kernel.name);
    const SpkFile file(path);
    bool found = false;
    for (std::size_t i = 0; i < file.Segments().size(); ++i) {
      const SpkFile::Segment& segment = file.Segments()[i];
      found = found || segment.type == kernel.type;
      const double span = segment.end - segment.begin;
      // Velocities are the derivatives of positions, also over the joints of records. Those of
      // mar022-1 differ from them by 0.8e-3 in the file itself.
      for (int k = 1; k < 200; ++k) {
        const double tdb = segment.begin + span * k / 200.0;
        const double h = std::min(30.0, span / 1000.0);
        const Eigen::Vector3d slope =
            (file.At(i, tdb + h).position - file.At(i, tdb - h).position) / (2.0 * h);
        const State state = file.At(i, tdb);
        ASSERT_LT((state.velocity - slope).norm(),
                  2e-3 + (segment.type == 3 ? 2e-3 : 1e-4) * state.velocity.norm())
            << kernel.name << " " << segment.name << " at " << tdb;
      }
      EXPECT_NO_THROW(file.At(i, segment.begin));
      EXPECT_NO_THROW(file.At(i, segment.end));
    }
    EXPECT_TRUE(found) << kernel.name;
  }
  // spice_checks.json has DSS-14's place in ITRF93, which is that at J2000; plates move 2 cm a
  // year.
  DSPACE_REAL_DATA(path, "ephemeris/spice_test_kernels/earthstns_itrf93_050714.bsp");
  const SpkSource stations(path);
  const auto link = stations.Find(399014, 0.0);
  ASSERT_TRUE(link);
  EXPECT_EQ(link->center, 399);
  EXPECT_EQ(link->frame, 13000); // ITRF93
  EXPECT_LT((link->state.position -
             1e3 * Eigen::Vector3d(-2353.6213656676991, -4641.3414911499403, 3677.0523293197439))
                .norm(),
            1e-6);
  EXPECT_NEAR(link->state.velocity.norm() * 365.25 * 86400.0, 0.0195, 1e-4);
}

} // namespace
