// What people do at viewers, on its way to the simulation's callback in C++.
#include <limits>

#include "LinkTestSupport.h"

namespace dspace::testing {
namespace {

using session::RemoteClient;
using session::Watcher;

class LinkEvents : public LinkTest {
protected:
  void SetUp() override {
    LinkTest::SetUp();
    this->StartServer();
    session::WatcherOptions options;
    options.address = this->Server->Address();
    options.name = "operator";
    this->Viewer = std::make_unique<Watcher>(options);
  }
  void TearDown() override {
    this->Viewer.reset();
    LinkTest::TearDown();
  }

  std::vector<v1::ViewerEvent> Take(RemoteClient& client, std::size_t count) {
    std::vector<v1::ViewerEvent> heard;
    while (heard.size() < count &&
           client.TakeEvents([&](const v1::ViewerEvent& each) { heard.push_back(each); }, 20) > 0) {
    }
    return heard;
  }

  void Refuse(const v1::ViewerEvent& event, const std::string& text) {
    try {
      this->Viewer->SendEvent(event);
      FAIL() << event.ShortDebugString();
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
  }

  std::unique_ptr<Watcher> Viewer;
};

TEST_F(LinkEvents, EveryKindComesInOrderAsItWasSaid) {
  RemoteClient client(this->ClientOptions());
  std::vector<v1::ViewerEvent> said(5);
  said[0].mutable_picked()->set_viewport("view");
  said[0].mutable_picked()->mutable_pick()->set_object(7);
  said[0].mutable_picked()->mutable_pick()->mutable_in_root()->set_x(-1.5);
  said[1].mutable_selection()->set_scene("scene");
  said[1].mutable_selection()->add_object(7);
  said[1].mutable_selection()->add_object(3);
  said[2].mutable_answer()->set_question("deploy?");
  said[2].mutable_answer()->set_answer("go");
  said[3].mutable_edited()->set_name("speed");
  said[3].mutable_edited()->set_value(0.25);
  said[3].mutable_edited()->set_unit("m/s");
  v1::ViewerEvent::Dragged* dragged = said[4].mutable_dragged();
  dragged->set_goal("arm");
  dragged->set_frame(5);
  dragged->set_relative_to(2);
  dragged->mutable_pose()->mutable_position()->set_z(0.1);
  dragged->mutable_pose()->mutable_rotation()->set_w(0.6);
  dragged->mutable_pose()->mutable_rotation()->set_x(0.8);
  dragged->set_done(true);
  for (const v1::ViewerEvent& event : said) {
    EXPECT_TRUE(this->Viewer->SendEvent(event));
  }
  const std::vector<v1::ViewerEvent> heard = this->Take(client, said.size());
  ASSERT_EQ(heard.size(), said.size());
  for (std::size_t i = 0; i < said.size(); ++i) {
    said[i].set_from("operator");
    EXPECT_EQ(heard[i].SerializeAsString(), said[i].SerializeAsString()) << i;
  }
}

TEST_F(LinkEvents, ACallbackMayGiveCommands) {
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  v1::ViewerEvent event;
  event.mutable_dragged()->set_goal("arm");
  event.mutable_dragged()->mutable_pose()->mutable_position()->set_x(2);
  EXPECT_TRUE(this->Viewer->SendEvent(event));
  std::size_t count = 0;
  client.TakeEvents(
      [&](const v1::ViewerEvent& each) {
        v1::Command command = MakeFrame(9);
        *command.mutable_create_frame()->mutable_pose() = each.dragged().pose();
        Accept(client.Execute(command));
        ++count;
      },
      20);
  ASSERT_EQ(count, 1u);
  EXPECT_EQ(client.Execute(AskPoses({9})).poses().pose(0), 2);
}

TEST_F(LinkEvents, AreSaidInPartsAndDropped) {
  RemoteClient client(this->ClientOptions());
  v1::ViewerEvent event;
  event.mutable_answer()->set_question("deploy?");
  EXPECT_TRUE(this->Viewer->WaitForSendEvent(20)); // nothing is under way,
  EXPECT_THROW(this->Viewer->TakeSendEventResult(), Error);
  for (const bool dropped : {true, false}) {
    event.mutable_answer()->set_answer(dropped ? "no" : "go");
    this->Viewer->BeginSendEvent(event, 20);
    if (dropped) {
      this->Viewer->CancelSendEvent();
      EXPECT_THROW(this->Viewer->TakeSendEventResult(), Error); // nor is it any more
    }
  }
  while (!this->Viewer->WaitForSendEvent(0.01)) {
  }
  EXPECT_TRUE(this->Viewer->TakeSendEventResult());
  EXPECT_THROW(this->Viewer->TakeSendEventResult(), Error); // taken once
  // What was dropped may have been heard.
  const std::vector<v1::ViewerEvent> heard = this->Take(client, 1);
  ASSERT_FALSE(heard.empty());
  EXPECT_TRUE(heard.back().answer().answer() == "go" ||
              this->Take(client, 1).back().answer().answer() == "go");
}

TEST_F(LinkEvents, InvalidEventsAreRejectedByTheServer) {
  RemoteClient client(this->ClientOptions());
  v1::ViewerEvent event;
  event.mutable_edited()->set_name("speed");
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    event.mutable_edited()->set_value(bad);
    this->Refuse(event, "value 'speed'");
  }
  event.mutable_dragged()->set_goal("arm");
  event.mutable_dragged()->mutable_pose()->mutable_rotation()->set_w(1.1);
  this->Refuse(event, "goal 'arm'");
  event.mutable_dragged()->mutable_pose()->mutable_rotation()->set_w(1);
  event.mutable_dragged()->mutable_pose()->mutable_position()->set_x(
      std::numeric_limits<double>::quiet_NaN());
  this->Refuse(event, "goal 'arm'");
  event.mutable_answer()->set_question(std::string(1 << 20, 'q'));
  this->Refuse(event, "accepted: up to 1048576");
  // One that the server does not know, of a newer viewer, goes through whole.
  event.Clear();
  event.GetReflection()->MutableUnknownFields(&event)->AddVarint(100, 42);
  EXPECT_TRUE(this->Viewer->SendEvent(event));
  const std::vector<v1::ViewerEvent> heard = this->Take(client, 1);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(heard[0].GetReflection()->GetUnknownFields(heard[0]).field_count(), 1);
}

} // namespace
} // namespace dspace::testing
