// Telemetry: named values of a simulation.
#include <algorithm>

#include <dspace/Checks.h>
#include <dspace/interpreter/Registry.h>

namespace dspace::session {
namespace {

void List(const Context& context, const Telemetry::Channel& channel) {
  PutInfo(channel, context.reply.mutable_telemetry()->add_channel());
}

void CreateTelemetry(const Context& context, v1::CreateTelemetry& command) {
  // Ids are unique in the session, so that a recreated scene has other ids.
  const std::uint64_t id =
      context.scene->telemetry.Create(command, context.state.lastTelemetryId + 1);
  context.state.lastTelemetryId = std::max(context.state.lastTelemetryId, id);
  command.set_id(id);
  List(context, context.scene->telemetry.Get(id));
}

void ListTelemetry(const Context& context, v1::ListTelemetry& command) {
  const Telemetry& telemetry = context.scene->telemetry;
  context.reply.mutable_telemetry();
  const bool named = command.id_size() > 0 || command.name_size() > 0;
  if (named && !command.below().empty()) {
    Reject("command list_telemetry", "ids or names are given, and below is '" + command.below() +
                                         "'; accepted: one or the other");
  }
  for (const std::uint64_t id : command.id()) {
    List(context, telemetry.Get(id));
  }
  for (const std::string& name : command.name()) {
    List(context, telemetry.Get(name));
  }
  if (named) {
    return;
  }
  const std::string& below = command.below();
  for (const auto& [name, id] : telemetry.Names()) {
    const bool in = below.empty() || name == below ||
                    (name.size() > below.size() && name[below.size()] == '/' &&
                     name.compare(0, below.size(), below) == 0);
    if (in) {
      List(context, telemetry.Get(id));
    }
  }
}

} // namespace

void AddTelemetryCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreateTelemetry, &C::mutable_create_telemetry, CreateTelemetry);
  registry.Add(C::kSetTelemetryLimits, &C::mutable_set_telemetry_limits,
               [](const Context& context, v1::SetTelemetryLimits& command) {
                 context.scene->telemetry.SetLimits(command);
               });
  registry.Add(C::kSetTelemetry, &C::mutable_set_telemetry,
               [](const Context& context, v1::SetTelemetry& command) {
                 context.scene->telemetry.Set(command, context.GetScene().Time());
               });
  registry.Add(C::kSetTelemetryTexts, &C::mutable_set_telemetry_texts,
               [](const Context& context, v1::SetTelemetryTexts& command) {
                 context.scene->telemetry.SetTexts(command, context.GetScene().Time());
               });
  registry.Add(C::kRemoveTelemetry, &C::mutable_remove_telemetry,
               [](const Context& context, v1::RemoveTelemetry& command) {
                 context.scene->telemetry.Remove(command);
               });
  registry.Add(C::kListTelemetry, &C::mutable_list_telemetry, ListTelemetry);
}

} // namespace dspace::session
