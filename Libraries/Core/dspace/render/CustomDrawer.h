// Interface for drawing geometry that is not made of meshes, beside a DrawList's batches.
#ifndef DSPACE_RENDER_CUSTOM_DRAWER_H
#define DSPACE_RENDER_CUSTOM_DRAWER_H

#include <vector>

#include <dspace/render/Captions.h>
#include <dspace/render/DrawList.h>

class vtkDspaceHubWindow;

namespace dspace {

class GpuStore;
class RenderTarget;
class SurfaceShaders;
struct RenderStatistics;

// One drawing of one object.
struct CustomDrawing {
  const DrawCustom& object;
  const DrawList& list; // its lights
  const DrawView& view;
  int samples; // supersampling: pixels are this much larger
  vtkDspaceHubWindow* window;
  SurfaceShaders& shaders;
  GpuStore& store;
  RenderStatistics& statistics;
  bool labels = false; // no colours are drawn: labels and depths only
};

// One a picture and geometry; made, used and destroyed with the window's context current. Depth is
// reversed and tested, culling and blending are off, and the target is bound while it draws.
class CustomDrawer {
public:
  virtual ~CustomDrawer() = default;
  // Uploads the data that the view needs, before its target is bound. Returns false if some data is
  // not loaded yet; with view.complete it waits instead (Error(DeadlineExceeded)).
  virtual bool Prepare(const CustomDrawing& drawing) = 0;
  virtual void DrawColor(const CustomDrawing& drawing) = 0;
  virtual void DrawLabels(const CustomDrawing& drawing) = 0;
  // Captions over the picture, whose colours and depth are in `target`.
  virtual std::vector<Caption> Captions(const CustomDrawing&, const RenderTarget& /*target*/) {
    return {};
  }
};

} // namespace dspace

#endif
