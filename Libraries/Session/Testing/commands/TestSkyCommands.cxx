// Frames and the Sun that follow the time, reference frames, bodies in the sky.
#include <fstream>

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <dspace/ephemeris/De405Source.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/ledger/Ledger.h>
#include <dspace/orientation/BodyConstants.h>

#include "TemporaryFolder.h"

namespace dspace::session {
namespace {

class SkyCommands : public ::testing::Test {
protected:
  SkyCommands() : Ledger_(&this->Interpreter_.GetState()) {
    this->Interpreter_.AddListener([this](const v1::Command& command, const v1::Reply& reply) {
      this->Ledger_.Add(command, reply);
      this->Accepted_.push_back(command);
    });
    this->Give("create_scene {}");
  }

  static v1::Command Parse(const std::string& text) {
    v1::Command command;
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &command)) << text;
    return command;
  }
  v1::Reply Try(const std::string& text) {
    v1::Command command = Parse(text);
    return this->Interpreter_.Execute(command);
  }
  v1::Reply Give(const std::string& text) {
    v1::Reply reply = this->Try(text);
    EXPECT_FALSE(reply.has_error()) << text << "\n" << reply.error().message();
    return reply;
  }
  // The message of a rejected command.
  std::string Rejected(const std::string& text) {
    const v1::Reply reply = this->Try(text);
    EXPECT_TRUE(reply.has_error()) << text;
    return reply.error().message();
  }
  const Scene& TheScene() { return *this->Interpreter_.FindScene("scene"); }
  Pose PoseOf(FrameId frame) { return this->TheScene().Frames().LocalPose(frame); }
  // The Earth at the root, the Moon and a site on it.
  void AddMoon() {
    this->Give(R"(create_frame { id: 10 name: "moon" })");
    this->Give(R"(create_frame { id: 11 parent: 10 name: "site" })");
    this->Give(
        R"(set_frame_motion { frame: 10 place { body: "moon" axes: "IAU_MOON" } parent { body: "earth" } })");
    this->Give(R"(set_frame_motion { frame: 11
        place { body: "moon" axes: "IAU_MOON" site { longitude_deg: 30 latitude_deg: -60 height: 2 } } })");
  }

  Interpreter Interpreter_;
  Ledger Ledger_;
  std::vector<v1::Command> Accepted_;
};

TEST_F(SkyCommands, FramesFollowTheTime) {
  this->AddMoon();
  const KernelSet kernels;
  for (const double tdb : {0.0, 3.0e8}) {
    this->Give("set_time { time_s: " + std::to_string(tdb) + " }");
    const Pose moon = this->PoseOf(10);
    EXPECT_LT((moon.position - kernels.GetEphemeris().Find("MOON", "EARTH", tdb).position).norm(),
              1e-6);
    EXPECT_NEAR(moon.position.norm(), 3.84e8, 2.5e7);
    // The pose takes the Moon's components to those of the root, which are J2000's.
    const Eigen::Matrix3d turn = kernels.GetFrames().Rotation("IAU_MOON", "J2000", tdb);
    EXPECT_LT((moon.rotation.toRotationMatrix() - turn).cwiseAbs().maxCoeff(), 1e-14);
    // The site does not move on the Moon, and its Z is up.
    const Pose site = this->PoseOf(11);
    const double r = 1737402.0;
    const Eigen::Vector3d up(std::cos(M_PI / 3.0) * std::cos(M_PI / 6.0),
                             std::cos(M_PI / 3.0) * std::sin(M_PI / 6.0), -std::sin(M_PI / 3.0));
    EXPECT_LT((site.position - r * up).norm(), 1e-8);
    EXPECT_LT((site.rotation * Eigen::Vector3d::UnitZ() - up).norm(), 1e-15);
    EXPECT_LT(std::abs((site.rotation * Eigen::Vector3d::UnitX()).z()), 1e-15); // east
  }
}

