// Draws a VtkPropGeometry with VTK.
#ifndef DSPACE_RENDER_VTK_PROP_DRAWER_H
#define DSPACE_RENDER_VTK_PROP_DRAWER_H

#include <memory>

#include <dspace/render/CustomDrawer.h>

namespace dspace {

class CustomDrawers;
class PropCanvas;
class VtkPropGeometry;

// From now on the context with these drawers draws props. Any number of calls.
void RegisterVtkPropDrawer(CustomDrawers& drawers);

// Opaque geometry is in colours, depth and labels; translucent polygons and volumes are blended
// over the opaque picture and are in no other plane. The last drawer of a prop releases its
// graphics resources.
class VtkPropDrawer : public CustomDrawer {
public:
  // What the drawers of a context share; it is there while one of them is.
  using Shared = std::shared_ptr<std::weak_ptr<PropCanvas>>;
  // The geometry is not kept alive: it is drawn while a scene has it, and then this goes, too.
  VtkPropDrawer(const VtkPropGeometry& geometry, Shared shared);
  ~VtkPropDrawer() override;

  bool Prepare(const CustomDrawing& drawing) override;
  void DrawColor(const CustomDrawing& drawing) override;
  void DrawLabels(const CustomDrawing& drawing) override;
  void DrawTranslucent(const CustomDrawing& drawing, const RenderTarget& target) override;

private:
  struct Resources;
  const VtkPropGeometry* Geometry_;
  Shared Shared_;
  std::shared_ptr<PropCanvas> Canvas_;
  std::shared_ptr<Resources> Resources_;
};

} // namespace dspace

#endif
