// A viewport's view through a lens: source views, and one picture of them.
#ifndef DSPACE_RENDER_LENS_VIEW_H
#define DSPACE_RENDER_LENS_VIEW_H

#include <memory>
#include <string>

#include "vtkNew.h"

#include <dspace/render/ColorPicture.h>
#include <dspace/render/EmptyVertexArray.h>
#include <dspace/render/RenderTarget.h>
#include <dspace/render/SurfaceShaders.h>
#include <dspace/render/ViewLens.h>

class vtkDspaceRenderContext;
class vtkTextureObject;

namespace dspace {

// Source pixels are interpolated in linear light, over the footprint of the picture's pixel where
// the sources are finer. An automatic exposure is that of the first source. The context must
// outlive it.
class LensView {
public:
  LensView(vtkDspaceRenderContext* context, std::shared_ptr<const ViewLens> lens);
  LensView(const LensView&) = delete;
  LensView& operator=(const LensView&) = delete;
  ~LensView();

  const ViewLens& Lens() const { return *this->Lens_; }
  void SetLens(std::shared_ptr<const ViewLens> lens);

  // The view of a source from that of the camera, `samples` a pixel across and down.
  DrawView SourceView(const DrawView& camera, std::size_t source, int samples) const;
  // Draws the sources and takes the picture from them. `request`: of the camera; its background is
  // one colour, the lower. Throws what ColorPicture::Draw throws.
  void Draw(const std::string& object, const Scene& scene, const ColorPicture::Request& request);
  // Copies the last picture to what is bound, of its size.
  void Show() const;
  // Of the last picture, as in ColorPicture.
  bool Complete() const { return this->Complete_; }
  double Exposure() const { return this->Exposure_; }

private:
  void Begin();
  void Take(std::size_t source);

  vtkDspaceRenderContext* Context_;
  std::shared_ptr<const ViewLens> Lens_;
  ColorPicture Source_;
  SurfaceShaders Shaders_;
  RenderTarget Picture_;
  vtkNew<vtkTextureObject> Places_;
  bool Uploaded_ = false; // Places_ are those of Lens_
  EmptyVertexArray EmptyVertices_;
  bool Complete_ = false;
  double Exposure_ = 1.0;
};

} // namespace dspace

#endif
