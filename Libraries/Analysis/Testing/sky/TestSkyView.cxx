// Bodies over a site, and sub-points: SPICE's and Horizons' recorded values.
#include <MissingPackage.h>
#include <TestData.h>

#include <dspace/Error.h>
#include <dspace/ephemeris/SpkSource.h>
#include <dspace/kernels/LeapSecondKernel.h>
#include <dspace/orientation/BodyConstants.h>
#include <dspace/sky/SkyView.h>
#include <dspace/sky/SubPoints.h>
#include <dspace/time/UtcText.h>

namespace {

using namespace dspace;

struct Sky {
  Ephemeris ephemeris;
  std::shared_ptr<Frames> frames;

  // `kernels` are files of the folder "ephemeris".
  Sky(const std::string& folder, const std::vector<std::string>& kernels) {
    FrameSources sources;
    auto pool = std::make_shared<KernelPool>();
    for (const std::string& name : kernels) {
      const std::string path = folder + "/" + name;
      if (name.substr(name.size() - 4) == ".bpc") {
        sources.orientations.push_back(std::make_shared<BinaryPck>(path));
      } else if (name.substr(name.size() - 4) == ".bsp") {
        this->ephemeris.Load(std::make_shared<SpkSource>(path));
      } else {
        pool->Add(TextKernel::Read(path));
      }
    }
    sources.pool = pool;
    sources.scales = TimeScalesOf(*pool);
    if (De405Source::IsInstalled()) {
      sources.de405 = std::make_shared<De405Source>();
      this->ephemeris.Load(sources.de405, Ephemeris::Priority::Last);
    }
    this->frames = std::make_shared<Frames>(sources);
    this->ephemeris.SetFrames(this->frames);
    this->ephemeris.SetTimeScales(sources.scales);
  }
  double Tdb(const std::string& utc) const {
    return TdbFromText(utc, this->frames->Sources().scales);
  }
};

const std::string Kernels = "spice_test_kernels/";

// Horizons (sky_checks.json): the Sun from the Moon at 29.1957 E, 84.7906 S, MOON_ME.
TEST(SkyView, SunAtTheLunarSiteAsHorizonsHasIt) {
  DSPACE_REAL_DATA(folder, "ephemeris");
  if (!De405Source::IsInstalled()) {
    DSPACE_MISSING_PACKAGE("casacore-data-jpl-de405");
  }
  struct Row {
    const char* utc;
    double azimuth, elevation;
  };
  const Row rows[] = {{"2026-11-01T00:00", 255.862499, 0.186534},
                      {"2026-11-01T05:00", 253.337795, -0.033378}};
  for (const bool binary : {true, false}) {
    const Sky sky(folder, binary ? std::vector<std::string>{"naif0012.tls", "moon_080317.tf",
                                                            "moon_pa_de421_1900-2050.bpc"}
                                 : std::vector<std::string>{"naif0012.tls"});
    const SkyPlace place = {301, "MOON_ME",
                            AxesAt({29.1957, -84.7906, 0.0, LatitudeKind::Planetocentric},
                                   Eigen::Vector3d::Constant(1737400.0))};
    for (const Row& row : rows) {
      const SkyBody sun = Look(sky.ephemeris, *sky.frames, place, 10, sky.Tdb(row.utc));
      std::printf("%s %s: azimuth %+.6f, elevation %+.6f deg from Horizons\n", row.utc,
                  binary ? "DE421" : "DE405", sun.direction.azimuth_deg - row.azimuth,
                  sun.direction.elevation_deg - row.elevation);
      EXPECT_NEAR(sun.direction.azimuth_deg, row.azimuth, 1e-4);
      EXPECT_NEAR(sun.direction.elevation_deg, row.elevation, 1e-4);
      EXPECT_NEAR(sun.radius_deg, 0.268, 0.002);
      EXPECT_EQ(sun.litFraction, 1.0);
    }
    // The Earth, as the Moon shows it its near side: north of the horizon by the site's colatitude.
    const SkyBody earth = Look(sky.ephemeris, *sky.frames, place, 399, sky.Tdb(rows[0].utc));
    EXPECT_NEAR(earth.direction.elevation_deg, 5.2, 8.0);
    EXPECT_NEAR(earth.radius_deg, std::asin(6378136.6 / earth.range) * 180.0 / M_PI, 1e-12);
    EXPECT_THROW(Look(sky.ephemeris, *sky.frames, place, 301, 0.0), Error);
  }
}

// CSPICE (spice_checks.json): Mars, IAU_MARS of pck00010, LT+S, from the Earth. The recorded value
// takes the light time of Mars's centre (SPICE's older subsol), this function that of the point, 11
// ms less, in which Mars turns by 4.6e-5 degrees.
TEST(SkyView, SubSolarPointOfMarsAsSpiceHasIt) {
  DSPACE_REAL_DATA(folder, "ephemeris");
  const Sky sky(folder,
                {"naif0012.tls", Kernels + "de405s_littleendian.bsp", Kernels + "pck00010.tpc"});
  const double tdb = sky.Tdb("2008-08-11T00:00:00");
  const SubPoint sun = SubSolarPoint(sky.ephemeris, *sky.frames, 499, "IAU_MARS", tdb, 399);
  EXPECT_NEAR(sun.longitude_deg, -175.81067551023222, 1e-4);
  EXPECT_NEAR(sun.latitude_deg, 23.420819936106213, 1e-6);
  EXPECT_NEAR(sun.geodetic_latitude_deg, 23.668550281477703, 1e-6);
  const double center =
      Sight(sky.ephemeris, 499, sky.ephemeris.FromBarycenter(399, tdb), tdb).lightTime;
  const SubPoint older = SubSolarPoint(sky.ephemeris, *sky.frames, 499, "IAU_MARS", tdb - center);
  EXPECT_NEAR(older.longitude_deg, -175.81067551023222, 1e-5);
  EXPECT_NEAR(older.latitude_deg, 23.420819936106213, 1e-6);
  EXPECT_NEAR(older.geodetic_latitude_deg, 23.668550281477703, 1e-6);
  EXPECT_LT(sun.epoch, tdb - 60.0);
  // Without an observer the same minutes later: Mars turns by 14.6 degrees an hour.
  const SubPoint now = SubSolarPoint(sky.ephemeris, *sky.frames, 499, "", sun.epoch);
  EXPECT_NEAR(now.longitude_deg, sun.longitude_deg, 1e-9);
}

// A sphere's phase by the angle between the sub-solar and the sub-observer point.
TEST(SkyView, PhaseFollowsFromTheSubPoints) {
  DSPACE_REAL_DATA(folder, "ephemeris");
  const Sky sky(folder, {"naif0012.tls", Kernels + "de405s_littleendian.bsp", "moon_080317.tf",
                         "moon_pa_de421_1900-2050.bpc"});
  for (double tdb = 0.0; tdb < 2.6e6; tdb += 1.9e5) {
    const SubPoint sun = SubSolarPoint(sky.ephemeris, *sky.frames, 301, "MOON_ME", tdb, 399);
    const SubPoint earth = SubObserverPoint(sky.ephemeris, *sky.frames, 301, "MOON_ME", 399, tdb);
    const double phase = std::acos(sun.position.normalized().dot(earth.position.normalized()));
    const SkyPlace center = {
        399, "IAU_EARTH", {Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()}};
    const SkyBody moon = Look(sky.ephemeris, *sky.frames, center, 301, tdb);
    EXPECT_NEAR(moon.litFraction, 0.5 * (1.0 + std::cos(phase)), 2e-4);
    EXPECT_LT(std::hypot(earth.longitude_deg, earth.latitude_deg), 11.0); // the libration
  }
}

// CSPICE (spice_checks.json): the Sun from DSS-14, CN+S, in DSS-14_TOPO.
TEST(SkyView, SunFromAStationAsSpiceHasIt) {
  DSPACE_REAL_DATA(folder, "ephemeris");
  const Sky sky(folder,
                {"naif0012.tls", Kernels + "de405s_littleendian.bsp",
                 Kernels + "earth_031228_231229_predict.bpc", Kernels + "earth_topo_050714.tf"});
  const double tdb = sky.Tdb("2003-10-13T06:00:00");
  LocalAxes axes;
  axes.position =
      1000.0 * Eigen::Vector3d(-2353.6213656676991, -4641.3414911499403, 3677.0523293197439);
  axes.toLocal.setIdentity();
  const auto apparent = [&](double time) {
    const State observer = PlaceState(sky.ephemeris, *sky.frames, {399, "ITRF93", axes}, time);
    const Sighting sighting = Sight(sky.ephemeris, 10, observer, time);
    return Eigen::Vector3d(sky.frames->Rotation("J2000", "DSS-14_TOPO", time) *
                           Aberrated(sighting.state.position, observer.velocity));
  };
  const Eigen::Vector3d expected(62512273.3012810498476, 58967492.9926417097449,
                                 -122059095.879866167903);
  EXPECT_LT((apparent(tdb) / 1000.0 - expected).norm(), 1e-3); // km of 1.5e8
  const Eigen::Vector3d velocity = (apparent(tdb + 1.0) - apparent(tdb - 1.0)) / 2000.0;
  EXPECT_LT((velocity - Eigen::Vector3d(2475.97313358008614159, -9870.26711803482794494,
                                        -3499.90805659246507275))
                .norm(),
            1e-4);
  const State observer = PlaceState(sky.ephemeris, *sky.frames, {399, "ITRF93", axes}, tdb);
  EXPECT_NEAR(Sight(sky.ephemeris, 10, observer, tdb).lightTime, 497.93167787805714, 1e-9);
}

} // namespace
