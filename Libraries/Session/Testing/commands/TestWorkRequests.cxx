// Requests that are computed in threads of their own while the session does other things.
#include <cmath>
#include <sstream>

#include <dspace/state/Works.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

// Hills of 100 x 100 posts, 2 m apart, and a mast beside a wall.
class WorkRequests : public CommandTest {
protected:
  WorkRequests() {
    std::ostringstream text;
    text << "ncols 100\nnrows 100\nxllcorner 0\nyllcorner 0\ncellsize 2\n";
    for (int r = 0; r < 100; ++r) {
      for (int c = 0; c < 100; ++c) {
        text << 10.0 * std::sin(0.21 * c) * std::cos(0.17 * r) << " ";
      }
      text << "\n";
    }
    const std::string path = (this->Folder_.Path() / "hills.asc").string();
    std::ofstream(path) << text.str();
    v1::Command open;
    open.mutable_open_terrain()->set_path(path);
    open.mutable_open_terrain()->set_name("hills");
    this->Accept(open);
    v1::Command frame;
    frame.mutable_create_frame()->set_name("mast");
    frame.mutable_create_frame()->mutable_pose()->mutable_position()->set_z(30.0);
    this->Mast_ = this->Accept(frame).frame().frame();
    v1::Command wall;
    wall.mutable_create_primitive()->mutable_object()->set_name("wall");
    wall.mutable_create_primitive()->mutable_object()->mutable_offset()->mutable_position()->set_x(
        20.0);
    v1::Vector3* size = wall.mutable_create_primitive()->mutable_box()->mutable_size();
    size->set_x(1.0);
    size->set_y(30.0);
    size->set_z(100.0);
    this->Wall_ = this->Accept(wall).object().object();
  }

  v1::Command Horizon(std::uint32_t azimuths) const {
    v1::Command command;
    command.mutable_horizon()->mutable_place()->set_frame(this->Mast_);
    command.mutable_horizon()->set_azimuths(azimuths);
    return command;
  }
  static v1::Command Await(std::uint64_t work) {
    v1::Command command;
    command.mutable_await_work()->set_work(work);
    return command;
  }
  std::uint64_t Begin(v1::Command command) {
    const v1::Reply reply = this->Accept(command);
    EXPECT_TRUE(reply.has_work()) << reply.ShortDebugString();
    return reply.work().work();
  }

  TemporaryFolder Folder_;
  FrameId Mast_ = 0;
  ObjectId Wall_ = 0;
};

TEST_F(WorkRequests, AHorizonIsThatOfTheSceneWhenItWasAskedFor) {
  v1::Command command = this->Horizon(720);
  const v1::HorizonReply expected = this->Accept(command).horizon();
  ASSERT_EQ(expected.elevation_deg_size(), 720);
  command.mutable_horizon()->mutable_measuring()->set_wait_s(0.0);
  const std::uint64_t work = this->Begin(command);
  // All that it was measured against is moved or removed.
  v1::Command pose;
  pose.mutable_set_poses()->add_frame(this->Mast_);
  for (const double value : {50.0, 0.0, 90.0, 1.0, 0.0, 0.0, 0.0, 1.0}) {
    pose.mutable_set_poses()->add_pose(value);
  }
  this->Accept(pose);
  v1::Command terrain;
  terrain.mutable_remove_terrain()->set_terrain("hills");
  this->Accept(terrain);
  v1::Command scene;
  scene.set_scene("scene");
  scene.mutable_remove_scene();
  this->Accept(scene);
  v1::Command await = Await(work);
  const v1::HorizonReply found = this->Accept(await).horizon();
  EXPECT_EQ(found.DebugString(), expected.DebugString());
  this->Interpreter_.Execute(await);
  EXPECT_EQ(this->Interpreter_.Execute(await).error().kind(), Kind::NOT_FOUND); // once
}

TEST_F(WorkRequests, LinesAndAreasAreTheSame) {
  v1::Command lines;
  lines.mutable_line_of_sight()->set_wavelength(0.03);
  for (int i = 0; i < 40; ++i) {
    v1::LineOfSight::Pair* pair = lines.mutable_line_of_sight()->add_pair();
    pair->mutable_from()->set_frame(this->Mast_);
    pair->mutable_to_site()->set_terrain("hills");
    pair->mutable_to_site()->set_map_x(5.0 + 4.5 * i);
    pair->mutable_to_site()->set_map_y(190.0 - 4.0 * i);
    pair->mutable_to_site()->set_height(1.0);
  }
  v1::Command area;
  area.mutable_lit_area()->add_object(this->Wall_);
  v1::Vector3* sun = area.mutable_lit_area()->mutable_sun()->mutable_direction();
  sun->set_x(1.0);
  sun->set_z(0.3);
  for (v1::Command* command : {&lines, &area}) {
    v1::Command copy = *command;
    const v1::Reply expected = this->Accept(copy);
    v1::Measuring* measuring = command == &lines ? copy.mutable_line_of_sight()->mutable_measuring()
                                                 : copy.mutable_lit_area()->mutable_measuring();
    measuring->set_wait_s(0.0);
    v1::Command await = Await(this->Begin(copy));
    EXPECT_EQ(this->Accept(await).DebugString(), expected.DebugString());
    measuring->set_wait_s(1e9); // the reply is the result
    EXPECT_EQ(this->Accept(copy).DebugString(), expected.DebugString());
  }
}

