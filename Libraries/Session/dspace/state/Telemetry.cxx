#include <dspace/state/Telemetry.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include <dspace/Checks.h>
#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/TextChecks.h>
#include <dspace/overlay/TextCharacters.h>

namespace dspace::session {
namespace {

constexpr std::size_t MaximumChannels = 100000;
constexpr std::size_t MaximumBytes = 64u << 20; // of all definitions
constexpr std::size_t PutBytes = 1u << 20;      // of a command that Put makes, about
constexpr int MaximumLabels = 1000;
constexpr std::uint64_t MaximumId = std::uint64_t(1) << 63;

std::string Label(const std::string& name) {
  return "telemetry " + QuotedText(name);
}

// Names joined by '/', as paths of frames are.
void CheckName(const std::string& name) {
  const std::string label = Label(name);
  RequireWord(label, "its name", name, MostBytes("CreateTelemetry.name"));
  std::size_t begin = 0;
  for (;;) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    const std::string part = name.substr(begin, end - begin);
    if (part.empty() || part == "." || part == "..") {
      Reject(label, "a part of its name is '" + part +
                        "'; accepted: names joined by '/', none of them empty, '.' or '..'");
    }
    if (end == name.size()) {
      return;
    }
    begin = end + 1;
  }
}

void CheckLimits(const std::string& label, const v1::TelemetryLimits& limits) {
  const std::pair<const char*, std::optional<double>> all[] = {
      {"alarm_low",
       limits.has_alarm_low() ? std::optional<double>(limits.alarm_low()) : std::nullopt},
      {"warning_low",
       limits.has_warning_low() ? std::optional<double>(limits.warning_low()) : std::nullopt},
      {"warning_high",
       limits.has_warning_high() ? std::optional<double>(limits.warning_high()) : std::nullopt},
      {"alarm_high",
       limits.has_alarm_high() ? std::optional<double>(limits.alarm_high()) : std::nullopt}};
  const char* before = nullptr;
  double last = 0.0;
  for (const auto& [name, value] : all) {
    if (!value) {
      continue;
    }
    RequireFinite(label, name, *value);
    if (before && *value < last) {
      Reject(label, std::string(name) + " is " + NumberText(*value) + ", below " + before + ", " +
                        NumberText(last) +
                        "; accepted: alarm_low <= warning_low <= warning_high "
                        "<= alarm_high");
    }
    before = name;
    last = *value;
  }
}

void CheckLabels(const std::string& label, const v1::CreateTelemetry& command) {
  const bool choice = command.kind() == v1::CreateTelemetry::CHOICE;
  if (choice ? command.label_size() < 1 || command.label_size() > MaximumLabels
             : command.label_size() > 0) {
    Reject(label, "it has " + std::to_string(command.label_size()) + " labels; accepted: " +
                      (choice ? "1 to 1,000 for a choice" : "labels of a choice only"));
  }
  std::set<std::int32_t> values;
  std::set<std::string> texts;
  for (const v1::CreateTelemetry::Label& each : command.label()) {
    RequireWord(label, "a label", each.label(), MostBytes("CreateTelemetry.Label.label"));
    if (!values.insert(each.value()).second || !texts.insert(each.label()).second) {
      Reject(label, "its label " + QuotedText(each.label()) + " of value " +
                        std::to_string(each.value()) + " occurs twice; accepted: each once");
    }
  }
}

bool HasLabel(const v1::CreateTelemetry& about, double value) {
  return std::any_of(about.label().begin(), about.label().end(),
                     [value](const auto& each) { return double(each.value()) == value; });
}

// All NaNs are one: there is no value.
bool Same(double a, double b) {
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): equal bits, so that -0 and 0 differ.
  return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof(a)) == 0;
}

} // namespace

