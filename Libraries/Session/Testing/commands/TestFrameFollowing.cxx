// Frame events of followed scenes in replies.
#include <vector>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

struct ReceivedEvent {
  v1::FrameEvent::Type type;
  std::vector<FrameId> frames;
  bool operator==(const ReceivedEvent& o) const {
    return this->type == o.type && this->frames == o.frames;
  }
};

void PrintTo(const ReceivedEvent& received, std::ostream* os) {
  *os << v1::FrameEvent::Type_Name(received.type) << ::testing::PrintToString(received.frames);
}

std::vector<ReceivedEvent> EventsOf(const v1::Reply& reply) {
  std::vector<ReceivedEvent> all;
  for (const v1::FrameEvent& event : reply.frame_event()) {
    all.push_back({event.type(), {event.frame().begin(), event.frame().end()}});
  }
  return all;
}

using Events = std::vector<ReceivedEvent>;

class FrameFollowing : public CommandTest {
protected:
  v1::Reply Follow(bool stop = false, const std::string& scene = {}) {
    v1::Command command;
    command.set_scene(scene);
    command.mutable_follow_frames()->set_stop(stop);
    return this->Accept(command);
  }

  // A request that has nothing to do with frames.
  v1::Reply Ask() {
    v1::Command command;
    command.mutable_get_time();
    return this->Accept(command);
  }

  FrameTree& Tree(const std::string& scene = "scene") {
    return this->Interpreter_.FindScene(scene)->Frames();
  }

  static v1::Command Create(const std::string& name, FrameId parent = 0) {
    v1::Command command;
    command.mutable_create_frame()->set_name(name);
    command.mutable_create_frame()->set_parent(parent);
    return command;
  }
};

TEST_F(FrameFollowing, RepliesTellWhatTheirCommandsCaused) {
  v1::Command create = Create("a");
  EXPECT_EQ(this->Accept(create).frame_event_size(), 0); // nobody follows
  const FrameId a = create.create_frame().id();
  EXPECT_EQ(this->Follow().frame_event_size(), 0);
  EXPECT_EQ(this->Follow().frame_event_size(), 0); // twice is once
  create = Create("b", a);
  const v1::Reply created = this->Accept(create);
  const FrameId b = create.create_frame().id();
  EXPECT_EQ(EventsOf(created), (Events{{v1::FrameEvent::CREATED, {b}}}));
  EXPECT_EQ(created.frame_event(0).scene(), "scene");
  EXPECT_EQ(created.frame_event(0).revision(), this->Tree().Revision());
  EXPECT_EQ(created.frame().frame(), b); // the result stands beside it

  v1::Command c;
  c.mutable_rename_frame()->set_frame(b);
  c.mutable_rename_frame()->set_name("c");
  EXPECT_EQ(EventsOf(this->Accept(c)), (Events{{v1::FrameEvent::RENAMED, {b}}}));
  EXPECT_EQ(this->Accept(c).frame_event_size(), 0); // no change, no event
  c.mutable_reparent_frame()->set_frame(b);
  EXPECT_EQ(EventsOf(this->Accept(c)), (Events{{v1::FrameEvent::REPARENTED, {b}}}));
  c.mutable_reparent_frame()->set_parent(a);
  this->Accept(c);
  c.mutable_remove_frame()->set_frame(a);
  EXPECT_EQ(EventsOf(this->Accept(c)), (Events{{v1::FrameEvent::REMOVED, {b, a}}}));

  this->Follow(true);
  this->Follow(true); // twice is no error
  create = Create("d");
  EXPECT_EQ(this->Accept(create).frame_event_size(), 0);
  EXPECT_EQ(this->Follow().frame_event_size(), 0); // nothing was kept meanwhile
}

