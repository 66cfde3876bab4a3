// The sky commands.
#ifndef DSPACE_SESSION_SKY_TOOLS_H
#define DSPACE_SESSION_SKY_TOOLS_H

#include <dspace/interpreter/Registry.h>

namespace dspace::session {

void AddKernelCommands(Registry& registry);
void AddFrameMotions(Registry& registry);
void AddSkyRequests(Registry& registry);
void AddVisibilityRequests(Registry& registry);

} // namespace dspace::session

#endif
