// The Sun: its direction by vectors and angles, its irradiance, and what snapshots keep of it.
#include <cmath>
#include <limits>
#include <vector>

#include <google/protobuf/text_format.h>

#include <dspace/ledger/Ledger.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

constexpr double Infinity = std::numeric_limits<double>::infinity();

class SunTest : public CommandTest {
protected:
  SunTest() {
    v1::Command scene;
    scene.mutable_create_scene();
    this->Ledger_.Add(scene, {}); // that of the fixture
    this->Interpreter_.AddListener([this](const v1::Command& command, const v1::Reply& reply) {
      this->Ledger_.Add(command, reply);
      this->Last_ = command;
    });
  }

  static v1::Command Parse(const std::string& text) {
    v1::Command command;
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &command)) << text;
    return command;
  }
  v1::Reply Give(const std::string& text) {
    v1::Command command = Parse(text);
    return this->Accept(command);
  }
  // The answer of a scene made from the snapshot is the same to the bit.
  v1::SunInfo Sun() {
    v1::Command ask;
    ask.mutable_get_sun();
    const v1::SunInfo sun = this->Accept(ask).sun();
    session::Interpreter other;
    for (v1::Command command : this->Ledger_.Commands()) {
      EXPECT_FALSE(other.Execute(command).has_error()) << command.ShortDebugString();
    }
    EXPECT_EQ(other.Execute(ask).sun().SerializeAsString(), sun.SerializeAsString());
    EXPECT_EQ(PictureOf(other), this->Picture());
    return sun;
  }
  static void ExpectTowards(const v1::SunInfo& sun, const Eigen::Vector3d& direction) {
    EXPECT_NEAR(sun.direction().x(), direction.x(), 1e-15);
    EXPECT_NEAR(sun.direction().y(), direction.y(), 1e-15);
    EXPECT_NEAR(sun.direction().z(), direction.z(), 1e-15);
  }
  void RejectSun(const std::string& text, const std::string& says,
                 v1::Error::Kind kind = Kind::INVALID_ARGUMENT) {
    this->Reject(Parse("set_sun { sun { " + text + " } }"), kind, says);
  }

  session::Ledger Ledger_;
  v1::Command Last_; // as recorded
};

TEST_F(SunTest, ANewSceneHasItInTheNorthWestAtOneAstronomicalUnit) {
  const v1::SunInfo sun = this->Sun();
  ExpectTowards(sun, {-0.5, 0.5, std::sqrt(0.5)});
  EXPECT_EQ(sun.azimuth_deg(), 315.0);
  EXPECT_EQ(sun.elevation_deg(), 45.0);
  EXPECT_EQ(sun.irradiance(), 1361.0);
  EXPECT_EQ(sun.distance_au(), 1.0);
  EXPECT_EQ(sun.radius_deg(), 0.2666);
  v1::Command lights = Parse("list_lights {}");
  const v1::LightList list = this->Accept(lights).lights();
  ASSERT_EQ(list.light_size(), 1);
  EXPECT_EQ(list.light(0).intensity(), 1.0);
}

TEST_F(SunTest, AVectorPointsToItInItsFrame) {
  // The frame's X is the root's Y, its Y the root's -X.
  this->Give("create_frame { id: 10 name: \"turned\" pose { position { x: 5 } "
             "rotation { w: 0.70710678118654757 z: 0.70710678118654757 } } }");
  this->Give("set_sun { sun { direction { x: 3 z: 4 } frame: 10 } }");
  ExpectTowards(this->Sun(), {0.0, 0.6, 0.8});
  EXPECT_EQ(this->Sun().frame(), 10u);
  // It turns with its frame: now the frame's X is the root's -X.
  this->Give("set_poses { frame: 10 pose: [0, 0, 0, 0, 0, 0, 1, 1] }");
  ExpectTowards(this->Sun(), {-0.6, 0.0, 0.8});
  this->Give("remove_frame { frame: 10 }");
  this->Reject(Parse("get_sun {}"), Kind::NOT_FOUND, "has no Sun");
  this->Give("set_sun {}"); // makes one again
  ExpectTowards(this->Sun(), {-0.5, 0.5, std::sqrt(0.5)});
}