std::uint64_t Telemetry::Create(const v1::CreateTelemetry& command, std::uint64_t free) {
  const std::string label = Label(command.name());
  CheckName(command.name());
  if (!v1::CreateTelemetry::Kind_IsValid(command.kind())) {
    Reject(label, "its kind is " + std::to_string(int(command.kind())) + "; accepted: 0 to 2");
  }
  const bool number = command.kind() == v1::CreateTelemetry::NUMBER;
  RequireLine(label, "its unit", command.unit(), MostBytes("CreateTelemetry.unit"));
  RequireLine(label, "its description", command.description(),
              MostBytes("CreateTelemetry.description"));
  if (!number && (!command.unit().empty() || command.has_limits())) {
    Reject(label, "it has a unit or limits; accepted: units and limits of numbers only");
  }
  CheckLabels(label, command);
  CheckLimits(label, command.limits());
  if (this->Names_.count(command.name())) {
    throw Error(Error::Kind::AlreadyExists, label, "there is a channel of this name already");
  }
  const std::uint64_t id = command.id() == 0 ? free : command.id();
  if (id <= this->LastId_ || id >= MaximumId) {
    Reject(label, "its id is " + std::to_string(id) + "; accepted: above " +
                      std::to_string(this->LastId_) + " and below 2^63, or 0");
  }
  Channel channel;
  channel.about = command;
  channel.about.set_id(id);
  channel.defined = channel.about.ByteSizeLong();
  const std::size_t bytes = this->Bytes_ + channel.defined;
  if (this->Channels_.size() >= MaximumChannels || bytes > MaximumBytes) {
    throw Error(Error::Kind::Resource, label,
                "the scene has " + std::to_string(this->Channels_.size()) + " channels of " +
                    std::to_string(this->Bytes_) + " bytes; accepted: up to 100,000 and 64 MiB");
  }
  this->Channels_.emplace(id, std::move(channel));
  this->Names_.emplace(command.name(), id);
  this->Bytes_ = bytes;
  this->LastId_ = id;
  ++this->Revision_;
  return id;
}

Telemetry::Channel& Telemetry::At(std::uint64_t id) {
  return const_cast<Channel&>(this->Get(id));
}

const Telemetry::Channel& Telemetry::Get(std::uint64_t id) const {
  const auto found = this->Channels_.find(id);
  if (found == this->Channels_.end()) {
    throw Error(Error::Kind::NotFound, "telemetry channel " + std::to_string(id),
                "there is no such channel");
  }
  return found->second;
}

const Telemetry::Channel& Telemetry::Get(const std::string& name) const {
  const Channel* found = this->Find(name);
  if (!found) {
    throw Error(Error::Kind::NotFound, Label(name), "there is no such channel");
  }
  return *found;
}

const Telemetry::Channel* Telemetry::Find(const std::string& name) const {
  const auto found = this->Names_.find(name);
  return found == this->Names_.end() ? nullptr : &this->Channels_.at(found->second);
}

void Telemetry::SetLimits(const v1::SetTelemetryLimits& command) {
  Channel& channel = this->At(command.id());
  const std::string label = Label(channel.about.name());
  if (channel.about.kind() != v1::CreateTelemetry::NUMBER) {
    Reject(label, "it is not a number; accepted: limits of numbers only");
  }
  CheckLimits(label, command.limits());
  v1::CreateTelemetry about = channel.about;
  if (command.has_limits()) {
    *about.mutable_limits() = command.limits();
  } else {
    about.clear_limits();
  }
  const std::size_t defined = about.ByteSizeLong();
  const std::size_t bytes = this->Bytes_ - channel.defined + defined;
  if (defined > channel.defined && bytes > MaximumBytes) {
    throw Error(Error::Kind::Resource, label,
                "with these limits the definitions of the scene's channels have " +
                    std::to_string(bytes) + " bytes; accepted: up to 64 MiB");
  }
  channel.about = std::move(about);
  channel.defined = defined;
  this->Bytes_ = bytes;
  ++this->Revision_;
}

// The channels of a step, all that texts and numbers have in common checked.
template<class Command, class Values>
std::vector<Telemetry::Channel*> Telemetry::Check(const Command& command, const Values& values,
                                                  const char* name) {
  const std::string label = std::string("command ") + name;
  if (values.size() != command.id_size() ||
      (command.time_s_size() != 0 && command.time_s_size() != command.id_size())) {
    Reject(label, std::to_string(values.size()) + " values and " +
                      std::to_string(command.time_s_size()) + " times are given for " +
                      std::to_string(command.id_size()) +
                      " channels; accepted: one value each, and one time each or no times");
  }
  std::vector<Channel*> channels;
  channels.reserve(std::size_t(command.id_size()));
  ++this->Step_;
  for (int i = 0; i < command.id_size(); ++i) {
    Channel& channel = this->At(command.id(i));
    if (channel.step == this->Step_) {
      Reject(Label(channel.about.name()), "it occurs twice in " + label + "; accepted: once");
    }
    channel.step = this->Step_;
    channels.push_back(&channel);
    if (command.time_s_size() > 0) {
      RequireFinite(Label(channel.about.name()), "its time", command.time_s(i));
    }
  }
  return channels;
}

