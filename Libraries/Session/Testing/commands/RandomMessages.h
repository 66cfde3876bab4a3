// Telemetry, events and questions at random: a part of RandomCommands.h.
#ifndef DSPACE_RANDOM_MESSAGES_H
#define DSPACE_RANDOM_MESSAGES_H

#include <cmath>

#include "RandomCommands.h"

namespace dspace::testing {

inline void RandomCommands::Telemetry(v1::Command& c) {
  const std::uint64_t channel = this->One<std::uint64_t>(this->Channels_, 1);
  switch (this->Up(8)) {
  case 0:
  case 1: {
    v1::CreateTelemetry* create = c.mutable_create_telemetry();
    create->set_name(this->Name("t", 3) + (this->Up(2) ? "/value" : ""));
    create->set_kind(v1::CreateTelemetry::Kind(this->Up(3)));
    create->set_description(this->Name("what", 3));
    if (create->kind() == v1::CreateTelemetry::NUMBER) {
      create->set_unit(this->Name("m", 2));
      if (this->Up(2)) {
        create->mutable_limits()->set_alarm_high(this->Real());
      }
    }
    for (int i = 0; create->kind() == v1::CreateTelemetry::CHOICE && i < 3; ++i) {
      create->add_label()->set_value(i - 1);
      create->mutable_label(i)->set_label("choice " + std::to_string(i));
    }
    return;
  }
  case 2:
    c.mutable_remove_telemetry()->add_id(channel);
    return;
  case 3:
    c.mutable_set_telemetry_limits()->set_id(channel);
    if (this->Up(2)) {
      c.mutable_set_telemetry_limits()->mutable_limits()->set_warning_low(this->Real());
    }
    return;
  case 4:
  case 5:
    c.mutable_set_telemetry_texts()->add_id(channel);
    c.mutable_set_telemetry_texts()->add_text(this->Up(3) ? this->Name("text", 5) : "");
    return;
  default:
    for (const std::uint64_t id : this->Channels_) { // of choices 0 is one
      if (this->Up(3)) {
        c.mutable_set_telemetry()->add_id(id);
        c.mutable_set_telemetry()->add_value(this->Up(4) ? 0.0 : std::nan(""));
      }
    }
    if (this->Up(2)) {
      c.mutable_set_telemetry()->clear_id();
      c.mutable_set_telemetry()->clear_value();
      c.mutable_set_telemetry()->add_id(channel);
      c.mutable_set_telemetry()->add_value(this->Up(2) ? this->Real() : 1.0);
    }
  }
}

inline void RandomCommands::Messages(v1::Command& c) {
  switch (this->Up(5)) {
  case 0:
    c.mutable_ask_operator()->set_name(this->Name("q", 4));
    c.mutable_ask_operator()->set_text(this->Name("really ", 9) + "?");
    if (this->Up(2)) {
      c.mutable_ask_operator()->add_choice("yes");
    }
    return;
  case 1:
    c.mutable_close_question()->set_name(this->Name("q", 4));
    if (this->Up(2)) {
      c.mutable_close_question()->set_answer("yes");
    }
    return;
  default: {
    v1::LogEvent* event = c.mutable_log_event();
    event->set_kind(this->Name("kind", 3));
    event->set_text(this->Name("text", 100));
    event->set_severity(v1::Severity(this->Up(4)));
    if (this->Up(2)) {
      event->set_frame(this->Frame());
      this->Put(event->mutable_position());
    }
    if (this->Up(4) == 0) {
      event->set_time_s(this->Real());
    }
  }
  }
}

} // namespace dspace::testing

#endif
