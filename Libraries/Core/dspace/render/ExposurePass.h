// Pictures in linear light: exposed, and taken through a tone curve.
#ifndef DSPACE_RENDER_EXPOSURE_PASS_H
#define DSPACE_RENDER_EXPOSURE_PASS_H

#include <memory>

#include <dspace/render/EmptyVertexArray.h>
#include <dspace/render/RenderTarget.h>
#include <dspace/render/SurfaceShaders.h>
#include <dspace/scene/ViewLook.h>

namespace dspace {

// The rules are those of ViewLook.h. The context must be current.
class ExposurePass {
public:
  explicit ExposurePass(vtkDspaceHubWindow* window);
  ExposurePass(const ExposurePass&) = delete;
  ExposurePass& operator=(const ExposurePass&) = delete;
  ~ExposurePass();

  // What the scene is drawn into (Light, with depth), of this size. Alpha is 0 where display values
  // are. Throws what RenderTarget::Resize throws.
  RenderTarget& Target(int width, int height);
  // The factor on the light that Target() has; an automatic exposure is found there.
  double FactorFor(const ViewLook& look);
  // From Target() into `target` (Display, with depth, of its size), colours and depth.
  void Resolve(ToneCurve tone, double factor, RenderTarget& target);

private:
  double Metered();

  vtkDspaceHubWindow* Window_;
  SurfaceShaders Shaders_;
  RenderTarget Light_;
  RenderTarget Luminances_;
  EmptyVertexArray EmptyVertices_;
};

} // namespace dspace

#endif