TEST_F(SkyCommands, RecordedCommandsAndSnapshotsNeedNoKernels) {
  dspace::testing::TemporaryFolder folder;
  const std::string kernel = folder / "craft.tf";
  std::ofstream(kernel)
      << "KPL/FK\n\\begindata\nFRAME_CRAFT = 1400000\nFRAME_1400000_NAME = 'CRAFT'\n"
         "FRAME_1400000_CLASS = 4\nFRAME_1400000_CLASS_ID = 1400000\nFRAME_1400000_CENTER = 399\n"
         "TKFRAME_1400000_SPEC = 'ANGLES'\nTKFRAME_1400000_RELATIVE = 'IAU_EARTH'\n"
         "TKFRAME_1400000_ANGLES = ( 30 0 0 )\nTKFRAME_1400000_AXES = ( 3 1 3 )\n"
         "TKFRAME_1400000_UNITS = 'DEGREES'\n";
  this->AddMoon();
  this->Give("load_kernels { path: \"" + kernel + "\" }");
  this->Give(R"(create_frame { id: 12 name: "craft" })");
  this->Give(
      R"(set_frame_motion { frame: 12 place { body: "earth" axes: "craft" } parent { body: "earth" } })");
  this->Give(R"(set_sun_motion { frame: 11 })");
  this->Give("set_time { time_s: 1e8 }");
  const auto check = [&](const std::vector<v1::Command>& commands, const char* what) {
    Interpreter other;
    for (v1::Command command : commands) {
      if (command.has_load_kernels()) {
        continue; // the file is missing there
      }
      const v1::Reply reply = other.Execute(command);
      ASSERT_FALSE(reply.has_error()) << what << ": " << reply.error().message();
    }
    const Scene& scene = *other.FindScene("scene");
    for (const FrameId frame : {10, 11, 12}) {
      EXPECT_TRUE(scene.Frames().LocalPose(frame) == this->PoseOf(frame)) << what << " " << frame;
    }
    EXPECT_EQ(scene.Fragments().Lights()[0].direction,
              this->TheScene().Fragments().Lights()[0].direction)
        << what;
    EXPECT_EQ(scene.Time(), 1e8);
  };
  check(this->Accepted_, "recording");
  check(this->Ledger_.Commands(), "snapshot");
  // With the kernels, the copy goes on.
  Interpreter other;
  for (v1::Command command : this->Ledger_.Commands()) {
    ASSERT_FALSE(other.Execute(command).has_error());
  }
  v1::Command time = Parse("set_time { time_s: 2e8 }");
  ASSERT_FALSE(other.Execute(time).has_error());
  this->Give("set_time { time_s: 2e8 }");
  EXPECT_TRUE(other.FindScene("scene")->Frames().LocalPose(12) == this->PoseOf(12));
  // A frame that stops keeps its pose, in a snapshot too.
  this->Give("set_frame_motion { frame: 12 }");
  Interpreter stopped;
  for (v1::Command command : this->Ledger_.Commands()) {
    ASSERT_FALSE(stopped.Execute(command).has_error());
  }
  EXPECT_TRUE(stopped.FindScene("scene")->Frames().LocalPose(12) == this->PoseOf(12));
  v1::Command on = Parse("set_time { time_s: 3e8 }");
  ASSERT_FALSE(stopped.Execute(on).has_error());
  EXPECT_TRUE(stopped.FindScene("scene")->Frames().LocalPose(12) == this->PoseOf(12));
  // A step that was computed for another time is not used.
  v1::Command again = Parse("set_time { time_s: 1e8 }");
  *again.mutable_set_time()->mutable_sky() = time.set_time().sky();
  ASSERT_FALSE(other.Execute(again).has_error());
  EXPECT_FALSE(other.FindScene("scene")->Frames().LocalPose(12) == this->PoseOf(12));
}

TEST_F(SkyCommands, TheSunFollows) {
  this->AddMoon();
  this->Give("set_time { time_s: 8.4e8 }");
  this->Give("set_sun_motion { frame: 11 }");
  const v1::SunInfo sun = this->Give("get_sun {}").sun();
  const v1::SkyReply sky =
      this->Give(R"(sky_state { place { frame: 11 } target: "sun" target: "earth" })").sky();
  // The light's direction in the root, seen in the site's axes, is the azimuth and elevation.
  const Pose site = this->TheScene().Frames().RelativePose(RootFrame, 11);
  const Eigen::Vector3d d =
      site.rotation.conjugate() *
      Eigen::Vector3d(sun.direction().x(), sun.direction().y(), sun.direction().z());
  EXPECT_NEAR(std::asin(d.z()) * 180.0 / M_PI, sky.body(0).elevation_deg(), 1e-9);
  EXPECT_NEAR(
      std::remainder(std::atan2(d.x(), d.y()) * 180.0 / M_PI - sky.body(0).azimuth_deg(), 360.0),
      0.0, 1e-9);
  EXPECT_NEAR(sun.distance_au(), sky.body(0).range() / 149597870700.0, 1e-12);
  EXPECT_NEAR(sun.radius_deg(), sky.body(0).radius_deg(), 1e-12);
  EXPECT_NEAR(sun.radius_deg(), 0.2666, 0.006);
  EXPECT_EQ(sky.body(0).lit_fraction(), 1.0);
  // The Earth stands where the Moon's frame is seen from it, but for 20 arcsec of aberration.
  const Eigen::Vector3d earth = -(site.rotation.conjugate() * site.position).normalized();
  EXPECT_NEAR(std::asin(earth.z()) * 180.0 / M_PI, sky.body(1).elevation_deg(), 0.01);
  EXPECT_NEAR(sky.body(1).range(), site.position.norm(), 3e4);
  // It moves with the time: half a year later it is as far as the sky says then, and elsewhere.
  this->Give("set_time { time_s: 8.56e8 }");
  const v1::SunInfo later = this->Give("get_sun {}").sun();
  const v1::SkyReply then = this->Give(R"(sky_state { place { frame: 11 } })").sky();
  EXPECT_NEAR(later.distance_au(), then.body(0).range() / 149597870700.0, 1e-12);
  EXPECT_GT(std::abs(later.distance_au() - sun.distance_au()), 0.01);
  EXPECT_NEAR(later.radius_deg(), then.body(0).radius_deg(), 1e-12);
  // It cannot be set meanwhile, and again when it has stopped.
  EXPECT_NE(this->Rejected("set_sun { sun { radius_deg: 1 } }").find("follows"), std::string::npos);
  this->Give("set_sun_motion { stop: true }");
  this->Give("set_sun { sun { radius_deg: 1 } }");
}