TEST_F(FrameFollowing, ThousandsOfPosesAreOneEvent) {
  std::vector<FrameId> ids;
  v1::Command set;
  for (int i = 0; i < 3000; ++i) {
    ids.push_back(this->AddFrame("f" + std::to_string(i)));
    set.mutable_set_poses()->add_frame(ids.back());
    for (const double value : {1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) {
      set.mutable_set_poses()->add_pose(value);
    }
  }
  this->Follow();
  EXPECT_EQ(EventsOf(this->Accept(set)), (Events{{v1::FrameEvent::POSES_CHANGED, ids}}));
  EXPECT_EQ(this->Accept(set).frame_event_size(), 0); // they are there already
}

TEST_F(FrameFollowing, RobotsAreReportedByTheirFrames) {
  const TemporaryFile file("follow.urdf", R"(<robot name="arm">
    <link name="base"/><link name="upper"/>
    <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
      <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>)");
  this->Follow();
  v1::Command c;
  c.mutable_load_robot()->set_path(file.Path());
  v1::Reply reply = this->Accept(c);
  const FrameId base = reply.robot().base();
  const FrameId lower = reply.robot().link(0).frame();
  const FrameId upper = reply.robot().link(1).frame();
  Events received = EventsOf(reply);
  ASSERT_GE(received.size(), 3u);
  received.resize(3); // poses may follow
  EXPECT_EQ(received, (Events{{v1::FrameEvent::CREATED, {base}},
                              {v1::FrameEvent::CREATED, {lower}},
                              {v1::FrameEvent::CREATED, {upper}}}));
  c.mutable_set_joints()->set_robot("arm");
  c.mutable_set_joints()->add_joint(0);
  c.mutable_set_joints()->add_position(30);
  EXPECT_EQ(EventsOf(this->Accept(c)), (Events{{v1::FrameEvent::POSES_CHANGED, {upper}}}));
  c.mutable_remove_robot()->set_robot("arm");
  EXPECT_EQ(EventsOf(this->Accept(c)), (Events{{v1::FrameEvent::REMOVED, {upper, lower, base}}}));
}

TEST_F(FrameFollowing, ChangesThatARejectedCommandRevertedAreNotReported) {
  const TemporaryFile file("refused.urdf", R"(<robot name="arm"><link name="base">
    <visual><geometry><box size="1 1 1"/></geometry></visual></link></robot>)");
  this->Follow();
  const FrameId direct = this->Tree().Create(RootFrame, "direct");
  const std::uint64_t revision = this->Tree().Revision();
  v1::Command c;
  c.mutable_load_robot()->set_path(file.Path());
  c.mutable_load_robot()->set_fragment("no such fragment"); // found out with the frames made
  const v1::Reply reply = this->Interpreter_.Execute(c);
  EXPECT_EQ(reply.error().kind(), v1::Error::NOT_FOUND);
  EXPECT_EQ(reply.frame_event_size(), 0);
  EXPECT_GT(this->Tree().Revision(), revision); // frames were made and removed
  EXPECT_EQ(EventsOf(this->Ask()), (Events{{v1::FrameEvent::CREATED, {direct}}}));
}

// A listener on the tree that throws makes the command fail with its change made.
TEST_F(FrameFollowing, ChangesThatARejectedCommandLeftAreReported) {
  this->Follow();
  const auto token =
      this->Tree().AddListener([](const FrameEvent&) { throw std::runtime_error("listener"); });
  v1::Command create = Create("a");
  EXPECT_TRUE(this->Interpreter_.Execute(create).has_error());
  this->Tree().RemoveListener(token);
  EXPECT_EQ(EventsOf(this->Ask()), (Events{{v1::FrameEvent::CREATED, {this->Tree().Find("a")}}}));
}

TEST_F(FrameFollowing, DirectChangesComeWithTheNextReply) {
  this->Follow();
  const FrameId a = this->Tree().Create(RootFrame, "a");
  this->Tree().SetLocalPose(a, {Eigen::Vector3d(1, 2, 3), Eigen::Quaterniond::Identity(), 1.0});
  v1::Command create = Create("b");
  const v1::Reply reply = this->Accept(create);
  const FrameId b = reply.frame().frame();
  EXPECT_EQ(EventsOf(reply), (Events{{v1::FrameEvent::CREATED, {a}},
                                     {v1::FrameEvent::POSES_CHANGED, {a}},
                                     {v1::FrameEvent::CREATED, {b}}}));
  for (int i = 1; i < reply.frame_event_size(); ++i) {
    EXPECT_GT(reply.frame_event(i).revision(), reply.frame_event(i - 1).revision());
  }
  EXPECT_EQ(this->Ask().frame_event_size(), 0); // once
}

// C++ may drive a scene for hours before somebody asks.
TEST_F(FrameFollowing, DirectPosesThatPileUpAreJoined) {
  this->Follow();
  FrameTree& tree = this->Tree();
  const FrameId a = tree.Create(RootFrame, "a");
  const FrameId b = tree.Create(RootFrame, "b");
  const auto move = [&](FrameId id, double x) {
    tree.SetLocalPose(id, {Eigen::Vector3d(x, 0, 0), Eigen::Quaterniond::Identity(), 1.0});
  };
  for (int i = 1; i <= 100000; ++i) {
    move(i % 2 ? a : b, i);
  }
  tree.Rename(b, "c"); // keeps its place
  move(b, -1);
  move(b, -2);
  v1::Command refused = Create("a"); // nothing is lost
  EXPECT_TRUE(this->Interpreter_.Execute(refused).has_error());
  move(b, -3);
  const v1::Reply reply = this->Ask();
  const Events received = EventsOf(reply);
  const std::size_t full = session::FrameEventLog::MaximumWaiting;
  ASSERT_EQ(received.size(), full + 3);
  EXPECT_EQ(received[full - 2], (ReceivedEvent{v1::FrameEvent::POSES_CHANGED, {a}}));
  EXPECT_EQ(received[full - 1], (ReceivedEvent{v1::FrameEvent::POSES_CHANGED, {b, a}}));
  EXPECT_EQ(received[full], (ReceivedEvent{v1::FrameEvent::RENAMED, {b}}));
  EXPECT_EQ(received[full + 1], (ReceivedEvent{v1::FrameEvent::POSES_CHANGED, {b}}));
  EXPECT_EQ(received[full + 2], (ReceivedEvent{v1::FrameEvent::POSES_CHANGED, {b}}));
  for (int i = 1; i < reply.frame_event_size(); ++i) {
    EXPECT_GT(reply.frame_event(i).revision(), reply.frame_event(i - 1).revision());
  }
  EXPECT_EQ(reply.frame_event(int(full) - 1).revision(), 2u + 100000u);
  EXPECT_EQ(reply.frame_event(int(full) + 2).revision(), tree.Revision());
  move(a, 0); // what waits next starts again
  move(b, 0);
  EXPECT_EQ(EventsOf(this->Ask()),
            (Events{{v1::FrameEvent::POSES_CHANGED, {a}}, {v1::FrameEvent::POSES_CHANGED, {b}}}));
}

TEST_F(FrameFollowing, CommandsOfListenersAreReportedInTheOuterReply) {
  this->Follow();
  std::vector<int> heard;
  bool nested = false;
  this->Interpreter_.AddListener([&](const v1::Command&, const v1::Reply& reply) {
    heard.push_back(reply.frame_event_size());
    if (!nested) {
      nested = true;
      v1::Command inner = Create("inner");
      EXPECT_EQ(this->Accept(inner).frame_event_size(), 0);
    }
  });
  v1::Command outer = Create("outer");
  const Events received = EventsOf(this->Accept(outer));
  EXPECT_EQ(received, (Events{{v1::FrameEvent::CREATED, {this->Tree().Find("outer")}},
                              {v1::FrameEvent::CREATED, {this->Tree().Find("inner")}}}));
  EXPECT_EQ(heard, (std::vector<int>{1, 0}));
}

TEST_F(FrameFollowing, ScenesAreFollowedOneByOneAndLeaveNoListener) {
  v1::Command scene;
  scene.set_scene("other");
  scene.mutable_create_scene();
  this->Accept(scene);
  this->Follow(false, "other");
  this->AddFrame("a");
  v1::Command create = Create("a");
  create.set_scene("other");
  const v1::Reply reply = this->Accept(create);
  ASSERT_EQ(reply.frame_event_size(), 1);
  EXPECT_EQ(reply.frame_event(0).scene(), "other");

  const std::shared_ptr<Scene> kept = this->Interpreter_.FindScene("other");
  v1::Command remove;
  remove.set_scene("other");
  remove.mutable_remove_scene();
  this->Accept(remove);
  kept->Frames().Create(RootFrame, "late");
  EXPECT_EQ(this->Ask().frame_event_size(), 0);
  this->Accept(scene); // a new one of that name begins without followers
  create.mutable_create_frame()->set_id(0);
  EXPECT_EQ(this->Accept(create).frame_event_size(), 0);
  this->Reject(
      [] {
        v1::Command command;
        command.set_scene("nowhere");
        command.mutable_follow_frames();
        return command;
      }(),
      v1::Error::NOT_FOUND, "nowhere");

  std::shared_ptr<Scene> outlives;
  {
    session::Interpreter second;
    v1::Command c;
    c.mutable_create_scene();
    second.Execute(c);
    c.mutable_follow_frames();
    second.Execute(c);
    outlives = second.FindScene("scene");
  }
  outlives->Frames().Create(RootFrame, "after"); // reaches nobody: the sanitizers would object
}

TEST_F(FrameFollowing, IsNoChangeOfTheScene) {
  int received = 0;
  this->Interpreter_.AddListener([&](const v1::Command&, const v1::Reply&) { ++received; });
  const std::uint64_t revision = this->Interpreter_.FindScene("scene")->Revision();
  this->Follow();
  this->Follow(true);
  EXPECT_EQ(received, 0); // not recorded
  EXPECT_EQ(this->Interpreter_.FindScene("scene")->Revision(), revision);
}

} // namespace
} // namespace dspace::testing
