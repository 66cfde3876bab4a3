// Commands that this version does not implement.
#include <dspace/interpreter/Interpreter.h>
#include <dspace/messages/ErrorReply.h>

namespace dspace::session {

void Registry::AddUnimplemented() {
  for (const CommandTraits& traits : CommandTraits::All()) {
    if (traits.GetEffect() != Effect::Unimplemented) {
      continue;
    }
    this->Entries_[v1::Command::CommandCase(traits.Number())] = {
        Effect::Unimplemented, Needs::Nothing, [](const Context& context, v1::Command& command) {
          const std::string name = "command " + CommandName(command);
          PutError(context.reply.mutable_error(), v1::Error::UNIMPLEMENTED, name,
                   name + ": this version does not implement it; accepted: a later version");
        }};
  }
}

} // namespace dspace::session
