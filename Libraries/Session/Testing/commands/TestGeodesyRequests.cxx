// Geodesy by commands: whose ellipsoid counts, and what is rejected.
#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

// 3 x 3 heights of 0 in degrees, about (11, 51).
const char* const Degrees = "ncols 3\nnrows 3\nxllcorner 10\nyllcorner 50\ncellsize 1\n"
                            "0 0 0\n0 0 0\n0 0 0\n";

class GeodesyRequests : public CommandTest {
protected:
  GeodesyRequests() : File_("degrees.asc", Degrees) {}
  void Open(const std::string& name, const std::string& crs) {
    v1::Command command;
    command.mutable_open_terrain()->set_path(this->File_.Path());
    command.mutable_open_terrain()->set_name(name);
    command.mutable_open_terrain()->set_crs(crs);
    this->Accept(command);
  }
  static v1::Command Measure(const std::string& terrain, std::vector<double> start,
                             std::vector<double> end) {
    v1::Command command;
    v1::MeasureGeodesics* measure = command.mutable_measure_geodesics();
    if (!terrain.empty()) {
      measure->mutable_ellipsoid()->set_terrain(terrain);
    }
    *measure->mutable_start() = {start.begin(), start.end()};
    *measure->mutable_end() = {end.begin(), end.end()};
    return command;
  }

  TemporaryFile File_;
};

// Along the equator a geodesic has the length a times its angle.
TEST_F(GeodesyRequests, MeasureOnTheEllipsoidThatIsMeant) {
  this->Open("moon", "+proj=longlat +R=1737400 +no_defs");
  this->Open("mars", "+proj=longlat +a=3396190 +b=3376200 +no_defs");
  const double angle = 30.0 * M_PI / 180.0;
  v1::Command command = Measure("moon", {0, 0, 10, 0}, {30, 0, 40, 0});
  v1::GeodesicReply reply = this->Accept(command).geodesics();
  ASSERT_EQ(reply.distance_size(), 2);
  EXPECT_NEAR(reply.distance(1), 1737400.0 * angle, 1e-6);
  EXPECT_NEAR(reply.azimuth_deg(0), 90.0, 1e-12);
  command = Measure("mars", {0, 0}, {30, 0});
  EXPECT_NEAR(this->Accept(command).geodesics().distance(0), 3396190.0 * angle, 1e-6);
  command = Measure("", {0, 0}, {30, 0});
  EXPECT_NEAR(this->Accept(command).geodesics().distance(0), 6378137.0 * angle, 1e-6);
  v1::Ellipsoid::Axes* axes =
      command.mutable_measure_geodesics()->mutable_ellipsoid()->mutable_axes();
  axes->set_equatorial_radius(2.5e5);
  axes->set_flattening(0.2);
  EXPECT_NEAR(this->Accept(command).geodesics().distance(0), 2.5e5 * angle, 1e-6);

  v1::Command follow;
  v1::FollowGeodesics* line = follow.mutable_follow_geodesics();
  line->mutable_ellipsoid()->set_terrain("moon");
  line->add_start(170);
  line->add_start(0);
  line->add_azimuth_deg(90);
  line->add_distance(1737400.0 * angle);
  reply = this->Accept(follow).geodesics();
  EXPECT_NEAR(reply.end(0), -160.0, 1e-9);
  EXPECT_NEAR(reply.end(1), 0.0, 1e-9);
}

