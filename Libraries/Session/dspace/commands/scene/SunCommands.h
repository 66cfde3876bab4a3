// The Sun of a command.
#ifndef DSPACE_SESSION_SUN_COMMANDS_H
#define DSPACE_SESSION_SUN_COMMANDS_H

#include <dspace/interpreter/Registry.h>
#include <dspace/proto/common.pb.h>
#include <dspace/scene/Light.h>

namespace dspace::session {

// The light "sun" as a SunState of a command changes it; the scene keeps its own. Replaces
// `horizontal` of `sun` by a direction. Throws Error: as MovedSun and HorizontalAxes, and
// InvalidArgument for two directions and for a frame without a direction.
Light ChangedSun(const Context& context, v1::SunState& sun);

} // namespace dspace::session

#endif
