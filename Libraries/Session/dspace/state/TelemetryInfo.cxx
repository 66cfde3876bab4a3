// How a channel stands, for requests and for texts over pictures.
#include <cmath>
#include <cstdio>

#include <dspace/state/Telemetry.h>

namespace dspace::session {
namespace {

const std::string* LabelOf(const Telemetry::Channel& channel) {
  for (const v1::CreateTelemetry::Label& each : channel.about.label()) {
    if (double(each.value()) == channel.value) {
      return &each.label();
    }
  }
  return nullptr;
}

} // namespace

v1::TelemetryInfo::State StateOf(const Telemetry::Channel& channel) {
  using I = v1::TelemetryInfo;
  const bool text = channel.about.kind() == v1::CreateTelemetry::TEXT;
  if (!channel.time_s || (!text && std::isnan(channel.value))) {
    return I::NO_VALUE;
  }
  const v1::TelemetryLimits& limits = channel.about.limits();
  if ((limits.has_alarm_low() && channel.value < limits.alarm_low()) ||
      (limits.has_alarm_high() && channel.value > limits.alarm_high())) {
    return I::ALARM;
  }
  if ((limits.has_warning_low() && channel.value < limits.warning_low()) ||
      (limits.has_warning_high() && channel.value > limits.warning_high())) {
    return I::WARNING;
  }
  return I::GOOD;
}

void PutInfo(const Telemetry::Channel& channel, v1::TelemetryInfo* info) {
  *info->mutable_channel() = channel.about;
  info->set_state(StateOf(channel));
  info->set_value(channel.value);
  info->set_text(channel.text);
  if (channel.about.kind() == v1::CreateTelemetry::CHOICE) {
    const std::string* label = LabelOf(channel);
    info->set_text(label ? *label : "");
  }
  if (channel.time_s) {
    info->set_time_s(*channel.time_s);
  }
}

std::string ShownTelemetry(const Telemetry& telemetry, const v1::SetTextTable::Row& row) {
  const Telemetry::Channel* channel = telemetry.Find(row.telemetry());
  if (!channel || StateOf(*channel) == v1::TelemetryInfo::NO_VALUE) {
    return row.value().empty() ? "\u2013" : row.value();
  }
  if (channel->about.kind() == v1::CreateTelemetry::TEXT) {
    return channel->text;
  }
  if (channel->about.kind() == v1::CreateTelemetry::CHOICE) {
    const std::string* label = LabelOf(*channel);
    return label ? *label : "?";
  }
  char text[64];
  if (!row.has_digits()) {
    std::snprintf(text, sizeof(text), "%.6g", channel->value);
  } else if (std::abs(channel->value) < 1e15) {
    std::snprintf(text, sizeof(text), "%.*f", int(row.digits()), channel->value);
  } else {
    std::snprintf(text, sizeof(text), "%.*e", int(row.digits()), channel->value);
  }
  const bool unit = !row.no_unit() && !channel->about.unit().empty();
  return text + (unit ? " " + channel->about.unit() : std::string());
}

} // namespace dspace::session