TEST_F(SunTest, AnglesAreClockwiseFromTheFramesYAndUpFromItsXY) {
  const double c = std::cos(M_PI / 6);
  struct Case {
    double azimuth, elevation;
    Eigen::Vector3d direction;
  };
  const std::vector<Case> cases = {
      {0, 0, {0, 1, 0}},
      {90, 0, {1, 0, 0}},
      {180, 30, {0, -c, 0.5}},
      {-90, 30, {-c, 0, 0.5}},
      {45, -30, {c * std::sqrt(0.5), c * std::sqrt(0.5), -0.5}}, // night
      {0, 90, {0, 0, 1}},
      {0, -90, {0, 0, -1}}};
  for (const auto& [azimuth, elevation, direction] : cases) {
    this->Give("set_sun { sun { horizontal { azimuth_deg: " + std::to_string(azimuth) +
               " elevation_deg: " + std::to_string(elevation) + " } } }");
    const v1::SunInfo sun = this->Sun();
    ExpectTowards(sun, direction);
    EXPECT_NEAR(sun.elevation_deg(), elevation, 1e-12);
    if (std::abs(elevation) < 89.0) {
      EXPECT_NEAR(sun.azimuth_deg(), azimuth < 0 ? azimuth + 360 : azimuth, 1e-12);
    }
  }
  // What is recorded needs no angles.
  EXPECT_FALSE(this->Last_.set_sun().sun().has_horizontal());
  EXPECT_TRUE(this->Last_.set_sun().sun().has_direction());
}

TEST_F(SunTest, IrradianceFallsWithTheSquareOfTheDistance) {
  this->Give("set_sun { sun { distance_au: 1.5237 } }");
  EXPECT_NEAR(this->Sun().irradiance(), 586.2, 0.05); // of Mars, NASA's fact sheet (1361 at 1 au)
  EXPECT_NEAR(this->Sun().distance_au(), 1.5237, 1e-15);
  this->Give("set_sun { sun { irradiance: 340.25 } }");
  EXPECT_DOUBLE_EQ(this->Sun().distance_au(), 2.0);
  this->Give("set_sun { sun { irradiance: 0 } }");
  EXPECT_EQ(this->Sun().distance_au(), Infinity);
}

TEST_F(SunTest, AbsentFieldsKeepTheirValues) {
  this->Give("set_light { name: \"sun\" direction { x: -2 } color { r: 1 g: 0.5 } intensity: 0.25 "
             "radius_deg: 1 disabled: true }");
  this->Give("set_sun { sun { direction { y: 7 } } }");
  v1::SunInfo sun = this->Sun();
  ExpectTowards(sun, {0, 1, 0});
  EXPECT_EQ(sun.irradiance(), 340.25);
  EXPECT_EQ(sun.radius_deg(), 1.0);
  EXPECT_TRUE(sun.disabled());
  v1::Command lights = Parse("list_lights {}");
  EXPECT_EQ(this->Accept(lights).lights().light(0).color().g(), 0.5);
  this->Give("set_sun { sun { radius_deg: 0 } }");
  EXPECT_EQ(this->Sun().radius_deg(), 0.0);
  ExpectTowards(this->Sun(), {0, 1, 0});
  this->Give("set_sun { sun { irradiance: 1361 } }"); // white again
  EXPECT_EQ(this->Accept(lights).lights().light(0).color().g(), 1.0);
}

TEST_F(SunTest, SnapshotsKeepItHoweverItCameAbout) {
  this->Give("set_sun { sun { radius_deg: 5 } }"); // of the default light
  ExpectTowards(this->Sun(), {-0.5, 0.5, std::sqrt(0.5)});
  EXPECT_EQ(this->Sun().radius_deg(), 5.0);
  this->Give("remove_light { name: \"sun\" }");
  this->Give("set_sun { sun { direction { x: 1 } } }"); // of none: its disc is the default again
  EXPECT_EQ(this->Sun().radius_deg(), 0.2666);
  this->Give("set_light { name: \"lamp\" kind: POINT }");
  this->Give("remove_light { name: \"sun\" }");
  this->Give("set_light { name: \"sun\" radius_deg: 3 direction { z: -1 } }");
  this->Give("set_sun { sun { distance_au: 2 } }");
  EXPECT_EQ(this->Sun().radius_deg(), 3.0);
  ExpectTowards(this->Sun(), {0, 0, 1});
}