TEST_F(SkyCommands, WithoutItsLightTheSunFollowsNoMore) {
  this->AddMoon();
  this->Give("set_sun_motion { frame: 11 }");
  this->Give(R"(remove_light { name: "sun" })");
  this->Give("set_time { time_s: 8.4e8 }");
  EXPECT_TRUE(this->TheScene().Fragments().Lights().empty());
  Interpreter other;
  for (v1::Command command : this->Ledger_.Commands()) {
    ASSERT_FALSE(other.Execute(command).has_error());
  }
  EXPECT_TRUE(other.FindScene("scene")->Fragments().Lights().empty());
}

TEST_F(SkyCommands, RejectsAndChangesNothing) {
  this->AddMoon();
  const Pose before = this->PoseOf(10);
  const auto holds = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  holds(this->Rejected("set_poses { frame: 10 pose: [0, 0, 0, 1, 0, 0, 0, 1] }"),
        "follows the scene's time");
  holds(this->Rejected("reparent_frame { frame: 11 parent: 1 }"), "follows the scene's time");
  holds(this->Rejected("set_frame_motion { frame: 10 }"), "cannot stop");
  holds(this->Rejected(
            "set_frame_motion { frame: 1 place { body: \"moon\" } parent { body: \"earth\" } }"),
        "root");
  holds(this->Rejected("set_frame_motion { frame: 77 place { body: \"moon\" } }"), "77");
  this->Give(R"(create_frame { id: 20 name: "other" })");
  holds(this->Rejected(
            R"(set_frame_motion { frame: 20 place { body: "mars" } parent { body: "moon" } })"),
        "one place for each parent");
  holds(this->Rejected(
            R"(set_frame_motion { frame: 20 place { body: "vulcan" } parent { body: "earth" } })"),
        "vulcan");
  holds(
      this->Rejected(
          R"(set_frame_motion { frame: 20 place { body: "mars" axes: "IAU_MARZ" } parent { body: "earth" } })"),
      "'IAU_MARS'");
  holds(
      this->Rejected(
          R"(set_frame_motion { frame: 20 place { body: "mars" } parent { body: "earth" } correction: "XX" })"),
      "LT");
  holds(this->Rejected("set_time { time_s: 9e9 }"), "follows the scene's time"); // the year 2285
  EXPECT_EQ(this->TheScene().Time(), 0.0);
  EXPECT_TRUE(this->PoseOf(10) == before);
  holds(this->Rejected("load_kernels { path: \"/nonexistent.bsp\" }"), "nonexistent");
  holds(this->Rejected("load_kernels {}"), "at least one");
  holds(this->Rejected("unload_kernels { path: \"a.bsp\" }"), "it is not loaded");
  holds(this->Rejected("sky_state {}"), "accepted: place, site or celestial");
  this->Give("scene: \"other\" create_scene {}");
  holds(this->Rejected("scene: \"other\" sky_state { place {} }"), "it follows no body");
  holds(this->Rejected(R"(sky_state { celestial { body: "moon" site {} } target: "moon" })"),
        "the body of the site");
  holds(this->Rejected(R"(find_sub_points { body: "mars" below_observer: true })"),
        "without an observer");
  // Stopped frames can be set again, and removed ones are forgotten.
  this->Give("set_frame_motion { frame: 11 }");
  this->Give("set_poses { frame: 11 pose: [0, 0, 0, 1, 0, 0, 0, 1] }");
  this->Give("remove_frame { frame: 10 }");
  this->Give("set_time { time_s: 9e9 }");
}

