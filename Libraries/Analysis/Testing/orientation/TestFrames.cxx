// Reference frames: published values first, then ERFA, then closed forms.
#include <random>

#include <erfa.h>

#include <Eigen/Geometry>

#include <MissingPackage.h>
#include <TestData.h>

#include <dspace/Error.h>
#include <dspace/ephemeris/Ephemeris.h>
#include <dspace/ephemeris/Fallbacks.h>
#include <dspace/kernels/LeapSecondKernel.h>
#include <dspace/orientation/AxisTurns.h>
#include <dspace/orientation/BodyConstants.h>
#include <dspace/orientation/EarthRotation.h>
#include <dspace/orientation/Frames.h>
#include <dspace/orientation/InertialFrames.h>
#include <dspace/orientation/Site.h>
#include <dspace/time/UtcText.h>

namespace {

using namespace dspace;

constexpr double Degree = M_PI / 180.0;
constexpr double Arcsecond = Degree / 3600.0;
const std::string Kernels = "spice_test_kernels/";

// Frames from files of the folder "ephemeris", by their endings.
FrameSources Load(const std::string& folder, const std::vector<std::string>& names) {
  FrameSources sources;
  auto pool = std::make_shared<KernelPool>();
  for (const std::string& name : names) {
    const std::string path = folder + "/" + name;
    if (name.substr(name.size() - 4) == ".bpc") {
      sources.orientations.push_back(std::make_shared<BinaryPck>(path));
    } else if (name.substr(name.size() - 3) == ".bc") {
      sources.attitudes.push_back(std::make_shared<CkFile>(path));
    } else {
      pool->Add(TextKernel::Read(path));
    }
  }
  if (HasLeapSeconds(*pool)) {
    sources.scales = TimeScalesOf(*pool);
  }
  sources.pool = pool;
  return sources;
}

FrameSources Text(const std::string& data) {
  auto pool = std::make_shared<KernelPool>();
  pool->Add(TextKernel::Parse("\\begindata\n" + data, "k.tf"));
  FrameSources sources;
  sources.pool = pool;
  return sources;
}

double AngleBetween(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  const Eigen::Matrix3d d = a * b.transpose();
  const Eigen::Vector3d v(d(1, 2) - d(2, 1), d(2, 0) - d(0, 2), d(0, 1) - d(1, 0));
  return std::atan2(v.norm(), d.trace() - 1.0);
}

std::string ErrorOf(const std::function<void()>& run, Error::Kind kind) {
  try {
    run();
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), kind) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

// "FRAME_A = 1400000 ..." of a fixed frame.
std::string Fixed(const std::string& name, int id, const std::string& relative) {
  const std::string number = std::to_string(id);
  return "FRAME_" + name + " = " + number + "\nFRAME_" + number + "_NAME = '" + name + "'\nFRAME_" +
         number + "_CLASS = 4\nFRAME_" + number + "_CLASS_ID = " + number + "\nFRAME_" + number +
         "_CENTER = 399\nTKFRAME_" + number + "_SPEC = 'ANGLES'\nTKFRAME_" + number +
         "_RELATIVE = '" + relative + "'\nTKFRAME_" + number + "_ANGLES = ( 30 0 0 )\nTKFRAME_" +
         number + "_AXES = ( 3 1 3 )\nTKFRAME_" + number + "_UNITS = 'DEGREES'\n";
}

TEST(Frames, InertialFrames) {
  // Lieske's precession from J2000 to B1950, as SPICE and the Astronomical Almanac print it.
  Eigen::Matrix3d b1950;
  b1950 << 0.99992570795236291, 0.011178938126427691, 0.0048590038414544293, -0.011178938137770135,
      0.9999375133499887, -2.715792625851078e-05, -0.0048590038153592712, -2.7162594714247048e-05,
      0.9999881946023742;
  const Frames frames;
  EXPECT_LT((frames.Rotation("J2000", "B1950", 0.0) - b1950).cwiseAbs().maxCoeff(), 1e-15);
  // The obliquity of the IAU (1976) by ERFA.
  const double obliquity = eraObl80(2451545.0, 0.0);
  EXPECT_LT(AngleBetween(frames.Rotation("J2000", "eclipj2000", 1e9), AxisTurn(obliquity, 1)),
            1e-15);
  // The galactic pole and centre of 1958, in B1950: 12h49m, 27.4 degrees; 265.61, -28.92 degrees.
  const Eigen::Matrix3d galactic = frames.Rotation("FK4", "GALACTIC", 0.0);
  EXPECT_NEAR(std::atan2(-galactic(2, 1), -galactic(2, 0)) / Degree, 192.25 - 180.0, 1e-12);
  EXPECT_NEAR(std::asin(galactic(2, 2)) / Degree, 27.4, 1e-12);
  EXPECT_NEAR(std::asin(galactic(0, 2)) / Degree, -28.9167903484, 1e-9);
  // Hipparcos's matrix (ERFA, eraIcrs2g) follows the same axes through the equinox of FK5.
  double l = 0.0, b = 0.0;
  eraIcrs2g(1.0, 0.5, &l, &b);
  const Eigen::Vector3d v =
      frames.Rotation("J2000", "GALACTIC", 0.0) *
      Eigen::Vector3d(std::cos(0.5) * std::cos(1.0), std::cos(0.5) * std::sin(1.0), std::sin(0.5));
  EXPECT_LT(std::abs(std::asin(v.z()) - b), 2.0 * Arcsecond);
  // Small turns about the pole of B1950; MARSIAU's pole of 1989: 317.681, 52.886 degrees.
  EXPECT_NEAR(AngleBetween(frames.Rotation("B1950", "DE-118", 0.0), Eigen::Matrix3d::Identity()),
              0.53155 * Arcsecond, 1e-12);
  const Eigen::Vector3d mars = frames.Rotation("MARSIAU", "J2000", 0.0).col(2);
  EXPECT_NEAR(std::atan2(mars.y(), mars.x()) / Degree + 360.0, 317.681, 1e-3);
  EXPECT_NEAR(std::asin(mars.z()) / Degree, 52.886, 1e-3);
  for (int id = 1; id <= InertialFrameCount; ++id) {
    EXPECT_TRUE(frames.IsInertial(id));
    EXPECT_EQ(frames.FrameId(InertialFrameName(id)), id);
    const Eigen::Matrix3d& m = InertialRotation(id);
    EXPECT_LT((m * m.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_GT(m.determinant(), 0.0);
  }
}

// Recorded from CSPICE: IAU_EARTH with pck00010. spice_checks.json calls the position one in J2000,
// but SpiceyPy's test multiplies the vector from the left (numpy.dot(epos, rotate)), which applies
// the transpose. The matrix itself is that of the tests of SPICE.jl, rounded to eight decimals.
TEST(Frames, IauEarthAsSpiceHasIt) {
  DSPACE_REAL_DATA(folder, "ephemeris");
  const Frames frames(Load(folder, {"naif0012.tls", Kernels + "pck00010.tpc"}));
  const Site site = {118.25, 34.05, 0.0, LatitudeKind::Geodetic};
  const double tdb = TdbFromText("2005-01-01T00:00:00", frames.Sources().scales);
  const Eigen::Vector3d p = frames.Rotation("J2000", "IAU_EARTH", tdb) *
                            AxesAt(site, BodyRadii(frames.Pool(), 399)).position;
  EXPECT_LT((p / 1000.0 - Eigen::Vector3d(5042.1309421, 1603.52962986, 3549.82398086)).norm(),
            2e-8);
  Eigen::Matrix3d expected;
  expected << -0.18437048, -0.98285670, 0.00048614, 0.98285681, -0.18437050, -2.71973868e-07,
      8.98973426e-05, 0.00047776, 0.99999988;
  EXPECT_LT((frames.Rotation("IAU_EARTH", "J2000", tdb) - expected).cwiseAbs().maxCoeff(), 6e-9);
}

// Recorded by skyfield from CSPICE (sky_checks.json).
TEST(Frames, LunarRotationsAsSpiceHasThem) {
  DSPACE_REAL_DATA(folder, "ephemeris");
  const Frames frames(Load(folder, {"moon_080317.tf", "moon_pa_de421_1900-2050.bpc"}));
  const Eigen::RowVector3d pa[] = {{0.9994150897380264, 0.032310270603926675, 0.011203785852719871},
                                   {0.7840447406961362, 0.5582359944893811, 0.2713787372716964}};
  EXPECT_LT((frames.Rotation("J2000", "MOON_PA", -11150 * 86400.0).row(0) - pa[0]).norm(), 1e-9);
  EXPECT_LT((frames.Rotation("J2000", "MOON_PA", 0.0).row(0) - pa[1]).norm(), 1e-9);
  const Eigen::RowVector3d me(0.9994268420493244, 0.03186286343877705, 0.011434392191818011);
  EXPECT_LT((frames.Rotation("J2000", "MOON_ME", -11150 * 86400.0).row(0) - me).norm(), 1e-9);
  const std::vector<Frames::Step> steps = frames.Explain("J2000", "MOON_ME", 0.0);
  ASSERT_EQ(steps.size(), 3u); // MOON_PA_DE421, MOON_ME_DE421, MOON_ME
  EXPECT_NE(steps[0].source.find("moon_pa_de421"), std::string::npos);
  // Fixed offsets need no binary PCK.
  const Frames text(Load(folder, {"moon_080317.tf"}));
  EXPECT_NEAR(AngleBetween(text.Rotation("MOON_PA", "MOON_ME", 1e10), Eigen::Matrix3d::Identity()),
              std::hypot(67.92, 78.56, 0.30) * Arcsecond, 1e-8);
  const std::string what =
      ErrorOf([&] { text.Rotation("J2000", "MOON_ME", 0.0); }, Error::Kind::NotFound);
  EXPECT_NE(what.find("binary PCK with frame class 31006"), std::string::npos) << what;
  // After the kernel and DE405 the IAU's elements stand in, and a warning says so.
  const FallbackScope scope;
  const Eigen::Matrix3d late = frames.Rotation("J2000", "MOON_ME", 1e10);
  EXPECT_LT(AngleBetween(late, frames.Rotation("J2000", "IAU_MOON", 1e10)), 1e-14);
  const std::vector<std::string> found = scope.Warnings(TimeScales());
  ASSERT_EQ(found.size(), 1u);
  for (const char* part : {"'MOON_PA_DE421'", "IAU_MOON", "155 m", "1900", "2050"}) {
    EXPECT_NE(found[0].find(part), std::string::npos) << part << "\n" << found[0];
  }
}

// DE405's libration with its fitted turn to the mean Earth axes, against DE421's.
TEST(Frames, Moon405AgainstDe421) {
  DSPACE_REAL_DATA(folder, "ephemeris");
  if (!De405Source::IsInstalled()) {
    DSPACE_MISSING_PACKAGE("casacore-data-jpl-de405");
  }
  const Frames truth(Load(folder, {"moon_080317.tf", "moon_pa_de421_1900-2050.bpc"}));
  FrameSources sources;
  sources.de405 = std::make_shared<De405Source>();
  const Frames frames(sources);
  std::mt19937_64 random(405);
  std::uniform_real_distribution<double> times(-1262000000.0, 1577000000.0); // 1960 to 2049
  double worst = 0.0, worstPa = 0.0, worstIau = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double tdb = times(random);
    const Eigen::Matrix3d me = truth.Rotation("J2000", "MOON_ME", tdb);
    worst = std::max(worst, AngleBetween(frames.Rotation("J2000", "MOON_ME", tdb), me));
    worstPa = std::max(worstPa, AngleBetween(frames.Rotation("J2000", "MOON_PA", tdb),
                                             truth.Rotation("J2000", "MOON_PA", tdb)));
    worstIau = std::max(worstIau, AngleBetween(frames.Rotation("J2000", "IAU_MOON", tdb), me));
  }
  std::printf("MOON_ME of DE405 %.3f\", MOON_PA of DE405 %.3f\", IAU_MOON %.3f\" (%.0f m)\n",
              worst / Arcsecond, worstPa / Arcsecond, worstIau / Arcsecond, worstIau * 1737400.0);
  EXPECT_LT(worst, 0.28 * Arcsecond);
  EXPECT_GT(worst, 0.1 * Arcsecond); // else this is not DE405
  EXPECT_LT(worstPa, 5.5 * Arcsecond);
  EXPECT_LT(worstIau * 1737400.0, 155.0);
  // Its rate is the derivative.
  const double h = 10.0;
  const StateTurn turn = frames.Turn("J2000", "MOON_ME", 1e8);
  const Eigen::Matrix3d rate = (frames.Rotation("J2000", "MOON_ME", 1e8 + h) -
                                frames.Rotation("J2000", "MOON_ME", 1e8 - h)) /
                               (2.0 * h);
  EXPECT_LT((turn.rate - rate).cwiseAbs().maxCoeff(), 1e-13);    // of 2.7e-6
  EXPECT_THROW(frames.Rotation("J2000", "MOON_PA", 3e9), Error); // 2095
  EXPECT_NE(frames.Explain("J2000", "MOON_ME", 3e9)[0].source.find("IAU_MOON"), std::string::npos);
}

// Recorded from CSPICE (spice_checks.json): the first pointing of Cassini's CK, and its rate.
TEST(Frames, CassinisAttitudeAsSpiceHasIt) {
  DSPACE_REAL_DATA(folder, "ephemeris");
  const Frames frames(Load(folder, {"naif0012.tls", Kernels + "13056_13057ra.bc",
                                    Kernels + "cas00167.tsc", Kernels + "cas_v40.tf"}));
  const ClockKernel clock(frames.Pool(), -82, frames.Sources().scales);
  const double tdb = clock.TdbOf(267832537952.0);
  const StateTurn turn = frames.Turn("J2000", "CASSINI_SC_COORD", tdb);
  Eigen::Matrix3d expected;
  expected << 0.5064665782997639365, -0.75794210739897316387, 0.41111478554891744963,
      -0.42372128242505308071, 0.19647683351734512858, 0.88422685364733510927,
      -0.7509672961490383436, -0.6220294331642198804, -0.22164725216433822652;
  // TDB as a double is good to 6e-8 s, in which Cassini turns by 2e-10 rad.
  EXPECT_LT((turn.rotation - expected).cwiseAbs().maxCoeff(), 4e-10);
  const Eigen::Vector3d rate(-0.00231258422150853885, -0.00190333614370416515,
                             -0.00069657429072504716);
  const Eigen::Matrix3d skew = turn.rotation.transpose() * turn.rate; // -[rate]x
  EXPECT_LT((Eigen::Vector3d(skew(1, 2), skew(2, 0), skew(0, 1)) - rate).norm(), 1e-11);

  // The camera is fixed to the spacecraft: cas_v40.tf says so without a CK.
  const Frames text(Load(folder, {Kernels + "cas_v40.tf"}));
  const Eigen::Matrix3d nac = text.Rotation("CASSINI_SC_COORD", "CASSINI_ISS_NAC", 0.0);
  EXPECT_LT((frames.Rotation("J2000", "CASSINI_ISS_NAC", tdb) - nac * turn.rotation)
                .cwiseAbs()
                .maxCoeff(),
            1e-15);
  EXPECT_NEAR(nac(2, 1), -1.0, 1e-4); // it looks along -Y of the spacecraft

  const std::string outside =
      ErrorOf([&] { frames.Rotation("J2000", "CASSINI_SC_COORD", tdb - 86400.0); },
              Error::Kind::InvalidArgument);
  EXPECT_NE(outside.find("the CKs cover 2013-02-2"), std::string::npos) << outside;
  const std::string noClock =
      ErrorOf([&] { text.Rotation("J2000", "CASSINI_SC_COORD", tdb); }, Error::Kind::NotFound);
  EXPECT_NE(noClock.find("SCLK kernel of clock -82"), std::string::npos) << noClock;
  const Frames noCk(Load(folder, {Kernels + "cas00167.tsc", Kernels + "cas_v40.tf"}));
  const std::string none =
      ErrorOf([&] { noCk.Rotation("J2000", "CASSINI_ISS_NAC", tdb); }, Error::Kind::NotFound);
  EXPECT_NE(none.find("no loaded CK has the attitude of structure -82000"), std::string::npos)
      << none;
}

// ERFA against the Earth's binary PCK and the IAU's elements.
TEST(Frames, EarthByErfaBinaryPckAndElements) {
  DSPACE_REAL_DATA(folder, "ephemeris");
  const Frames binary(Load(folder, {"naif0012.tls", Kernels + "earth_031228_231229_predict.bpc"}));
  const Frames plain;
  double pole = 0.0, whole = 0.0, iau = 0.0;
  for (double tdb = 1.0; tdb < 1.26e8;
       tdb += 1.1e6) { // 2000 to 2003: after that its UT1 is a prediction
    const Eigen::Matrix3d a = binary.Rotation("J2000", "ITRF93", tdb);
    const Eigen::Matrix3d b = plain.Rotation("J2000", "ITRF93", tdb);
    whole = std::max(whole, AngleBetween(a, b));
    pole = std::max(pole, std::acos(std::min(1.0, a.row(2).dot(b.row(2)))));
  }
  for (double tdb = -1.26e9; tdb < 1.57e9; tdb += 3.3e6) { // 1960 to 2049
    iau = std::max(iau, AngleBetween(plain.Rotation("J2000", "IAU_EARTH", tdb),
                                     plain.Rotation("J2000", "ITRF93", tdb)));
  }
  std::printf("ERFA against the predicted PCK: pole %.3f\", whole %.3f\"; IAU_EARTH %.4f deg\n",
              pole / Arcsecond, whole / Arcsecond, iau / Degree);
  EXPECT_LT(pole, 0.6 * Arcsecond); // polar motion
  EXPECT_LT(whole, 14.0 * Arcsecond + 0.6 * Arcsecond);
  EXPECT_LT(iau, 0.2 * Degree);
  // ERFA itself, with the same UT1 given to both.
  TimeScales scales;
  scales.SetUt1({{53000.0, -0.39}});
  FrameSources sources;
  sources.scales = scales;
  const Frames withUt1(sources);
  const double tdb = 1.3e8;
  const double ut1 = scales.Convert(tdb, TimeScale::Tdb, TimeScale::Ut1);
  double rows[3][3];
  eraC2t06a(2400000.5, 51544.5 + scales.TtFromTdb(tdb) / 86400.0, 2400000.5,
            51544.5 + ut1 / 86400.0, 0.0, 0.0, rows);
  const StateTurn turn = withUt1.Turn("J2000", "ITRF93", tdb);
  for (int i = 0; i < 9; ++i) {
    EXPECT_NEAR(turn.rotation(i / 3, i % 3), rows[i / 3][i % 3],
                1e-10); // UT1 as one double: 1e-11 days
  }
  const double h = 1.0;
  const Eigen::Matrix3d rate = (withUt1.Rotation("J2000", "ITRF93", tdb + h) -
                                withUt1.Rotation("J2000", "ITRF93", tdb - h)) /
                               (2.0 * h);
  EXPECT_LT((turn.rate - rate).cwiseAbs().maxCoeff(), 3e-11);
  EXPECT_NE(plain.Explain("J2000", "ITRF93", tdb)[0].accuracy.find("14 arcsec"), std::string::npos);
  EXPECT_NE(withUt1.Explain("J2000", "ITRF93", tdb)[0].accuracy.find("0.6 arcsec"),
            std::string::npos);
  EXPECT_THROW(plain.Rotation("J2000", "ITRF93", -1.5e9), Error); // 1952: no UTC
}

// Outside of what a binary PCK covers, ERFA's Earth stands in for it, and a warning says so.
TEST(Frames, OutsideOfABinaryPckIsSaid) {
  DSPACE_REAL_DATA(folder, "ephemeris");
  const FrameSources sources =
      Load(folder, {"naif0012.tls", Kernels + "earth_031228_231229_predict.bpc"});
  const Frames binary(sources);
  const Frames plain;
  const double inside = TdbFromText("2010-01-01", sources.scales);
  const double outside = TdbFromText("2026-11-01", sources.scales);
  const auto warnings = [&](const Frames& frames, const std::vector<double>& times) {
    const FallbackScope scope;
    for (const double tdb : times) {
      FallbackScope::Begin(tdb);
      frames.Turn("J2000", "ITRF93", tdb);
    }
    return scope.Warnings(sources.scales);
  };
  EXPECT_TRUE(warnings(binary, {inside, inside + 86400.0}).empty());
  EXPECT_TRUE(warnings(plain, {inside, outside}).empty()); // there ERFA stands in for nothing
  const auto found = warnings(binary, {inside, outside});
  ASSERT_EQ(found.size(), 1u);
  for (const char* part :
       {"'ITRF93'", "ERFA", "14 arcsec", "binary PCKs cover", "at 1 of 2 times: 2026-11-01"}) {
    EXPECT_NE(found[0].find(part), std::string::npos) << part << "\n" << found[0];
  }
}

// The IAU's report (Archinal et al. 2018, table 1) by hand at epochs where its terms are simple.
TEST(Frames, RotationElementsOfTheReport) {
  const Frames frames;
  const auto pole = [&](const char* frame, double tdb) {
    const Eigen::Vector3d z = frames.Rotation(frame, "J2000", tdb).col(2);
    return Eigen::Vector2d(std::atan2(z.y(), z.x()) / Degree + (z.y() < 0.0 ? 360.0 : 0.0),
                           std::asin(z.z()) / Degree);
  };
  EXPECT_LT((pole("IAU_SUN", 1e9) - Eigen::Vector2d(286.13, 63.87)).norm(), 1e-11);
  EXPECT_LT((pole("IAU_SATURN", 0.0) - Eigen::Vector2d(40.589, 83.537)).norm(), 1e-11);
  const double century = 36525.0 * 86400.0;
  EXPECT_LT((pole("IAU_SATURN", century) - Eigen::Vector2d(40.553, 83.533)).norm(), 1e-11);
  // Neptune: 299.36 + 0.70 sin N, 43.46 - 0.51 cos N, N = 357.85 + 52.316 T.
  const double n = (357.85 + 52.316) * Degree;
  EXPECT_LT((pole("IAU_NEPTUNE", century) -
             Eigen::Vector2d(299.36 + 0.70 * std::sin(n), 43.46 - 0.51 * std::cos(n)))
                .norm(),
            1e-11);
  // The prime meridian: W from the node of the body's equator, here the Sun's 84.176 + 14.1844 d.
  const Eigen::Matrix3d sun = frames.Rotation("J2000", "IAU_SUN", 10.0 * 86400.0);
  const Eigen::Vector3d node =
      sun * Eigen::Vector3d(-std::sin(286.13 * Degree), std::cos(286.13 * Degree), 0.0);
  EXPECT_NEAR(std::atan2(-node.y(), node.x()) / Degree, std::remainder(84.176 + 141.844, 360.0),
              1e-11);
  // Every body's rate is the derivative of its rotation, and its rotation is one.
  int bodies = 0;
  for (const std::string& name : frames.Table().Names()) {
    if (name.compare(0, 4, "IAU_") != 0 ||
        !HasBodyRotation(frames.Pool(), frames.Table().Get(name).classId)) {
      continue;
    }
    ++bodies;
    const double tdb = 3.3e8, h = 20.0;
    const StateTurn turn = frames.Turn("J2000", name, tdb);
    const Eigen::Matrix3d rate =
        (frames.Rotation("J2000", name, tdb + h) - frames.Rotation("J2000", name, tdb - h)) /
        (2.0 * h);
    const double scale = turn.rate.norm() / std::sqrt(2.0); // its angular velocity
    EXPECT_LT((turn.rate - rate).cwiseAbs().maxCoeff(), 0.2 * h * h * scale * scale * scale + 3e-12)
        << name;
    EXPECT_LT((turn.rotation * turn.rotation.transpose() - Eigen::Matrix3d::Identity())
                  .cwiseAbs()
                  .maxCoeff(),
              1e-14)
        << name;
  }
  EXPECT_GE(bodies, 70);
}

// The table that ships is the kernel: every number of pck00011.
TEST(Frames, ShippedConstantsAreTheKernels) {
  DSPACE_REAL_DATA(folder, "ephemeris");
  int compared = 0;
  for (const char* name : {"pck00011.tpc", "gm_de440.tpc"}) {
    const TextKernel kernel = TextKernel::Read(folder + "/" + name);
    for (const KernelAssignment& assignment : kernel.Assignments()) {
      ASSERT_TRUE(StandardConstants().Has(assignment.name)) << assignment.name;
      EXPECT_EQ(StandardConstants().Numbers(assignment.name), assignment.numbers)
          << assignment.name;
      ++compared;
    }
  }
  EXPECT_GT(compared, 500);
  EXPECT_EQ(BodyRadii(KernelPool(), 499), Eigen::Vector3d(3396190.0, 3396190.0, 3376200.0));
  EXPECT_NEAR(*BodyGm(KernelPool(), 399), 3.98600435507e14, 1e6);
  EXPECT_FALSE(BodyGm(KernelPool(), -82));
  EXPECT_THROW(BodyRadii(KernelPool(), -82), Error);
}

TEST(Frames, FixedFramesOfAllForms) {
  // The three forms of one turn by 30 degrees about z: components of the frame to those of J2000.
  const double c = std::cos(30.0 * Degree), s = 0.5;
  const std::string matrix =
      Fixed("B", 1400001, "J2000") +
      "TKFRAME_1400001_SPEC = 'MATRIX'\nTKFRAME_1400001_MATRIX = ( 0.866025403784439 -0.5 0 "
      "0.5 0.866025403784439 0 0 0 1 )\n";
  const std::string quaternion = Fixed("C", 1400002, "J2000") +
                                 "TKFRAME_1400002_SPEC = 'QUATERNION'\nTKFRAME_1400002_Q = ( " +
                                 std::to_string(std::cos(15.0 * Degree)) + " 0 0 " +
                                 std::to_string(-std::sin(15.0 * Degree)) + " )\n";
  const Frames frames(
      Text(Fixed("A", 1400000, "J2000") + matrix + quaternion + Fixed("D", 1400003, "A")));
  for (const char* name : {"A", "B"}) {
    EXPECT_LT((frames.Rotation(name, "J2000", 0.0) * Eigen::Vector3d::UnitX() -
               Eigen::Vector3d(c, -s, 0.0))
                  .norm(),
              1e-14)
        << name;
  }
  EXPECT_LT(
      (frames.Rotation("C", "J2000", 0.0) * Eigen::Vector3d::UnitX() - Eigen::Vector3d(c, -s, 0.0))
          .norm(),
      1e-5);
  EXPECT_LT((frames.Rotation("d", "J2000", 0.0) * Eigen::Vector3d::UnitX() -
             Eigen::Vector3d(0.5, -c, 0.0))
                .norm(),
            1e-14);
  EXPECT_TRUE(frames.IsInertial(1400003));
  EXPECT_EQ(frames.Center(1400000), 399);
  EXPECT_EQ(frames.Table().Loaded().size(), 4u);
}

TEST(Frames, RejectsLoopsUnknownFramesAndDamagedKernels) {
  const std::string loop =
      ErrorOf([] { Frames(Text(Fixed("A", 1400000, "B") + Fixed("B", 1400001, "A"))); },
              Error::Kind::InvalidArgument);
  EXPECT_NE(loop.find("A -> B -> A"), std::string::npos) << loop;
  ErrorOf([] { Frames(Text(Fixed("A", 1400000, "A"))); }, Error::Kind::InvalidArgument);
  const Frames frames;
  const std::string unknown =
      ErrorOf([&] { frames.Rotation("J2000", "IAU_MONO", 0.0); }, Error::Kind::NotFound);
  EXPECT_NE(unknown.find("'IAU_MOON'"), std::string::npos) << unknown;
  ErrorOf([&] { frames.Turn(1, 987654, 0.0); }, Error::Kind::NotFound);
  ErrorOf([&] { frames.Rotation("J2000", "IAU_MOON", std::nan("")); },
          Error::Kind::InvalidArgument);
  ErrorOf([&] { frames.Rotation("J2000", "J2000", std::nan("")); }, Error::Kind::InvalidArgument);
  ErrorOf([&] { frames.Rotation("J2000", "IAU_HIMALIA", 0.0); },
          Error::Kind::NotFound); // no elements in pck00011
  const Frames unfinished(Text(Fixed("A", 1400000, "ECLIPJ200")));
  const std::string relative =
      ErrorOf([&] { unfinished.Rotation("A", "J2000", 0.0); }, Error::Kind::NotFound);
  EXPECT_NE(relative.find("'ECLIPJ2000'"), std::string::npos) << relative;
  const std::string a = Fixed("A", 1400000, "J2000");
  for (const char* bad :
       {"TKFRAME_1400000_UNITS = 'GONS'", "TKFRAME_1400000_AXES = ( 3 4 1 )",
        "TKFRAME_1400000_ANGLES = ( 1 2 )", "TKFRAME_1400000_SPEC = 'OTHER'",
        "TKFRAME_1400000_SPEC = 'MATRIX' TKFRAME_1400000_MATRIX = ( 1 0 0 0 1 0 0 0 -1 )",
        "TKFRAME_1400000_SPEC = 'MATRIX' TKFRAME_1400000_MATRIX = ( 1 0 0 0 1 0 0 0.1 1 )",
        "FRAME_1400000_CLASS = 7",
        "TKFRAME_1400000_SPEC = 'QUATERNION' TKFRAME_1400000_Q = ( 1 1 0 0 )",
        "FRAME_1400000_CLASS_ID = 1.5"}) {
    ErrorOf([&] { Frames(Text(a + bad)); }, Error::Kind::Corrupt);
  }
  // A frame relative to one of a kernel that is not loaded yet, and a centre without a known name.
  const Frames later(Text(Fixed("A", 1400000, "B") + "FRAME_1400000_CENTER = 'NOWHERE'"));
  ErrorOf([&] { later.Rotation("A", "J2000", 0.0); }, Error::Kind::NotFound);
  ErrorOf([&] { later.Center(1400000); }, Error::Kind::NotFound);
  const Frames named(
      Text(Fixed("A", 1400000, "J2000") +
           "FRAME_1400000_CENTER = 'CRAFT' NAIF_BODY_NAME = 'CRAFT' NAIF_BODY_CODE = -999"));
  EXPECT_EQ(named.Center(1400000), -999);
  const Frames dynamic(Text(a + "FRAME_1400000_CLASS = 5"));
  const std::string what =
      ErrorOf([&] { dynamic.Rotation("A", "J2000", 0.0); }, Error::Kind::Unsupported);
  EXPECT_NE(what.find("dynamic"), std::string::npos) << what;
  // Of class 1 are the built-in frames alone: their rotations are a table.
  const Frames inertial(Text(a + "FRAME_1400000_CLASS = 1"));
  const std::string which =
      ErrorOf([&] { inertial.Rotation("A", "J2000", 0.0); }, Error::Kind::Unsupported);
  EXPECT_NE(which.find("accepted: the inertial frames 1 to 21"), std::string::npos) << which;
  ErrorOf(
      [] {
        Frames(Text("BODY301_PM = 'x' BODY301_POLE_RA = 1 BODY301_POLE_DEC = 2"))
            .Rotation("J2000", "IAU_MOON", 0.0);
      },
      Error::Kind::Corrupt);
  ErrorOf([] { Frames(Text("BODY301_PM = ( 1 2 )")).Rotation("J2000", "IAU_MOON", 0.0); },
          Error::Kind::NotFound);
}

TEST(Site, AxesByHand) {
  const Eigen::Vector3d radii(6378137.0, 6378137.0, 6356752.314245);
  // ERFA's geodetic to geocentric on WGS 84.
  double xyz[3];
  ASSERT_EQ(eraGd2gc(1, -70.4 * Degree, -24.6 * Degree, 2635.0, xyz), 0);
  const LocalAxes geodetic = AxesAt({-70.4, -24.6, 2635.0, LatitudeKind::Geodetic}, radii);
  EXPECT_LT((geodetic.position - Eigen::Vector3d(xyz[0], xyz[1], xyz[2])).norm(), 1e-6);
  EXPECT_NEAR(
      GeodeticLatitude(
          ToLongitudeLatitude(AxesAt({-70.4, -24.6, 0.0, LatitudeKind::Geodetic}, radii).position)
              .latitude_deg,
          radii),
      -24.6, 1e-12);
  const LocalAxes centric =
      AxesAt({90.0, 45.0, 100.0, LatitudeKind::Planetocentric}, Eigen::Vector3d::Constant(1000.0));
  EXPECT_LT((centric.position - Eigen::Vector3d(0.0, 1100.0, 1100.0) / std::sqrt(2.0)).norm(),
            1e-9);
  EXPECT_LT((centric.toLocal.row(0).transpose() - Eigen::Vector3d(-1.0, 0.0, 0.0)).norm(), 1e-15);
  EXPECT_LT((centric.toLocal.row(1).transpose() - Eigen::Vector3d(0.0, -1.0, 1.0) / std::sqrt(2.0))
                .norm(),
            1e-15);
  const AzimuthElevation west = ToAzimuthElevation({-1.0, 0.0, 1.0});
  EXPECT_NEAR(west.azimuth_deg, 270.0, 1e-12);
  EXPECT_NEAR(west.elevation_deg, 45.0, 1e-12);
  EXPECT_THROW(AxesAt({0.0, 91.0, 0.0, LatitudeKind::Planetocentric}, radii), Error);
  EXPECT_THROW(AxesAt({std::nan(""), 0.0, 0.0, LatitudeKind::Planetocentric}, radii), Error);
  EXPECT_THROW(AxesAt({0.0, 0.0, 0.0, LatitudeKind::Geodetic}, Eigen::Vector3d(13.0, 11.4, 9.1)),
               Error);
}

} // namespace