TEST_F(GeodesyRequests, ReferToGridsOfWgs84Only) {
  this->Open("earth", "EPSG:4326");
  this->Open("moon", "+proj=longlat +R=1737400 +no_defs");
  v1::Command grid;
  grid.mutable_get_grid_references()->mutable_ellipsoid()->set_terrain("earth");
  grid.mutable_get_grid_references()->add_place(3);
  grid.mutable_get_grid_references()->add_place(0);
  const v1::GridReferenceReply utm = this->Accept(grid).grid_references();
  EXPECT_EQ(utm.zone(0), 31u);
  EXPECT_NEAR(utm.easting(0), 5e5, 1e-6);
  grid.mutable_get_grid_references()->set_mgrs_precision(5);
  EXPECT_EQ(this->Accept(grid).grid_references().mgrs(0), "31NEA0000000000");
  grid.mutable_get_grid_references()->set_zone(12);
  this->Reject(grid, Kind::INVALID_ARGUMENT, "near the zone");
  grid.mutable_get_grid_references()->clear_zone();
  grid.mutable_get_grid_references()->mutable_ellipsoid()->set_terrain("moon");
  this->Reject(grid, Kind::UNSUPPORTED, "1737400");

  v1::Command geoid;
  geoid.mutable_get_geoid_heights()->add_place(270);
  geoid.mutable_get_geoid_heights()->add_place(90);
  EXPECT_NEAR(this->Accept(geoid).geoid_heights().height(0), 13.606, 1e-3); // of EGM96
  geoid.mutable_get_geoid_heights()->mutable_ellipsoid()->set_terrain("moon");
  this->Reject(geoid, Kind::UNSUPPORTED, "terrain 'moon'");
  geoid.mutable_get_geoid_heights()->clear_ellipsoid();
  geoid.mutable_get_geoid_heights()->set_geoid("../../etc/passwd");
  this->Reject(geoid, Kind::INVALID_ARGUMENT, "../../etc/passwd");
  geoid.mutable_get_geoid_heights()->set_geoid("absent.gtx");
  this->Reject(geoid, Kind::NOT_FOUND, "'absent.gtx' in ");

  v1::Command find;
  find.mutable_find_grid_references()->add_mgrs("38SMB4488");
  const v1::GeodeticPlaces places = this->Accept(find).geodetic_places();
  EXPECT_NEAR(places.place(0), 44.40363, 5e-6); // the manual page of GeoConvert
  EXPECT_NEAR(places.place(1), 33.33424, 5e-6);
  EXPECT_EQ(places.side(0), 1000.0);
  find.mutable_find_grid_references()->add_mgrs("38XXX");
  this->Reject(find, Kind::INVALID_ARGUMENT, "'38XXX'");
  find.mutable_find_grid_references()->clear_mgrs();
  find.mutable_find_grid_references()->add_zone(33);
  this->Reject(find, Kind::INVALID_ARGUMENT, "0 values of north are given for 1 places");
}

// An octant of a sphere.
TEST_F(GeodesyRequests, MeasurePolygonsOnTheEllipsoidThatIsMeant) {
  this->Open("moon", "+proj=longlat +R=1737400 +no_defs");
  v1::Command command;
  v1::MeasurePolygon* polygon = command.mutable_measure_polygon();
  polygon->mutable_ellipsoid()->set_terrain("moon");
  for (const double value : {0.0, 90.0, 0.0, 0.0, 90.0, 0.0}) {
    polygon->add_place(value);
  }
  const v1::PolygonReply reply = this->Accept(command).polygon();
  EXPECT_NEAR(reply.area(), 0.5 * M_PI * 1737400.0 * 1737400.0, 1e-3);
  EXPECT_NEAR(reply.perimeter(), 1.5 * M_PI * 1737400.0, 1e-6);
  command.mutable_measure_polygon()->mutable_place()->Truncate(4);
  this->Reject(command, Kind::INVALID_ARGUMENT,
               "2 corners of a polygon are given; accepted: 3 or more");
}

TEST_F(GeodesyRequests, RejectWhatHasNoPlaceOrNoEllipsoid) {
  this->Open("plain", "");
  this->Reject(Measure("plain", {0, 0}, {1, 1}), Kind::UNSUPPORTED, "terrain 'plain'");
  this->Reject(Measure("nowhere", {0, 0}, {1, 1}), Kind::NOT_FOUND, "nowhere");
  this->Reject(Measure("", {0, 0, 5, 90.5}, {1, 1, 2, 2}), Kind::INVALID_ARGUMENT,
               "start 1: place: longitude 5, latitude 90.5");
  this->Reject(Measure("", {0, 0}, {NAN, 1}), Kind::INVALID_ARGUMENT, "end 0");
  this->Reject(Measure("", {0, 0, 1}, {1, 1}), Kind::INVALID_ARGUMENT, "start");
  this->Reject(Measure("", {0, 0}, {1, 1, 2, 2}), Kind::INVALID_ARGUMENT, "1 starts and 2 ends");
  v1::Command command = Measure("", {0, 0}, {1, 1});
  v1::Ellipsoid::Axes* axes =
      command.mutable_measure_geodesics()->mutable_ellipsoid()->mutable_axes();
  this->Reject(command, Kind::INVALID_ARGUMENT, "its equatorial radius is 0");
  axes->set_equatorial_radius(1e6);
  axes->set_flattening(-0.1);
  this->Reject(command, Kind::INVALID_ARGUMENT, "its flattening is -0.1");
  v1::Command follow;
  follow.mutable_follow_geodesics()->add_start(0);
  follow.mutable_follow_geodesics()->add_start(0);
  follow.mutable_follow_geodesics()->add_azimuth_deg(NAN);
  this->Reject(follow, Kind::INVALID_ARGUMENT, "0 values of distance");
  follow.mutable_follow_geodesics()->add_distance(1);
  this->Reject(follow, Kind::INVALID_ARGUMENT, "azimuth");
}

} // namespace
} // namespace dspace::testing
