// Arrows in a picture's corner that show the root frame's axes.
#ifndef DSPACE_RENDER_CORNER_AXES_H
#define DSPACE_RENDER_CORNER_AXES_H

#include <memory>

#include <dspace/render/DrawList.h>
#include <dspace/render/SceneDrawer.h>

class vtkDspaceRenderContext;

namespace dspace {

// X red, Y green, Z blue: a scene of their own, seen along the camera's direction. One a viewport;
// the context outlives it.
class CornerAxes {
public:
  explicit CornerAxes(vtkDspaceRenderContext* context);

  // Over the lower left corner of `target`, which is bound and shows `scene` through `view`: a
  // sixth of its shorter side. The depth there is lost. The read-outs do not count them.
  void Draw(const Scene& scene, const DrawView& view, RenderTarget& target, int samples);

private:
  vtkDspaceRenderContext* Context_;
  Scene Axes_{"corner axes"};
  DrawList List_;
  std::unique_ptr<SceneDrawer> Drawer_; // made with the first picture: it needs OpenGL
};

} // namespace dspace

#endif