// SPICE (spice_checks.json): 1997-03-20T12:53:29 UTC is -87865528.8143913.
TEST_F(SkyCommands, TimesAreConverted) {
  const v1::TimesReply times =
      this->Give(
              R"(convert_times { text: "1997-03-20T12:53:29" time_s: -87865528.8143913 decimals: 3 })")
          .times();
  EXPECT_NEAR(times.time_s(0), -87865528.8143913, 1e-6);
  EXPECT_EQ(times.utc(0), "1997-03-20T12:53:29.000");
  EXPECT_EQ(times.utc(1), times.utc(0));
  this->Rejected(R"(convert_times { text: "2026-13-01" })");
  // Before UTC there are texts in other scales alone; after the last known leap second a warning.
  const v1::TimesReply early =
      this->Give(R"(convert_times { text: "1900-01-01T00:00:00 TDB" })").times();
  EXPECT_EQ(early.time_s(0), -3155716800.0);
  EXPECT_EQ(early.utc(0), "");
  this->Rejected("convert_times { time_s: -3155716800 }");
  const v1::Reply late = this->Give(R"(convert_times { text: "2040-01-01" })");
  ASSERT_EQ(late.warning_size(), 1);
  EXPECT_NE(late.warning(0).find("leap seconds"), std::string::npos) << late.warning(0);
}

// SPICE (spice_checks.json): Mars from the Earth, 2003-07-04T19:00:00 UTC, with de405s; here DE405
// itself.
TEST_F(SkyCommands, StatesComeWithTheirSources) {
  const v1::EphemerisReply states =
      this->Give(R"(ephemeris { target: "mars" observer: "earth" time_s: 110617264.184 })")
          .ephemeris();
  ASSERT_EQ(states.state_size(), 6);
  ASSERT_GE(states.source_size(), 2);
  if (states.source(0).source() == "JPL DE405") {
    EXPECT_NEAR(states.state(0), 73826216414.5, 1e3);
    EXPECT_NEAR(states.state(4), 7513.81423681132, 1e-3);
    EXPECT_NEAR(states.light_time_s(0), 269.70264751151603, 1e-5);
  }
  this->Rejected(R"(ephemeris { target: "499" observer: "399" time_s: 9e9 })");
  this->Rejected(R"(ephemeris { target: "vulcan" observer: "399" })");
}

// DE405 ends in 2060; ERFA goes on with a warning, at any time of a request.
TEST_F(SkyCommands, RepliesSayWhereErfaStandsIn) {
  const auto count = [](const v1::Reply& reply, const std::string& part) {
    int found = 0;
    for (const std::string& warning : reply.warning()) {
      found += warning.find(part) != std::string::npos;
    }
    return found;
  };
  const bool installed = De405Source::IsInstalled();
  EXPECT_EQ(count(this->Give(R"(ephemeris { target: "moon" observer: "earth" time_s: [0, 1e8] })"),
                  "ERFA"),
            installed ? 0 : 1);
  const v1::Reply later =
      this->Give(R"(ephemeris { target: "moon" observer: "earth" time_s: [0, 1.95e9, 2e9] })");
  EXPECT_EQ(count(later, "body MOON is taken from ERFA's series, up to 32 km off"), 1);
  EXPECT_EQ(count(later, installed ? "(at 2 of 3 times: 2061-" : "(at 3 of 3 times: "), 1);
  // What follows the time warns once, not at every step.
  this->AddMoon();
  this->Give("set_time { time_s: 1e8 }");
  EXPECT_EQ(count(this->Give("set_time { time_s: 1.95e9 }"), "body MOON"), installed ? 1 : 0);
  EXPECT_EQ(count(this->Give("set_time { time_s: 1.96e9 }"), "body MOON"), 0);
}

TEST_F(SkyCommands, FrameTurnsNameTheirSources) {
  const v1::FrameTurnsReply turns =
      this->Give(
              R"(turn_frames { from: "eclipj2000" to: "IAU_MARS" time_s: [0, 1e8] rates: true })")
          .frame_turns();
  ASSERT_EQ(turns.rotation_size(), 18);
  ASSERT_EQ(turns.rate_size(), 18);
  ASSERT_EQ(turns.step_size(), 2);
  EXPECT_EQ(turns.step(1).source(), "pck00011");
  const Eigen::Matrix3d expected = KernelSet().GetFrames().Rotation("ECLIPJ2000", "IAU_MARS", 1e8);
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(turns.rotation(9 + i), expected(i / 3, i % 3)); // row by row
  }
}

} // namespace
} // namespace dspace::session
