// Telemetry: what may be defined, what a step may set, and what is answered.
#include <cmath>
#include <limits>

#include <dspace/state/Telemetry.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

constexpr double None = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinite = std::numeric_limits<double>::infinity();
using Info = v1::TelemetryInfo;

class TelemetryTest : public CommandTest {
protected:
  static v1::Command Define(const std::string& name, const std::string& unit = "") {
    v1::Command command;
    command.mutable_create_telemetry()->set_name(name);
    command.mutable_create_telemetry()->set_unit(unit);
    return command;
  }
  std::uint64_t Add(const std::string& name, const std::string& unit = "") {
    v1::Command command = Define(name, unit);
    const std::uint64_t id = this->Accept(command).telemetry().channel(0).channel().id();
    EXPECT_EQ(command.create_telemetry().id(), id); // as it is recorded
    return id;
  }
  std::uint64_t AddText(const std::string& name) {
    v1::Command command = Define(name);
    command.mutable_create_telemetry()->set_kind(v1::CreateTelemetry::TEXT);
    return this->Accept(command).telemetry().channel(0).channel().id();
  }
  static v1::Command Values(const std::vector<std::pair<std::uint64_t, double>>& values) {
    v1::Command command;
    command.mutable_set_telemetry();
    for (const auto& [id, value] : values) {
      command.mutable_set_telemetry()->add_id(id);
      command.mutable_set_telemetry()->add_value(value);
    }
    return command;
  }
  void Set(const std::vector<std::pair<std::uint64_t, double>>& values) {
    v1::Command command = Values(values);
    this->Accept(command);
  }
  void SetTime(double time_s) {
    v1::Command command;
    command.mutable_set_time()->set_time_s(time_s);
    this->Accept(command);
  }
  Info Ask(const std::string& name) {
    v1::Command command;
    command.mutable_list_telemetry()->add_name(name);
    return this->Accept(command).telemetry().channel(0);
  }
  std::vector<std::string> Below(const std::string& below) {
    v1::Command command;
    command.mutable_list_telemetry()->set_below(below);
    std::vector<std::string> names;
    const v1::Reply reply = this->Accept(command);
    for (const Info& info : reply.telemetry().channel()) {
      names.push_back(info.channel().name());
    }
    return names;
  }
};

TEST_F(TelemetryTest, ValuesAndTheTimesOfTheirChanges) {
  const std::uint64_t power = this->Add("rover/power", "W");
  const std::uint64_t charge = this->Add("rover/charge");
  EXPECT_EQ(this->Ask("rover/power").state(), Info::NO_VALUE);
  EXPECT_FALSE(this->Ask("rover/power").has_time_s());
  this->SetTime(5.0);
  this->Set({{charge, 0.5}, {power, 12.25}});
  this->SetTime(6.0);
  this->Set({{power, 12.25}, {charge, 0.25}});
  const Info info = this->Ask("rover/power");
  EXPECT_EQ(info.value(), 12.25);
  EXPECT_EQ(info.channel().unit(), "W");
  EXPECT_EQ(info.state(), Info::GOOD);
  EXPECT_EQ(info.time_s(), 5.0); // it has not changed since
  EXPECT_EQ(this->Ask("rover/charge").time_s(), 6.0);
  this->SetTime(7.0);
  this->Set({{power, None}});
  EXPECT_EQ(this->Ask("rover/power").state(), Info::NO_VALUE);
  EXPECT_TRUE(std::isnan(this->Ask("rover/power").value()));
  EXPECT_EQ(this->Ask("rover/power").time_s(), 7.0);
  this->SetTime(8.0);
  this->Set({{power, -None}}); // the same: there is none
  EXPECT_EQ(this->Ask("rover/power").time_s(), 7.0);
  this->Set({{power, -0.0}, {charge, 0.0}});
  this->SetTime(9.0);
  this->Set({{power, 0.0}}); // another one to the bit
  EXPECT_EQ(this->Ask("rover/power").time_s(), 9.0);

  v1::Command late = Values({{power, 3.0}, {charge, 4.0}});
  late.mutable_set_telemetry()->add_time_s(1.5);
  late.mutable_set_telemetry()->add_time_s(-2.0);
  this->Accept(late);
  EXPECT_EQ(this->Ask("rover/power").time_s(), 1.5);
  EXPECT_EQ(this->Ask("rover/charge").time_s(), -2.0);
}