TEST_F(SunTest, RejectsWhatIsNoSun) {
  this->RejectSun("direction {}", "the direction towards the Sun is (0, 0, 0); accepted: finite");
  this->RejectSun("direction { x: nan }", "nan");
  this->RejectSun("direction { x: inf }", "inf");
  this->RejectSun("direction { x: 1 } frame: 77", "77", Kind::NOT_FOUND);
  this->RejectSun("direction { x: 1 } horizontal { azimuth_deg: 1 }", "one of direction and");
  this->RejectSun("frame: 1", "without a direction");
  this->RejectSun("radius_deg: -0.1", "radius_deg is -0.1; accepted: 0 to 90");
  this->RejectSun("radius_deg: 90.5", "accepted: 0 to 90");
  this->RejectSun("radius_deg: nan", "accepted: 0 to 90");
  this->RejectSun("irradiance: -1", "its irradiance is -1; accepted: 0 to 1.361e15 W/m^2");
  this->RejectSun("irradiance: nan", "accepted: 0 to 1.361e15");
  this->RejectSun("irradiance: 1.4e15", "accepted: 0 to 1.361e15");
  this->RejectSun("distance_au: 0", "its distance is 0; accepted: 1e-6 to 1e12 au");
  this->RejectSun("distance_au: -2", "accepted: 1e-6 to 1e12 au");
  this->RejectSun("distance_au: inf", "accepted: 1e-6 to 1e12 au");
  this->RejectSun("distance_au: 2 irradiance: 300", "accepted: one of them");
  this->RejectSun("horizontal { elevation_deg: 90.001 }", "elevation_deg is 90.001; accepted: -90");
  this->RejectSun("horizontal { elevation_deg: -91 }", "accepted: -90 to 90");
  this->RejectSun("horizontal { azimuth_deg: nan }", "accepted: -360 to 360");
  this->RejectSun("horizontal { terrain: \"gale\" }", "no such terrain", Kind::NOT_FOUND);
  this->RejectSun("horizontal { map_x: 1 }", "both or none");
  this->RejectSun("horizontal { map_x: 1 map_y: 2 }", "a terrain with them");
  // Everything is checked before anything changes.
  this->RejectSun("direction { x: 1 } radius_deg: 2 irradiance: -1", "its irradiance");
}

TEST_F(SunTest, ALightOfItsNameThatIsNotDirectionalIsNotTakenForIt) {
  this->Give("set_light { name: \"sun\" kind: POINT position { z: 3 } }");
  this->RejectSun("direction { x: 1 }", "it is not directional");
  this->Reject(Parse("get_sun {}"), Kind::NOT_FOUND, "has no Sun");
}

TEST_F(SunTest, ATerrainsSiteGivesTheAxesAndMustBeOnIt) {
  const TemporaryFile ground("sun_ground.asc",
                             "ncols 3\nnrows 3\nxllcorner 100\nyllcorner 200\ncellsize 2\n"
                             "0 1 2\n0 1 2\n0 1 2\n");
  this->Give("create_frame { id: 10 name: \"turned\" pose { rotation { w: 0.70710678118654757 z: "
             "0.70710678118654757 } } }");
  this->Give("open_terrain { name: \"ground\" frame: 10 path: \"" + ground.Path() + "\" }");
  this->Give("set_sun { sun { horizontal { terrain: \"ground\" azimuth_deg: 90 elevation_deg: 30 "
             "map_x: 103 map_y: 203 } } }");
  ExpectTowards(this->Sun(), {0, std::cos(M_PI / 6), 0.5}); // east of the map is the root's Y
  v1::Command ask = Parse("get_sun { terrain: \"ground\" map_x: 101 map_y: 201 }");
  const v1::SunInfo sun = this->Accept(ask).sun();
  EXPECT_NEAR(sun.azimuth_deg(), 90.0, 1e-12);
  EXPECT_NEAR(sun.elevation_deg(), 30.0, 1e-12);
  EXPECT_EQ(sun.frame(), 10u);
  const std::string place = "horizontal { terrain: \"ground\" ";
  this->RejectSun(
      place + "map_x: 90 map_y: 203 }",
      "the place 90, 203 is off its data; accepted: map x, y from 101, 201 to 105, 205");
  this->RejectSun(place + "map_x: nan map_y: 203 }", "is off its data");
  this->RejectSun(place + "} frame: 10", "accepted: one of them");
  this->Reject(Parse("get_sun { terrain: \"ground\" map_x: 90 map_y: 1 }"), Kind::INVALID_ARGUMENT,
               "is off its data");
  this->Reject(Parse("get_sun { terrain: \"none\" }"), Kind::NOT_FOUND, "no such terrain");
}

TEST_F(SunTest, TheFormerLightSkyMayBeSetAndRemoved) {
  v1::Command remove = Parse("remove_light { name: \"sky\" }"); // as snapshots of before do
  EXPECT_EQ(this->Accept(remove).warning_size(), 1);
  this->Sun(); // its snapshot is in order
  this->Give("set_light { name: \"sky\" kind: AMBIENT intensity: 0.25 }");
  this->Sun();
  v1::Command lights = Parse("list_lights {}");
  EXPECT_EQ(this->Accept(lights).lights().light_size(), 2);
  EXPECT_EQ(this->Accept(remove).warning_size(), 0);
  EXPECT_EQ(this->Accept(lights).lights().light_size(), 1);
  this->Reject(Parse("remove_light { name: \"moon\" }"), Kind::NOT_FOUND, "none of this name");
}

} // namespace
} // namespace dspace::testing