void Telemetry::Set(const v1::SetTelemetry& command, double now) {
  const std::vector<Channel*> channels = this->Check(command, command.value(), "set_telemetry");
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const v1::CreateTelemetry& about = channels[i]->about;
    const double value = command.value(int(i));
    if (about.kind() == v1::CreateTelemetry::TEXT) {
      Reject(Label(about.name()), "it is a text; accepted: command set_telemetry_texts");
    }
    if (std::isinf(value)) {
      Reject(Label(about.name()),
             "its value is " + NumberText(value) + "; accepted: a finite number, or NaN for none");
    }
    if (about.kind() == v1::CreateTelemetry::CHOICE && !std::isnan(value) &&
        !HasLabel(about, value)) {
      Reject(Label(about.name()), "its value is " + NumberText(value) +
                                      "; accepted: a value with a label, or NaN for none");
    }
  }
  for (std::size_t i = 0; i < channels.size(); ++i) {
    Channel& channel = *channels[i];
    const double value = command.value(int(i));
    const bool given = command.time_s_size() > 0;
    if (given || !channel.time_s || !Same(channel.value, value)) {
      channel.value = std::isnan(value) ? std::numeric_limits<double>::quiet_NaN() : value;
      channel.time_s = given ? command.time_s(int(i)) : now;
      ++this->Revision_;
    }
  }
}

void Telemetry::SetTexts(const v1::SetTelemetryTexts& command, double now) {
  const std::vector<Channel*> channels =
      this->Check(command, command.text(), "set_telemetry_texts");
  const std::size_t most = MostBytes("SetTelemetryTexts.text");
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const v1::CreateTelemetry& about = channels[i]->about;
    if (about.kind() != v1::CreateTelemetry::TEXT) {
      Reject(Label(about.name()), "it is a number; accepted: command set_telemetry");
    }
    RequireLine(Label(about.name()), "its text", command.text(int(i)), most);
  }
  for (std::size_t i = 0; i < channels.size(); ++i) {
    Channel& channel = *channels[i];
    const bool given = command.time_s_size() > 0;
    if (given || !channel.time_s || channel.text != command.text(int(i))) {
      channel.text = command.text(int(i));
      channel.time_s = given ? command.time_s(int(i)) : now;
      ++this->Revision_;
    }
  }
}

void Telemetry::Remove(const v1::RemoveTelemetry& command) {
  std::set<std::uint64_t> ids;
  for (const std::uint64_t id : command.id()) {
    const Channel& channel = this->Get(id);
    if (!ids.insert(id).second) {
      Reject(Label(channel.about.name()),
             "it occurs twice in command remove_telemetry; accepted: once");
    }
  }
  for (const std::uint64_t id : ids) {
    this->Bytes_ -= this->Channels_.at(id).defined;
    this->Names_.erase(this->Channels_.at(id).about.name());
    this->Channels_.erase(id);
    ++this->Revision_;
  }
}

void Telemetry::Put(const std::string& scene, std::vector<v1::Command>& out) const {
  std::vector<const Channel*> channels;
  for (const auto& [id, channel] : this->Channels_) {
    channels.push_back(&channel);
  }
  std::sort(channels.begin(), channels.end(),
            [](const auto* a, const auto* b) { return a->about.id() < b->about.id(); });
  v1::Command numbers;
  v1::Command texts;
  std::size_t bytes = 0; // of texts
  const auto flush = [&](v1::Command& command) {
    if (command.command_case() != v1::Command::COMMAND_NOT_SET) {
      command.set_scene(scene);
      out.push_back(std::move(command));
    }
    command = {};
  };
  for (const Channel* channel : channels) {
    out.emplace_back().set_scene(scene);
    *out.back().mutable_create_telemetry() = channel->about;
    if (!channel->time_s) {
      continue;
    }
    if (channel->about.kind() == v1::CreateTelemetry::TEXT) {
      v1::SetTelemetryTexts& set = *texts.mutable_set_telemetry_texts();
      set.add_id(channel->about.id());
      set.add_text(channel->text);
      set.add_time_s(*channel->time_s);
      bytes += channel->text.size() + 16;
      if (bytes > PutBytes) {
        flush(texts);
        bytes = 0;
      }
    } else {
      v1::SetTelemetry& set = *numbers.mutable_set_telemetry();
      set.add_id(channel->about.id());
      set.add_value(channel->value);
      set.add_time_s(*channel->time_s);
      if (std::size_t(set.id_size()) * 24 > PutBytes) {
        flush(numbers);
      }
    }
  }
  flush(numbers);
  flush(texts);
}

} // namespace dspace::session