TEST_F(TelemetryTest, AStepIsSetWholeOrNotAtAll) {
  const std::uint64_t a = this->Add("a");
  const std::uint64_t b = this->Add("b");
  const std::uint64_t text = this->AddText("text");
  this->Set({{a, 1.0}, {b, 2.0}});
  this->Reject(Values({{a, 3.0}, {b, Infinite}}), Kind::INVALID_ARGUMENT, "'b': its value is inf");
  this->Reject(Values({{a, 3.0}, {b, -Infinite}}), Kind::INVALID_ARGUMENT, "-inf");
  this->Reject(Values({{a, 3.0}, {a, 4.0}}), Kind::INVALID_ARGUMENT, "'a': it occurs twice");
  this->Reject(Values({{a, 3.0}, {b + 100, 4.0}}), Kind::NOT_FOUND, "no such channel");
  this->Reject(Values({{a, 3.0}, {text, 4.0}}), Kind::INVALID_ARGUMENT, "set_telemetry_texts");
  v1::Command uneven = Values({{a, 3.0}, {b, 4.0}});
  uneven.mutable_set_telemetry()->add_value(5.0);
  this->Reject(uneven, Kind::INVALID_ARGUMENT, "3 values and 0 times are given for 2 channels");
  v1::Command times = Values({{a, 3.0}, {b, 4.0}});
  times.mutable_set_telemetry()->add_time_s(1.0);
  this->Reject(times, Kind::INVALID_ARGUMENT, "2 values and 1 times");
  times.mutable_set_telemetry()->add_time_s(None);
  this->Reject(times, Kind::INVALID_ARGUMENT, "its time is nan");
  v1::Command wrong;
  wrong.mutable_set_telemetry_texts()->add_id(a);
  wrong.mutable_set_telemetry_texts()->add_text("x");
  this->Reject(wrong, Kind::INVALID_ARGUMENT, "command set_telemetry");
  v1::Command control;
  control.mutable_set_telemetry_texts()->add_id(text);
  control.mutable_set_telemetry_texts()->add_text("two\nlines");
  this->Reject(control, Kind::INVALID_ARGUMENT, "its text");
  EXPECT_EQ(this->Ask("a").value(), 1.0);
}

TEST_F(TelemetryTest, WhatMayBeDefined) {
  this->Add("rover/wheel_fl");
  this->Add("rover/wheel_fl/torque", "N.m");
  this->Add("rover_2");
  this->Add("a");
  for (const char* name : {"", "/", "rover//x", "/rover", "rover/", "rover/./x", "..", "a\nb"}) {
    this->Reject(Define(name), Kind::INVALID_ARGUMENT, "name");
  }
  this->Reject(Define(std::string(256, 'n')), Kind::INVALID_ARGUMENT, "256 bytes");
  this->Add(std::string(255, 'n'));
  this->Reject(Define("a"), Kind::ALREADY_EXISTS, "'a'");
  this->Reject(Define("b", "m\ts"), Kind::INVALID_ARGUMENT, "its unit");
  this->Reject(Define("b", std::string(65, 'm')), Kind::INVALID_ARGUMENT, "65 bytes");
  v1::Command text = Define("b", "W");
  text.mutable_create_telemetry()->set_kind(v1::CreateTelemetry::TEXT);
  this->Reject(text, Kind::INVALID_ARGUMENT, "unit or limits");
  v1::Command kind = Define("b");
  kind.mutable_create_telemetry()->set_kind(v1::CreateTelemetry::Kind(7));
  this->Reject(kind, Kind::INVALID_ARGUMENT, "its kind is 7");
  EXPECT_EQ(this->Below("rover"),
            (std::vector<std::string>{"rover/wheel_fl", "rover/wheel_fl/torque"}));
  EXPECT_EQ(this->Below("").size(), 5u);
  v1::Command both;
  both.mutable_list_telemetry()->add_name("a");
  both.mutable_list_telemetry()->set_below("rover");
  this->Reject(both, Kind::INVALID_ARGUMENT, "one or the other");
}

TEST_F(TelemetryTest, IdsAreNeverUsedAgain) {
  const std::uint64_t first = this->Add("a");
  const std::uint64_t second = this->Add("b");
  v1::Command remove;
  remove.mutable_remove_telemetry()->add_id(first);
  remove.mutable_remove_telemetry()->add_id(second);
  v1::Command unknown = remove;
  unknown.mutable_remove_telemetry()->add_id(77);
  this->Reject(unknown, Kind::NOT_FOUND, "77");
  this->Accept(remove);
  EXPECT_TRUE(this->Below("").empty());
  EXPECT_GT(this->Add("a"), second);
  v1::Command again = Define("c");
  again.mutable_create_telemetry()->set_id(second);
  this->Reject(again, Kind::INVALID_ARGUMENT, "its id is 2; accepted: above 3");
  again.mutable_create_telemetry()->set_id(50);
  this->Accept(again);
  EXPECT_EQ(this->Add("d"), 51u);
  // Nor by a scene of the same name that is made again.
  v1::Command gone;
  gone.mutable_remove_scene();
  this->Accept(gone);
  v1::Command anew;
  anew.mutable_create_scene();
  this->Accept(anew);
  EXPECT_EQ(this->Add("a"), 52u);
}

