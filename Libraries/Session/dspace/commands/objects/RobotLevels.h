// Coarser visuals of a robot's links, from URDF files of the same links.
#ifndef DSPACE_SESSION_ROBOT_LEVELS_H
#define DSPACE_SESSION_ROBOT_LEVELS_H

#include <vector>

#include <dspace/commands/objects/UrdfVisuals.h>

namespace dspace::session {

// The levels of each visual of each link of `urdf`, finest first: `finest` and those of
// command.level(), whose paths become absolute. Visuals of a link are paired in their order. Throws
// Error(InvalidArgument), naming the file and the link, for a link that `urdf` lacks and for
// another number of visuals.
std::vector<std::vector<std::vector<DetailLevel>>>
RobotLevels(const Context& context, v1::LoadRobot& command, const Urdf& urdf,
            std::vector<std::vector<UrdfGeometry>> finest, const ImportOptions& options);

} // namespace dspace::session

#endif
