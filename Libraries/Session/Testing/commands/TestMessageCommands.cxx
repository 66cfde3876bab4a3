// Events of a simulation, and questions to the operator.
#include <limits>

#include <dspace/state/MessageLog.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

class MessageTest : public CommandTest {
protected:
  static v1::Command Event(const std::string& kind, const std::string& text = "") {
    v1::Command command;
    command.mutable_log_event()->set_kind(kind);
    command.mutable_log_event()->set_text(text);
    return command;
  }
  v1::LogEvent Log(const std::string& kind, const std::string& text = "") {
    v1::Command command = Event(kind, text);
    const v1::LogEvent event = this->Accept(command).event();
    EXPECT_EQ(command.log_event().DebugString(), event.DebugString()); // as it is recorded
    return event;
  }
  void SetTime(double time_s) {
    v1::Command command;
    command.mutable_set_time()->set_time_s(time_s);
    this->Accept(command);
  }
  template<class Fill> v1::EventList List(Fill fill) {
    v1::Command command;
    fill(*command.mutable_list_events());
    return this->Accept(command).events();
  }
  static std::string Texts(const v1::EventList& list) {
    std::string texts;
    for (const v1::LogEvent& event : list.event()) {
      texts += event.text();
    }
    return texts;
  }
  static v1::Command Question(const std::string& name, const std::string& text = "Go?") {
    v1::Command command;
    command.mutable_ask_operator()->set_name(name);
    command.mutable_ask_operator()->set_text(text);
    return command;
  }
  v1::QuestionList Questions() {
    v1::Command command;
    command.mutable_list_questions();
    return this->Accept(command).questions();
  }
};

TEST_F(MessageTest, EventsAreKeptInOrderWithTimeAndPlace) {
  const FrameId rover = this->AddFrame("rover");
  const FrameId wheel = this->AddFrame("wheel", rover);
  this->SetTime(12.5);
  v1::Command contact = Event("contact", "left wheel\non a stone");
  contact.mutable_log_event()->set_severity(v1::CAUTION);
  contact.mutable_log_event()->set_frame(wheel);
  contact.mutable_log_event()->mutable_position()->set_z(-0.2);
  v1::EventDatum* force = contact.mutable_log_event()->add_datum();
  force->set_name("force");
  force->set_number(std::numeric_limits<double>::infinity());
  force->set_unit("N");
  const v1::LogEvent event = this->Accept(contact).event();
  EXPECT_EQ(event.number(), 1u);
  EXPECT_EQ(event.time_s(), 12.5);
  EXPECT_EQ(event.frame_path(), "rover/wheel");
  EXPECT_EQ(contact.log_event().number(), 1u); // as it is recorded
  v1::Command root = Event("note");
  root.mutable_log_event()->set_frame(1);
  EXPECT_EQ(this->Accept(root).event().frame_path(), "/");

  // What the frame was called stays, whatever becomes of it.
  v1::Command rename;
  rename.mutable_rename_frame()->set_frame(rover);
  rename.mutable_rename_frame()->set_name("old rover");
  this->Accept(rename);
  v1::Command remove;
  remove.mutable_remove_frame()->set_frame(wheel);
  this->Accept(remove);
  const v1::LogEvent kept = this->List([](auto&) {}).event(0);
  EXPECT_EQ(kept.frame(), 0u);
  EXPECT_EQ(kept.frame_path(), "rover/wheel");
  EXPECT_EQ(kept.position().z(), -0.2);
  EXPECT_EQ(kept.datum(0).unit(), "N");
}

TEST_F(MessageTest, ListsAreOfWhatFits) {
  for (int i = 0; i < 6; ++i) {
    this->SetTime(i);
    v1::Command event = Event(i % 2 ? "mode" : "fault", std::to_string(i));
    event.mutable_log_event()->set_severity(v1::Severity(i % 4));
    this->Accept(event);
  }
  EXPECT_EQ(Texts(this->List([](auto&) {})), "012345");
  EXPECT_EQ(Texts(this->List([](auto& list) { list.set_after(4); })), "45");
  EXPECT_EQ(Texts(this->List([](auto& list) { list.set_since_s(3.0); })), "345");
  EXPECT_EQ(Texts(this->List([](auto& list) {
              list.set_since_s(1.0);
              list.set_until_s(3.0);
            })),
            "123");
  EXPECT_EQ(Texts(this->List([](auto& list) { list.add_kind("fault"); })), "024");
  EXPECT_EQ(Texts(this->List([](auto& list) { list.set_severity(v1::WARNING); })), "23");
  EXPECT_EQ(Texts(this->List([](auto& list) { list.set_most(2); })), "45");
  const v1::EventList none = this->List([](auto& list) { list.set_after(100); });
  EXPECT_EQ(none.event_size(), 0);
  EXPECT_EQ(none.last(), 6u);
  EXPECT_EQ(none.first(), 1u);
}

TEST_F(MessageTest, TheNewestTenThousandAreKept) {
  for (int i = 1; i <= 10003; ++i) {
    v1::Command event = Event("note", "x");
    ASSERT_EQ(this->Interpreter_.Execute(event).event().number(), std::uint64_t(i));
  }
  const v1::EventList all = this->List([](auto&) {});
  EXPECT_EQ(all.event_size(), 10000);
  EXPECT_EQ(all.event(0).number(), 4u);
  EXPECT_EQ(all.first(), 4u);
  EXPECT_EQ(all.last(), 10003u);
}

