#include <dspace/render/LensView.h>

#include <utility>

#include "vtk_glew.h"

#include "Lens_frag.h"

#include "vtkDspaceHubWindow.h"
#include "vtkDspaceRenderContext.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"
#include "vtkTextureObject.h"

#include <dspace/Error.h>

namespace dspace {

LensView::LensView(vtkDspaceRenderContext* context, std::shared_ptr<const ViewLens> lens)
    : Context_(context), Lens_(std::move(lens)), Shaders_(context->GetHub()),
      Picture_(context->GetHub(), RenderTarget::Format::Display, RenderTarget::DepthFormat::None),
      EmptyVertices_(context->GetHub()) {
  this->Source_.Connect(context);
}

LensView::~LensView() {
  vtkDspaceHubWindow* hub = this->Context_->GetHub();
  if (hub->GetContext()) {
    hub->MakeCurrent();
    this->Places_->ReleaseGraphicsResources(hub);
  }
}

void LensView::SetLens(std::shared_ptr<const ViewLens> lens) {
  this->Lens_ = std::move(lens);
  this->Uploaded_ = false;
}

DrawView LensView::SourceView(const DrawView& camera, std::size_t source, int samples) const {
  const ViewLens::Source& from = this->Lens_->sources[source];
  DrawView view = camera;
  view.camera.X_FC = camera.camera.X_FC * from.X_CF;
  view.projection = from.projection;
  view.width = from.width * samples;
  view.height = from.height * samples;
  view.samples = samples;
  return view;
}

// A black picture, and the places on the GPU.
void LensView::Begin() {
  vtkDspaceHubWindow* hub = this->Context_->GetHub();
  hub->MakeCurrent();
  const ViewLens& lens = *this->Lens_;
  this->Picture_.Resize(lens.width, lens.height);
  if (!this->Uploaded_) {
    std::vector<ViewLens::Place> places = lens.places; // VTK takes no constant data
    this->Places_->SetContext(hub);
    this->Places_->SetMinificationFilter(vtkTextureObject::Nearest);
    this->Places_->SetMagnificationFilter(vtkTextureObject::Nearest);
    if (!this->Places_->Create2DFromRaw(static_cast<unsigned>(lens.width),
                                        static_cast<unsigned>(lens.height), 4, VTK_FLOAT,
                                        places.data())) {
      throw Error(Error::Kind::Resource, "picture through a lens",
                  "OpenGL has no memory for the places of its pixels; ask for a smaller one");
    }
    this->Uploaded_ = true;
  }
  vtkOpenGLState* state = hub->GetState();
  state->PushFramebufferBindings();
  this->Picture_.Bind();
  state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  state->vtkglClearColor(0.0f, 0.0f, 0.0f, 1.0f);
  state->vtkglClear(GL_COLOR_BUFFER_BIT);
  state->PopFramebufferBindings();
}

void LensView::Take(std::size_t source) {
  vtkDspaceHubWindow* hub = this->Context_->GetHub();
  hub->MakeCurrent();
  vtkOpenGLState* state = hub->GetState();
  state->PushFramebufferBindings();
  this->Picture_.Bind();
  glEnable(GL_FRAMEBUFFER_SRGB);
  state->vtkglDisable(GL_DEPTH_TEST);
  state->vtkglDisable(GL_BLEND);
  BindTextureUnit(hub, ColorUnit, GL_TEXTURE_2D, this->Source_.Texture());
  BindTextureUnit(hub, OpaqueDepthUnit, GL_TEXTURE_2D, this->Places_->GetHandle());
  vtkShaderProgram* program = this->Shaders_.Screen(Lens_frag);
  program->SetUniformi("source", ColorUnit);
  program->SetUniformi("places", OpaqueDepthUnit);
  program->SetUniformi("number", int(source));
  this->EmptyVertices_.DrawScreen();
  state->vtkglEnable(GL_DEPTH_TEST);
  state->vtkglEnable(GL_BLEND);
  glDisable(GL_FRAMEBUFFER_SRGB);
  state->PopFramebufferBindings();
}

void LensView::Draw(const std::string& object, const Scene& scene,
                    const ColorPicture::Request& request) {
  this->Begin();
  this->Complete_ = true;
  for (std::size_t i = 0; i < this->Lens_->sources.size(); ++i) {
    ColorPicture::Request source = request;
    source.view = this->SourceView(request.view, i, request.samples);
    source.background.top = source.background.bottom;
    source.overlays = false;
    source.axes = nullptr;
    if (i > 0 && source.view.look.automaticExposure) {
      source.view.look.automaticExposure = false;
      source.view.look.exposure = this->Exposure_;
    }
    this->Source_.Draw(object, scene, source);
    this->Complete_ = this->Complete_ && this->Source_.Complete();
    this->Exposure_ = i == 0 ? this->Source_.Exposure() : this->Exposure_;
    this->Take(i);
  }
}

void LensView::Show() const {
  vtkOpenGLState* state = this->Context_->GetHub()->GetState();
  state->PushReadFramebufferBinding();
  this->Picture_.Framebuffer()->Bind(GL_READ_FRAMEBUFFER);
  this->Picture_.Framebuffer()->ActivateReadBuffer(0);
  const int width = this->Lens_->width, height = this->Lens_->height;
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  state->PopReadFramebufferBinding();
}

} // namespace dspace
