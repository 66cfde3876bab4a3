// Functions that the sky commands share.
#ifndef DSPACE_SESSION_SKY_TOOLS_H
#define DSPACE_SESSION_SKY_TOOLS_H

#include <string>

#include <dspace/interpreter/Registry.h>

namespace dspace {
class Crs;
class KernelSet;
} // namespace dspace

namespace dspace::session {

// The body of a CRS (NAIF id), by its name or by its radius. Throws Error(InvalidArgument) that
// names `label` where it tells none.
int BodyOf(const KernelSet& kernels, const Crs& crs, const std::string& label);

void AddKernelCommands(Registry& registry);
void AddFrameMotions(Registry& registry);
void AddSkyRequests(Registry& registry);
void AddVisibilityRequests(Registry& registry);

} // namespace dspace::session

#endif
