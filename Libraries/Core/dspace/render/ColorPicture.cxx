#include <dspace/render/ColorPicture.h>

#include <exception>

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceRenderer.h"
#include "vtkOpenGLRenderer.h"
#include "vtkOpenGLState.h"
#include "vtkPropCollection.h"
#include "vtkRendererCollection.h"

#include <dspace/Error.h>
#include <dspace/render/CornerAxes.h>
#include <dspace/render/VtkMirror.h>
#include <dspace/render/messages/VtkErrorTrap.h>

namespace dspace {

ColorPicture::ColorPicture() = default;

ColorPicture::~ColorPicture() {
  if (!this->Context_) {
    return;
  }
  vtkDspaceHubWindow* hub = this->Context_->GetHub();
  if (hub->GetContext()) {
    hub->MakeCurrent();
    hub->Deactivate();
    // Not RemoveRenderer: it would release the resources of props that other viewports show.
    this->Renderer_->RemoveAllViewProps();
    this->Overlay_->RemoveAllViewProps();
    this->Renderer_->SetRenderWindow(nullptr);
    this->Overlay_->SetRenderWindow(nullptr);
  }
}

void ColorPicture::Connect(vtkDspaceRenderContext* context) {
  this->Context_ = context;
  this->SceneRenderers_->AddItem(this->Renderer_);
  this->OverlayRenderers_->AddItem(this->Overlay_);
  this->Renderer_->SetRenderWindow(context->GetHub());
  this->Overlay_->SetRenderWindow(context->GetHub());
  this->Renderer_->AutomaticLightCreationOff();
  this->Overlay_->SetPreserveColorBuffer(1);
  this->Overlay_->GetActiveCamera(); // else VTK resets it at the first picture
  this->Renderer_->GetActiveCamera();
  this->DrawNothing();
}

// VTK code may render the window itself: its props are drawn on what is there.
void ColorPicture::DrawNothing() {
  this->Renderer_->ClearPicture = [] {};
  this->Renderer_->DrawScene = [] {};
}

void ColorPicture::PrepareTargets(int width, int height, int samples) {
  vtkDspaceHubWindow* hub = this->Context_->GetHub();
  using Format = RenderTarget::Format;
  if (!this->DisplayTarget_) {
    this->DisplayTarget_ =
        std::make_unique<RenderTarget>(hub, Format::Display, RenderTarget::DepthFormat::Float);
  }
  this->DisplayTarget_->Resize(width, height);
  if (samples == 1) { // the scene is drawn into the picture itself
    this->SceneTarget_.reset();
    return;
  }
  if (!this->SceneTarget_) {
    this->SceneTarget_ =
        std::make_unique<RenderTarget>(hub, Format::Display, RenderTarget::DepthFormat::Float);
  }
  this->SceneTarget_->Resize(width * samples, height * samples);
}

RenderTarget& ColorPicture::DrawnTarget() const {
  return this->SceneTarget_ ? *this->SceneTarget_ : *this->DisplayTarget_;
}

void ColorPicture::ActivateScene() {
  const RenderTarget& target = this->DrawnTarget();
  this->Context_->GetHub()->Activate(
      {target.Framebuffer(), this->SceneRenderers_, target.Width(), target.Height()});
}

void ColorPicture::ActivateDisplay() {
  const RenderTarget& target = *this->DisplayTarget_;
  this->Context_->GetHub()->Activate(
      {target.Framebuffer(), this->OverlayRenderers_, target.Width(), target.Height()});
}

void ColorPicture::Activate(int width, int height, int samples) {
  this->Context_->GetHub()->MakeCurrent();
  this->PrepareTargets(width, height, samples);
  this->ActivateScene();
}

void ColorPicture::DrawScene(const DrawView& view, const Request& request) {
  RenderTarget& drawn = this->DrawnTarget();
  if (ExposedByLights(view.look)) {
    this->Exposure_.reset();
    this->UsedExposure_ = view.look.exposure;
    this->Drawer_->DrawColor(this->List_, view, drawn, request.samples, &request.background);
    return;
  }
  vtkDspaceHubWindow* hub = this->Context_->GetHub();
  if (!this->Exposure_) {
    this->Exposure_ = std::make_unique<ExposurePass>(hub);
  }
  RenderTarget& light = this->Exposure_->Target(drawn.Width(), drawn.Height());
  DrawView exposed = view;
  const auto draw = [&] {
    vtkOpenGLState* state = hub->GetState();
    state->PushFramebufferBindings();
    light.Bind();
    this->Drawer_->ClearLight(request.background);
    this->Drawer_->DrawColor(this->List_, exposed, light, request.samples, &request.background);
    state->PopFramebufferBindings();
  };
  if (!view.look.automaticExposure) {
    exposed.exposure = view.look.exposure;
  }
  draw();
  this->UsedExposure_ = this->Exposure_->FactorFor(view.look);
  if (!exposed.exposure && this->Drawer_->MixesDisplayColors(this->List_, view, request.samples)) {
    exposed.exposure = this->UsedExposure_;
    draw();
  }
  this->Exposure_->Resolve(view.look.tone, this->UsedExposure_, drawn);
}

void ColorPicture::Draw(const std::string& object, const Scene& scene, const Request& request) {
  DrawView view = request.view; // with its depths, once the list is built
  const int samples = request.samples;
  vtkDspaceHubWindow* hub = this->Context_->GetHub();
  VtkErrorTrap trap(this->Context_->GetMessages());
  hub->MakeCurrent();
  try {
    this->PrepareTargets(view.width / samples, view.height / samples, samples);
  } catch (const Error& error) { // no memory, as the size itself was checked
    throw Error(error.GetKind(), object,
                std::string(error.what()) + " or, with " + std::to_string(samples) + " x " +
                    std::to_string(samples) + " samples a pixel, for fewer (samples=1)");
  }
  RenderStatistics& statistics = this->Context_->CountStatistics();
  if (!this->Drawer_) {
    this->Drawer_ = std::make_unique<SceneDrawer>(hub, this->Context_->GetStore(),
                                                  this->Context_->GetDrawers(), statistics);
  }
  this->List_.Build(scene, view, request.filter);
  this->Complete_ = true;
  if (!request.instead) {
    this->Complete_ = this->Drawer_->Prepare(this->List_, view, samples);
    this->Complete_ &= this->Drawer_->DrawShadows(scene, this->List_, view, samples);
  }
  this->ActivateScene();
  if (this->Renderer_->GetViewProps()->GetNumberOfItems() > 0) {
    MirrorCamera(scene, view, this->Renderer_);
    MirrorLights(scene, this->Renderer_);
  }
  std::exception_ptr failure; // must not pass through VTK's frames
  this->Renderer_->ClearPicture = [&] {
    try {
      this->Drawer_->Clear(request.background);
    } catch (...) {
      failure = std::current_exception();
    }
  };
  std::vector<Caption> captions;
  this->Renderer_->DrawScene = [&] {
    try {
      if (request.instead) {
        request.instead();
      } else {
        this->DrawScene(view, request);
      }
      if (request.overlays && !request.instead) { // the axes take the depth
        captions = this->Drawer_->Captions(this->List_, view, this->DrawnTarget(), samples);
      }
      if (request.axes) {
        request.axes->Draw(scene, view, this->DrawnTarget(), samples);
      }
    } catch (...) {
      failure = std::current_exception();
    }
  };
  hub->Render();
  this->DrawNothing();
  if (!failure) {
    if (this->SceneTarget_) {
      this->Drawer_->Downsample(*this->SceneTarget_, *this->DisplayTarget_, samples);
    }
    if (request.overlays && request.beforeOverlays) {
      request.beforeOverlays(this->List_.Filter());
    }
    if (request.overlays && request.covered && !captions.empty()) {
      LeaveOutCovered(captions, request.covered());
    }
    if (request.overlays) {
      this->Captions_.Show(captions, this->Overlay_, view.height / samples);
    }
    if (request.overlays && this->Overlay_->GetViewProps()->GetNumberOfItems() > 0) {
      this->ActivateDisplay();
      hub->Render();
    }
  }
  this->Context_->GetStore().Collect();
  ++statistics.framesDrawn;
  if (failure) {
    std::rethrow_exception(failure);
  }
  const GLenum error = glGetError();
  if (error != GL_NO_ERROR) {
    throw Error(Error::Kind::Resource, object,
                "OpenGL reported error " + std::to_string(error) + " while drawing");
  }
  trap.Check(object);
}

unsigned int ColorPicture::Texture() const {
  return this->DisplayTarget_ ? this->DisplayTarget_->Color() : 0;
}

std::vector<std::uint8_t> ColorPicture::Read() const {
  this->Context_->GetHub()->MakeCurrent();
  std::vector<std::uint8_t> color = this->DisplayTarget_->ReadColor();
  for (std::size_t i = 3; i < color.size(); i += 4) {
    color[i] = 255;
  }
  return color;
}

} // namespace dspace
