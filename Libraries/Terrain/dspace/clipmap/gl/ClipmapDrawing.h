// Makes a render context draw clipmap terrain.
#ifndef DSPACE_TERRAIN_CLIPMAPDRAWING_H
#define DSPACE_TERRAIN_CLIPMAPDRAWING_H

namespace dspace {

class CustomDrawers;

// From now on the context with these drawers (vtkDspaceRenderContext::GetDrawers) draws a
// ClipmapTerrain. Any number of calls. A vtkDspaceSession has called it for its context.
void RegisterClipmapDrawer(CustomDrawers& drawers);

} // namespace dspace

#endif
