// Functions that the terrain commands and requests share.
#ifndef DSPACE_SESSION_TERRAIN_TOOLS_H
#define DSPACE_SESSION_TERRAIN_TOOLS_H

#include <string>

#include <dspace/interpreter/Registry.h>

namespace dspace {
struct StreamedTerrainOptions;
}

namespace dspace::session {

class ClipmapTerrainObject;

// Throws Error(NotFound).
TerrainObject& FindTerrain(const Context& context, const std::string& name);

void DescribeTo(const Context& context, const TerrainObject& terrain, v1::TerrainReply* reply);

// `values` holds n points of `size` numbers; throws Error(InvalidArgument) for the first that is
// not finite.
void RequireFinitePoints(const std::string& label, const double* values, int size, std::size_t n);

// Adds the layer "drape" at the bottom. Makes its path absolute; warnings go to the reply. Throws
// what OpenImageLayer throws.
void AddDrape(const Context& context, ClipmapTerrainObject& terrain, v1::OpenTerrain::Drape& drape);

// Adds the layer "filled" on top, which marks ground without data. Throws what OpenFilledLayer
// throws.
void AddFilled(const Context& context, ClipmapTerrainObject& terrain,
               const StreamedTerrainOptions& options);

void AddTerrainRequests(Registry& registry);
void AddTerrainStyleCommands(Registry& registry);
void AddTerrainTrackCommands(Registry& registry);
void AddTerrainCacheCommands(Registry& registry);
void AddTerrainLayerCommands(Registry& registry);
void AddTerrainFieldCommands(Registry& registry);
void AddGeodesyRequests(Registry& registry);

} // namespace dspace::session

#endif
