// Commands that are typed (measurements.proto) and that this version does not carry out.
#include <dspace/interpreter/Interpreter.h>
#include <dspace/messages/ErrorReply.h>

namespace dspace::session {

void Registry::AddLater(v1::Command::CommandCase kind) {
  this->Entries_[kind] = {
      Effect::Request, Needs::Nothing, [](const Context& context, v1::Command& command) {
        const std::string name = "command " + CommandName(command);
        PutError(context.reply.mutable_error(), v1::Error::UNIMPLEMENTED, name,
                 name + ": it is typed, and this version does not carry it out yet; "
                        "accepted: a later version");
      }};
}

void AddLaterCommands(Registry& registry) {
  using C = v1::Command;
  for (const C::CommandCase kind :
       {C::kLineOfSight, C::kLitArea, C::kHorizon, C::kHorizonMap, C::kViewshed,
        C::kIlluminationMap, C::kSimulateImage, C::kProjectPoints, C::kUnprojectPixels,
        C::kEphemeris, C::kSkyState}) {
    registry.AddLater(kind);
  }
}

} // namespace dspace::session
