// Where VTK draws the props of a scene: a renderer whose camera is at the origin, and a target.
#ifndef DSPACE_RENDER_PROP_CANVAS_H
#define DSPACE_RENDER_PROP_CANVAS_H

#include "vtkNew.h"

#include <dspace/render/CustomDrawer.h>
#include <dspace/render/EmptyVertexArray.h>
#include <dspace/render/RenderTarget.h>

class vtkOpenGLRenderer;
class vtkProp3D;
class vtkRendererCollection;

namespace dspace {

// One a render context. VTK's world coordinates are those of the view (X right, Y up, -Z forward),
// so that nothing is far from the origin but what is far from the camera. Every function needs the
// window's context to be current.
class PropCanvas {
public:
  explicit PropCanvas(vtkDspaceHubWindow* window);
  PropCanvas(const PropCanvas&) = delete;
  PropCanvas& operator=(const PropCanvas&) = delete;
  ~PropCanvas();

  // The prop's opaque geometry with reversed depth, into what is bound.
  void DrawOpaque(vtkProp3D* prop, const CustomDrawing& drawing);
  // Its depth alone, then `label` into what is bound (Label, with depth), where it is nearer.
  void DrawLabel(vtkProp3D* prop, const CustomDrawing& drawing, ObjectId label);
  // The same as linear light into what is bound (Light, with depth), with an alpha of 0: not
  // exposed.
  void DrawLinear(vtkProp3D* prop, const CustomDrawing& drawing);
  // Depth of its opaque surfaces into the shadow map that is bound, in the drawing's view.
  void DrawShadow(vtkProp3D* prop, const CustomDrawing& drawing);
  // Its translucent polygons and volumes, blended over what is in `target`, which is bound.
  void DrawTranslucent(vtkProp3D* prop, const CustomDrawing& drawing, const RenderTarget& target);

private:
  class Drawing;
  void SetView(const CustomDrawing& drawing, const Eigen::Matrix4d& clip, double near, double far);
  void SetLights(const DrawList& list);
  void DrawIntoTarget(vtkProp3D* prop, const CustomDrawing& drawing); // of black, cleared

  vtkDspaceHubWindow* Window_;
  vtkNew<vtkOpenGLRenderer> Renderer_;
  vtkNew<vtkRendererCollection> Renderers_;
  RenderTarget Target_; // of opaque props, for labels and linear light
  RenderTarget Layer_;  // of translucent props
  EmptyVertexArray EmptyVertices_;
};

} // namespace dspace

#endif
