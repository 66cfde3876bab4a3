// Interface for drawing geometry that is not made of meshes, beside a DrawList's batches.
#ifndef DSPACE_RENDER_CUSTOM_DRAWER_H
#define DSPACE_RENDER_CUSTOM_DRAWER_H

#include <vector>

#include <dspace/render/Captions.h>
#include <dspace/render/DrawKey.h>
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
  // The target holds linear light in floats, which is exposed later where its alpha is not 0: what
  // has display values writes alpha 0.
  bool light = false;
};

// One a picture and geometry; made, used and destroyed with the window's context current. Depth is
// reversed and tested, culling and blending are off, and the target is bound while it draws.
class CustomDrawer {
public:
  virtual ~CustomDrawer() = default;
  // Uploads the data that the view needs, before its target is bound. Returns false if some data is
  // not loaded yet; with view.complete it waits instead (Error(DeadlineExceeded)). What is outside
  // the picture and may throw a shadow into it is prepared with `drawing.labels`.
  virtual bool Prepare(const CustomDrawing& drawing) = 0;
  // About how far from the camera [m], along the view's axis, the nearest of it that may be seen
  // is; after Prepare(). Shadow maps are fitted to it. 0: unknown.
  virtual double NearestDepth(const CustomDrawing&) { return 0.0; }
  // Whether its own shader says which shadows it throws on itself (a terrain's horizon): then the
  // maps that it is in are those of other receivers only (ShadowGround). After Prepare().
  virtual bool ShadowsItself(const CustomDrawing&) { return false; }
  // Where DrawLabels() may draw it in the drawing's view. By default all of its bounds. After
  // Prepare().
  virtual std::vector<LightHull> Hulls(const CustomDrawing& drawing);
  virtual void DrawColor(const CustomDrawing& drawing) = 0;
  // Whether DrawColor() lays display values that let light through over what it lights. It needs
  // `drawing.view.exposure` to expose the light alone. After Prepare().
  virtual bool MixesDisplayColors(const CustomDrawing&) { return false; }
  // Also into the Sun's shadow maps: `drawing.view.clip` is then set, and no label is kept.
  virtual void DrawLabels(const CustomDrawing& drawing) = 0;
  // Adds what DrawLabels() draws into a shadow map from, besides `drawing.view`'s clip, texel and
  // takes. Returns false if it does not know: such maps are drawn again for each picture. After
  // Prepare().
  virtual bool AddTo(DrawKey&, const CustomDrawing&) { return false; }
  // Photometric angles of what is lit, 0 where they are not known, as Photometry.glsl has them
  // (SurfaceShaders::Angles), and depth. Returns false, drawing nothing, if it knows none: what
  // DrawLabels() draws then hides the rest.
  virtual bool DrawAngles(const CustomDrawing&) { return false; }
  // What lets light pass, over the opaque picture in `target`, which is bound; its depth says what
  // hides it. The farthest geometry comes first, before the scene's translucent surfaces. Depth,
  // culling and blending are as for DrawColor().
  virtual void DrawTranslucent(const CustomDrawing&, const RenderTarget& /*target*/) {}
  // Captions over the picture, whose colours and depth are in `target`.
  virtual std::vector<Caption> Captions(const CustomDrawing&, const RenderTarget& /*target*/) {
    return {};
  }
};

} // namespace dspace

#endif