TEST_F(MessageTest, EventsThatAreRejected) {
  this->Log("mode");
  this->Reject(Event(""), Kind::INVALID_ARGUMENT, "its kind is empty");
  this->Reject(Event("a\nb"), Kind::INVALID_ARGUMENT, "its kind");
  this->Reject(Event("note", std::string(4097, 'x')), Kind::INVALID_ARGUMENT, "4097 bytes");
  v1::Command event = Event("note");
  event.mutable_log_event()->set_number(1);
  this->Reject(event, Kind::INVALID_ARGUMENT, "its number is 1; accepted: above 1");
  event = Event("note");
  event.mutable_log_event()->set_severity(v1::Severity(9));
  this->Reject(event, Kind::INVALID_ARGUMENT, "its severity is 9");
  event = Event("note");
  event.mutable_log_event()->mutable_position();
  this->Reject(event, Kind::INVALID_ARGUMENT, "no frame");
  event.mutable_log_event()->set_frame(1);
  event.mutable_log_event()->mutable_position()->set_x(1e19);
  this->Reject(event, Kind::INVALID_ARGUMENT, "its position");
  event = Event("note");
  event.mutable_log_event()->set_frame(99);
  this->Reject(event, Kind::NOT_FOUND, "99");
  event = Event("note");
  event.mutable_log_event()->set_time_s(std::numeric_limits<double>::infinity());
  this->Reject(event, Kind::INVALID_ARGUMENT, "its time is inf");
  event = Event("note");
  for (int i = 0; i < 5; ++i) {
    event.mutable_log_event()->add_datum()->set_name("d" + std::to_string(i));
    event.mutable_log_event()->mutable_datum(i)->set_text(std::string(4000, 'x'));
  }
  this->Reject(event, Kind::INVALID_ARGUMENT, "accepted: up to 16384");
  event.mutable_log_event()->mutable_datum(0)->set_name("d1");
  this->Reject(event, Kind::INVALID_ARGUMENT, "occurs twice");
  EXPECT_EQ(this->Log("mode").number(), 2u); // nothing of them counted
}

TEST_F(MessageTest, WhatIsKeptCanBeTakenUp) { // by a ledger, a recording, a viewer
  this->SetTime(12.5);
  v1::Command base = Event("mode");
  for (int i = 0; i < 4; ++i) {
    base.mutable_log_event()->add_datum()->set_name("d" + std::to_string(i));
    base.mutable_log_event()->mutable_datum(i)->set_text(std::string(4000, 'x'));
  }
  int accepted = 0;
  int refused = 0;
  // Around 16 KiB, with and without the number and the time that the scene gives it.
  for (std::size_t bytes = 16384 - 30; bytes <= 16384 + 10; ++bytes) {
    v1::Command event = base;
    std::string& text = *event.mutable_log_event()->mutable_text();
    text = std::string(200, 'x');
    text.append(bytes - event.log_event().ByteSizeLong(), 'x');
    ASSERT_EQ(event.log_event().ByteSizeLong(), bytes);
    if (this->Interpreter_.Execute(event).has_error()) {
      EXPECT_FALSE(event.log_event().has_time_s()); // nor is it changed
      ++refused;
      continue;
    }
    ++accepted;
    EXPECT_LE(event.log_event().ByteSizeLong(), 16384u);
    session::MessageLog other;
    EXPECT_NO_THROW(other.Log(*event.mutable_log_event(), 0.0)) << bytes;
  }
  EXPECT_GT(accepted, 10);
  EXPECT_GT(refused, 10);
}

TEST_F(MessageTest, QuestionsAreOpenUntilTheyAreClosed) {
  this->SetTime(3.0);
  v1::Command go = Question("go");
  go.mutable_ask_operator()->add_choice("yes");
  go.mutable_ask_operator()->add_choice("no");
  this->Accept(go);
  EXPECT_EQ(go.ask_operator().time_s(), 3.0); // as it is recorded
  v1::Command speed = Question("speed", "How fast [m/s]?");
  this->Accept(speed);
  ASSERT_EQ(this->Questions().question_size(), 2);
  EXPECT_EQ(this->Questions().question(0).choice(1), "no");

  this->Reject(Question("go"), Kind::ALREADY_EXISTS, "'go': it is already open");
  this->Reject(Question(""), Kind::INVALID_ARGUMENT, "its name is empty");
  this->Reject(Question("a", ""), Kind::INVALID_ARGUMENT, "its text is empty");
  v1::Command twice = Question("a");
  twice.mutable_ask_operator()->add_choice("yes");
  twice.mutable_ask_operator()->add_choice("yes");
  this->Reject(twice, Kind::INVALID_ARGUMENT, "its choice 'yes' occurs twice");

  v1::Command other; // names are the session's: answers do not say of which scene
  other.set_scene("other");
  other.mutable_create_scene();
  this->Accept(other);
  v1::Command same = Question("go");
  same.set_scene("other");
  this->Reject(same, Kind::ALREADY_EXISTS, "in scene 'scene'");

  v1::Command close;
  close.mutable_close_question()->set_name("go");
  close.mutable_close_question()->set_answer("yes");
  close.mutable_close_question()->set_from("console");
  this->Accept(close);
  this->Reject(close, Kind::NOT_FOUND, "'go'");
  ASSERT_EQ(this->Questions().question_size(), 1);
  EXPECT_EQ(this->Questions().question(0).name(), "speed");
  this->Accept(same);
}

} // namespace
} // namespace dspace::testing