TEST_F(TelemetryTest, LimitsSayHowAValueIs) {
  v1::Command define = Define("t", "Cel");
  v1::TelemetryLimits* limits = define.mutable_create_telemetry()->mutable_limits();
  limits->set_alarm_low(-20);
  limits->set_warning_low(-10);
  limits->set_warning_high(40);
  const std::uint64_t id = this->Accept(define).telemetry().channel(0).channel().id();
  const auto state = [&](double value) {
    this->Set({{id, value}});
    return this->Ask("t").state();
  };
  EXPECT_EQ(state(-20.5), Info::ALARM);
  EXPECT_EQ(state(-20.0), Info::WARNING); // on a limit is within it
  EXPECT_EQ(state(-10.5), Info::WARNING);
  EXPECT_EQ(state(-10.0), Info::GOOD);
  EXPECT_EQ(state(40.0), Info::GOOD);
  EXPECT_EQ(state(1e9), Info::WARNING); // there is no alarm limit above
  EXPECT_EQ(state(None), Info::NO_VALUE);

  v1::Command change;
  change.mutable_set_telemetry_limits()->set_id(id);
  change.mutable_set_telemetry_limits()->mutable_limits()->set_alarm_high(10);
  this->Accept(change);
  EXPECT_EQ(state(-20.5), Info::GOOD);
  EXPECT_EQ(state(10.5), Info::ALARM);
  EXPECT_EQ(this->Ask("t").channel().unit(), "Cel");
  v1::Command crossed = change;
  crossed.mutable_set_telemetry_limits()->mutable_limits()->set_warning_low(11);
  this->Reject(crossed, Kind::INVALID_ARGUMENT, "alarm_high is 10, below warning_low, 11");
  v1::Command endless = change;
  endless.mutable_set_telemetry_limits()->mutable_limits()->set_alarm_high(Infinite);
  this->Reject(endless, Kind::INVALID_ARGUMENT, "alarm_high is inf");
  change.mutable_set_telemetry_limits()->clear_limits();
  this->Accept(change);
  EXPECT_EQ(state(1e9), Info::GOOD);
}

TEST_F(TelemetryTest, ChoicesHaveLabels) {
  v1::Command define = Define("mode");
  v1::CreateTelemetry* create = define.mutable_create_telemetry();
  create->set_kind(v1::CreateTelemetry::CHOICE);
  this->Reject(define, Kind::INVALID_ARGUMENT, "0 labels");
  const auto add = [create](int value, const char* label) {
    create->add_label()->set_value(value);
    create->mutable_label(create->label_size() - 1)->set_label(label);
  };
  add(0, "idle");
  add(-3, "driving");
  v1::Command twice = define;
  twice.mutable_create_telemetry()->add_label()->set_label("idle");
  twice.mutable_create_telemetry()->mutable_label(2)->set_value(9);
  this->Reject(twice, Kind::INVALID_ARGUMENT, "occurs twice");
  const std::uint64_t id = this->Accept(define).telemetry().channel(0).channel().id();
  this->Set({{id, -3.0}});
  EXPECT_EQ(this->Ask("mode").text(), "driving");
  this->Reject(Values({{id, 1.0}}), Kind::INVALID_ARGUMENT, "a value with a label");
  this->Reject(Values({{id, -2.5}}), Kind::INVALID_ARGUMENT, "a value with a label");
  this->Set({{id, None}});
  EXPECT_EQ(this->Ask("mode").text(), "");
}