TEST_F(WorkRequests, ContactsTracksAndProfilesAreTheSame) {
  const auto place = [](v1::SkyPlace* at) {
    at->mutable_celestial()->set_body("moon");
    at->mutable_celestial()->mutable_site()->set_longitude_deg(29.0);
    at->mutable_celestial()->mutable_site()->set_latitude_deg(-84.0);
  };
  const auto expectTheSame = [&](v1::Command command, auto wait) {
    v1::Command copy = command;
    const v1::Reply expected = this->Accept(copy);
    wait(command);
    v1::Command await = Await(this->Begin(command));
    EXPECT_EQ(this->Accept(await).DebugString(), expected.DebugString());
  };
  v1::Command contacts;
  place(contacts.mutable_find_contacts()->mutable_place());
  contacts.mutable_find_contacts()->add_target()->set_body("earth");
  contacts.mutable_find_contacts()->add_target()->set_body("sun");
  contacts.mutable_find_contacts()->set_end_s(2.6e6);
  contacts.mutable_find_contacts()->set_step_s(3600.0);
  expectTheSame(contacts, [](v1::Command& c) { c.mutable_find_contacts()->set_wait_s(0.0); });
  v1::Command track;
  place(track.mutable_track_sky()->mutable_place());
  track.mutable_track_sky()->mutable_target()->set_body("sun");
  for (int i = 0; i < 50; ++i) {
    track.mutable_track_sky()->add_time_s(3600.0 * i);
  }
  expectTheSame(track, [](v1::Command& c) { c.mutable_track_sky()->set_wait_s(0.0); });
  v1::Command power;
  place(power.mutable_profile_power()->mutable_place());
  power.mutable_profile_power()->add_panel()->set_area(2.0);
  power.mutable_profile_power()->set_end_s(2.6e6);
  expectTheSame(power, [](v1::Command& c) { c.mutable_profile_power()->set_wait_s(0.0); });
}

TEST_F(WorkRequests, GoesOnBetweenRequestsUntilItIsCancelled) {
  v1::Command command = this->Horizon(1000000);
  command.mutable_horizon()->mutable_measuring()->set_wait_s(0.0);
  const std::uint64_t work = this->Begin(command);
  v1::Command await = Await(work);
  await.mutable_await_work()->set_wait_s(0.01);
  double fraction = 0.0;
  while (fraction == 0.0) { // the session executes other commands
    const v1::Reply reply = this->Accept(await);
    ASSERT_TRUE(reply.has_work());
    fraction = reply.work().fraction();
    v1::Command time;
    time.mutable_get_time();
    this->Accept(time);
  }
  EXPECT_LT(fraction, 1.0);
  v1::Command cancel = await;
  cancel.mutable_await_work()->set_cancel(true);
  EXPECT_LT(this->Accept(cancel).work().fraction(), 1.0);
  this->Reject(await, Kind::NOT_FOUND, "there is no such work");
}

TEST_F(WorkRequests, ErrorsComeWithTheResult) {
  v1::Command command = this->Horizon(1000000);
  command.mutable_horizon()->mutable_measuring()->set_wait_s(0.0);
  command.mutable_horizon()->mutable_measuring()->set_deadline_s(0.05);
  v1::Command await = Await(this->Begin(command));
  this->Reject(await, Kind::DEADLINE_EXCEEDED, "deadline of 0.05 s");
  command = this->Horizon(8);
  command.mutable_horizon()->mutable_measuring()->set_wait_s(0.0);
  command.mutable_horizon()->mutable_place()->mutable_position()->set_z(-200.0);
  await = Await(this->Begin(command));
  this->Reject(await, Kind::INVALID_ARGUMENT, "below the ground");
  v1::Command scan;
  scan.mutable_scan_ranges()->mutable_measuring()->set_wait_s(1.0);
  scan.mutable_scan_ranges()->mutable_place()->set_frame(this->Mast_);
  this->Reject(scan, Kind::INVALID_ARGUMENT, "it has wait_s");
}

TEST_F(WorkRequests, MoreThanTheLimitAreRejected) {
  v1::Command command = this->Horizon(1000000);
  command.mutable_horizon()->mutable_measuring()->set_wait_s(0.0);
  std::uint64_t first = 0;
  for (std::size_t i = 0; i < session::Works::Most; ++i) {
    const std::uint64_t work = this->Begin(command);
    first = i == 0 ? work : first;
  }
  this->Reject(command, Kind::RESOURCE, "64 requests are being computed");
  v1::Command cancel = Await(first);
  cancel.mutable_await_work()->set_cancel(true);
  this->Accept(cancel);
  this->Begin(command);
} // the destructor ends them

} // namespace
} // namespace dspace::testing
