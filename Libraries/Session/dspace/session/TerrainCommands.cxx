#include <dspace/session/Registry.h>
namespace dspace::session {
void AddTerrainCommands(Registry&) {}
} // namespace dspace::session