TEST_F(TelemetryTest, DefinitionsAreBoundedTogether) {
  v1::Command define = Define("");
  v1::CreateTelemetry* create = define.mutable_create_telemetry();
  create->set_kind(v1::CreateTelemetry::CHOICE);
  for (int i = 0; i < 1000; ++i) {
    create->add_label()->set_value(i);
    create->mutable_label(i)->set_label(std::to_string(i) + std::string(250, 'x'));
  }
  const std::size_t fit = (std::size_t(64) << 20) / define.ByteSizeLong();
  std::uint64_t id = 0;
  for (std::size_t i = 0; i < fit; ++i) {
    v1::Command command = define;
    command.mutable_create_telemetry()->set_name("choice" + std::to_string(i));
    const v1::Reply reply = this->Interpreter_.Execute(command);
    if (reply.has_error()) { // names and ids are bytes, too
      EXPECT_GE(i, fit - 1);
      break;
    }
    id = command.create_telemetry().id();
  }
  create->set_name("one more");
  v1::Reply reply = this->Interpreter_.Execute(define);
  EXPECT_EQ(reply.error().kind(), Kind::RESOURCE);
  EXPECT_NE(reply.error().message().find("64 MiB"), std::string::npos);
  v1::Command remove;
  remove.mutable_remove_telemetry()->add_id(id);
  this->Accept(remove);
  this->Accept(define);

  // Limits that are set later count, too: a snapshot makes the channel with them.
  remove.mutable_remove_telemetry()->set_id(0, define.create_telemetry().id());
  this->Accept(remove);
  std::vector<std::uint64_t> numbers;
  for (int i = 0; i < 40; ++i) {
    v1::Command number = Define("number" + std::to_string(i));
    this->Accept(number);
    numbers.push_back(number.create_telemetry().id());
  }
  for (int i = 0;; ++i) { // until less than a kilobyte of them is left
    ASSERT_LT(i, 1000);
    v1::Command filler = Define("filler" + std::to_string(i));
    filler.mutable_create_telemetry()->set_description(std::string(900, 'x'));
    if (this->Interpreter_.Execute(filler).has_error()) {
      break;
    }
  }
  const auto limit = [&](std::uint64_t number, bool some) {
    v1::Command command;
    v1::SetTelemetryLimits* set = command.mutable_set_telemetry_limits();
    set->set_id(number);
    if (some) { // 36 bytes
      set->mutable_limits()->set_alarm_low(1);
      set->mutable_limits()->set_warning_low(2);
      set->mutable_limits()->set_warning_high(3);
      set->mutable_limits()->set_alarm_high(4);
    }
    return this->Interpreter_.Execute(command).error();
  };
  const auto most = [&] {
    std::size_t accepted = 0;
    while (accepted < numbers.size()) {
      const v1::Error error = limit(numbers[accepted], true);
      if (!error.message().empty()) {
        EXPECT_EQ(error.kind(), Kind::RESOURCE);
        EXPECT_NE(error.message().find("64 MiB"), std::string::npos);
        break;
      }
      ++accepted;
    }
    return accepted;
  };
  const std::size_t first = most();
  EXPECT_LT(first, numbers.size());
  for (const std::uint64_t number : numbers) {
    EXPECT_TRUE(limit(number, false).message().empty());
  }
  EXPECT_EQ(most(), first); // those that were taken away count no more
}

TEST_F(TelemetryTest, ManyTextsAreWrittenOutInPieces) {
  v1::Command texts;
  for (int i = 0; i < 600; ++i) {
    texts.mutable_set_telemetry_texts()->add_id(this->AddText("t" + std::to_string(i)));
    texts.mutable_set_telemetry_texts()->add_text(std::string(4096, char('a' + i % 26)));
  }
  this->Accept(texts);
  std::vector<v1::Command> commands;
  this->Interpreter_.GetState().FindScene("scene").telemetry.Put("scene", commands);
  session::Interpreter second;
  v1::Command scene;
  scene.mutable_create_scene();
  second.Execute(scene);
  int pieces = 0;
  for (v1::Command& command : commands) {
    EXPECT_LT(command.ByteSizeLong(), std::size_t(1200000));
    pieces += command.has_set_telemetry_texts();
    ASSERT_FALSE(second.Execute(command).has_error());
  }
  EXPECT_EQ(pieces, 3);
  EXPECT_EQ(PictureOf(second), this->Picture());
}

TEST_F(TelemetryTest, TextsOverPicturesSayWhatThereIs) {
  const std::uint64_t power = this->Add("power", "W");
  const std::uint64_t note = this->AddText("note");
  const session::Telemetry& telemetry = this->Interpreter_.GetState().FindScene("scene").telemetry;
  v1::SetTextTable::Row row;
  row.set_telemetry("power");
  const auto shown = [&] { return session::ShownTelemetry(telemetry, row); };
  EXPECT_EQ(shown(), "\u2013");
  row.set_value("n/a");
  EXPECT_EQ(shown(), "n/a");
  this->Set({{power, 1234.5678}});
  EXPECT_EQ(shown(), "1234.57 W");
  row.set_digits(1);
  EXPECT_EQ(shown(), "1234.6 W");
  row.set_no_unit(true);
  EXPECT_EQ(shown(), "1234.6");
  row.set_digits(0);
  EXPECT_EQ(shown(), "1235");
  this->Set({{power, 1.7976931348623157e308}});
  row.set_digits(3);
  EXPECT_EQ(shown(), "1.798e+308");
  this->Set({{power, None}});
  EXPECT_EQ(shown(), "n/a");
  row.set_telemetry("note");
  EXPECT_EQ(shown(), "n/a");
  v1::Command text;
  text.mutable_set_telemetry_texts()->add_id(note);
  text.mutable_set_telemetry_texts()->add_text("all well");
  this->Accept(text);
  EXPECT_EQ(shown(), "all well");
  row.set_telemetry("nowhere");
  EXPECT_EQ(shown(), "n/a");
}

} // namespace
} // namespace dspace::testing
