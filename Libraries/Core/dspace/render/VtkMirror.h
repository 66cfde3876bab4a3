// A scene's camera and lights as VTK's, for props that VTK code adds to a viewport.
#ifndef DSPACE_RENDER_VTK_MIRROR_H
#define DSPACE_RENDER_VTK_MIRROR_H

#include <dspace/render/DrawList.h>

class vtkRenderer;

namespace dspace {

// In the root frame's coordinates. The projection is the view's own, with reversed depth.
void MirrorCamera(const Scene& scene, const DrawView& view, vtkRenderer* renderer);

// In place of the lights that are there. Ambient light has no counterpart in VTK and is left out.
void MirrorLights(const Scene& scene, vtkRenderer* renderer);

} // namespace dspace

#endif
