// The ranges and defaults of command fields, as the .proto files state them (options.proto).
#ifndef DSPACE_SESSION_COMMAND_LIMITS_H
#define DSPACE_SESSION_COMMAND_LIMITS_H

#include <cstddef>
#include <string>

namespace dspace::v1 {
class Command;
}

namespace dspace::session {

// Throws Error(InvalidArgument) for the first number, at any depth, that is outside the range of
// its field. The error names the object, the field, the value and the range. A field that is
// absent, or 0 if that means absent, is accepted.
void RequireLimits(const v1::Command& command);

// The longest text that a field accepts [bytes]: `field` is its message and name, "LogEvent.text".
// Throws Error(Internal) for a field whose .proto states no length.
std::size_t MostBytes(const char* field);

// The scene of a command that names none: the default of Command.scene.
const std::string& DefaultScene();
// The name of the scene that the command applies to.
const std::string& SceneName(const v1::Command& command);

} // namespace dspace::session

#endif
