#include "vtkDspaceViewport.h"

#include "vtk_glew.h"

#include <cmath>
#include <map>

#include "vtkCamera.h"
#include "vtkDspaceHubWindow.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceRenderer.h"
#include "vtkLight.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLState.h"
#include "vtkPropCollection.h"
#include "vtkRendererCollection.h"
#include "vtkSmartPointer.h"
#include "vtkTextActor.h"

#include <dspace/Error.h>
#include <dspace/render/SceneDrawer.h>
#include <dspace/render/TextTableActor.h>
#include <dspace/render/VtkErrors.h>
#include <dspace/scene/Primitives.h>

using dspace::Error;

vtkStandardNewMacro(vtkDspaceViewport);

namespace {

constexpr int MaximumSize = 16384;

void CheckSize(const std::string& viewport, int width, int height) {
  if (width < 1 || height < 1 || width > MaximumSize || height > MaximumSize) {
    throw Error(Error::Kind::InvalidArgument, viewport,
                "size " + std::to_string(width) + " x " + std::to_string(height) +
                    " is refused; 1 to " + std::to_string(MaximumSize) + " pixels a side");
  }
}

void CheckColor(const std::string& viewport, const std::array<double, 3>& color) {
  for (const double c : color) {
    if (!(c >= 0.0 && c <= 1.0)) {
      throw Error(Error::Kind::InvalidArgument, viewport,
                  "background component " + std::to_string(c) + " is refused; 0 to 1");
    }
  }
}

// The little arrows in the corner: a scene of their own, seen along the camera's direction.
struct CornerAxes {
  dspace::Scene scene{"corner axes"};
  dspace::DrawList list;
  CornerAxes() {
    dspace::GraphicsObject axes;
    axes.name = "axes";
    const auto arrow = std::make_shared<const dspace::Mesh>(dspace::MakeArrow(1.0));
    dspace::DetailLevel level;
    for (int axis = 0; axis < 3; ++axis) { // X red, Y green, Z blue
      auto material = std::make_shared<dspace::Material>();
      material->color = {0.1, 0.1, 0.1};
      material->color[axis] = 0.9;
      const Eigen::Quaterniond turn =
          Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), Eigen::Vector3d::Unit(axis));
      level.parts.push_back({arrow, material, Eigen::Affine3d(turn)});
    }
    axes.levels.push_back(std::move(level));
    this->scene.AddObject(axes);
    dspace::Light head;
    head.name = "head";
    head.kind = dspace::Light::Kind::Head;
    head.intensity = 0.7;
    this->scene.SetLight(head);
    dspace::Light ambient;
    ambient.name = "ambient";
    ambient.kind = dspace::Light::Kind::Ambient;
    ambient.intensity = 0.4;
    this->scene.SetLight(ambient);
  }
};

} // namespace

struct vtkDspaceViewport::Internals {
  vtkSmartPointer<vtkDspaceRenderContext> context;
  std::shared_ptr<dspace::Scene> scene;
  std::string name;
  std::string vantage;
  std::string camera;
  int width = 0;
  int height = 0;
  int samples = 2;
  bool visible = true;
  bool ornaments = true;
  std::set<std::string> hidden;
  dspace::SceneDrawer::Background background;
  std::map<std::string, dspace::TextTable> tables;
  std::map<std::string, vtkSmartPointer<vtkTextActor>> tableActors;
  std::unique_ptr<CornerAxes> cornerAxes;

  std::unique_ptr<dspace::RenderTarget> sceneTarget;   // supersampled
  std::unique_ptr<dspace::RenderTarget> displayTarget; // what is shown
  std::unique_ptr<dspace::RenderTarget> labelTarget;
  std::unique_ptr<dspace::SceneDrawer> drawer;
  std::unique_ptr<dspace::SceneDrawer> axesDrawer;
  std::unique_ptr<dspace::SceneDrawer> labelDrawer; // its instances differ from the picture's
  dspace::DrawList list;
  dspace::DrawList labelList;
  vtkNew<vtkDspaceRenderer> renderer;
  vtkNew<vtkOpenGLRenderer> overlay;
  vtkNew<vtkRendererCollection> sceneRenderers;
  vtkNew<vtkRendererCollection> overlayRenderers;

  bool stale = true;               // something of the viewport's own changed
  std::uint64_t drawnRevision = 0; // of the scene, in the picture that is there
  std::uint64_t labelRevision = 0; // and in the labels; 0: none
  dspace::DrawFilter labelFilter;
  dspace::DrawView labelView;

  std::string Object() const { return "viewport '" + this->name + "'"; }

  dspace::DrawView View(int factor) const {
    dspace::DrawView view;
    view.camera = this->scene->PlaceCamera(this->vantage, this->camera);
    view.projection =
        (this->camera.empty() ? this->scene->Vantage(this->vantage).ActiveCamera()
                              : this->scene->Vantage(this->vantage).GetCamera(this->camera))
            .projection;
    view.width = this->width * factor;
    view.height = this->height * factor;
    return view;
  }

  dspace::DrawFilter Filter(const dspace::CaptureRequest& request) const {
    dspace::DrawFilter filter;
    filter.physicalOnly = request.physicalOnly || !this->ornaments;
    filter.hiddenFragments = this->hidden;
    for (const std::string& fragment : request.hiddenFragments) {
      this->scene->Fragments().Get(fragment); // refuses names that do not exist
      filter.hiddenFragments.insert(fragment);
    }
    return filter;
  }

  void ActivateScene() {
    this->context->GetHub()->Activate({this->sceneTarget->Framebuffer(), this->sceneRenderers,
                                       this->sceneTarget->Width(), this->sceneTarget->Height()});
  }
  void ActivateDisplay() {
    this->context->GetHub()->Activate(
        {this->displayTarget->Framebuffer(), this->overlayRenderers, this->width, this->height});
  }

  void PrepareTargets() {
    vtkDspaceHubWindow* hub = this->context->GetHub();
    if (!this->sceneTarget) {
      using Format = dspace::RenderTarget::Format;
      this->sceneTarget = std::make_unique<dspace::RenderTarget>(hub, Format::Display, true);
      this->displayTarget = std::make_unique<dspace::RenderTarget>(hub, Format::Display, true);
    }
    this->sceneTarget->Resize(this->width * this->samples, this->height * this->samples);
    this->displayTarget->Resize(this->width, this->height);
  }

  void PlaceVtkCamera(const dspace::DrawView& view);
  void SyncVtkLights();
  void DrawCornerAxes(const dspace::DrawView& view);
  void Draw(const dspace::DrawFilter& filter, bool overlays);
  void DrawLabels(const dspace::DrawFilter& filter);
};

// For VTK code of others: the same camera, in the root frame's coordinates.
void vtkDspaceViewport::Internals::PlaceVtkCamera(const dspace::DrawView& view) {
  const dspace::FrameTree& frames = this->scene->Frames();
  const dspace::Pose X_RC = frames.WorldPose(view.camera.frame) * view.camera.X_FC;
  const Eigen::Vector3d eye = X_RC.position;
  const Eigen::Vector3d at = eye + X_RC.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up = X_RC.rotation * -Eigen::Vector3d::UnitY();
  vtkCamera* camera = this->renderer->GetActiveCamera();
  camera->SetPosition(eye.x(), eye.y(), eye.z());
  camera->SetFocalPoint(at.x(), at.y(), at.z());
  camera->SetViewUp(up.x(), up.y(), up.z());
  camera->SetParallelProjection(view.projection.kind == dspace::Projection::Kind::Orthographic);
  const Eigen::Matrix4d clip = view.projection.ClipFromView(view.width, view.height);
  vtkNew<vtkMatrix4x4> matrix;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) {
      matrix->SetElement(r, c, clip(r, c));
    }
  }
  camera->SetExplicitProjectionTransformMatrix(matrix);
  camera->UseExplicitProjectionTransformMatrixOn();
}

void vtkDspaceViewport::Internals::SyncVtkLights() {
  this->renderer->RemoveAllLights();
  const dspace::FrameTree& frames = this->scene->Frames();
  for (const dspace::Light& light : this->scene->Fragments().Lights()) {
    if (!light.enabled || light.kind == dspace::Light::Kind::Ambient) {
      continue;
    }
    vtkNew<vtkLight> placed;
    if (light.kind == dspace::Light::Kind::Head) {
      placed->SetLightTypeToHeadlight();
    } else {
      const dspace::Pose& X_RF = frames.WorldPose(light.frame);
      const bool directional = light.kind == dspace::Light::Kind::Directional;
      const Eigen::Vector3d d = (X_RF.rotation * light.direction).normalized();
      const Eigen::Vector3d p = directional ? Eigen::Vector3d(-d) : X_RF.Apply(light.position);
      placed->SetPosition(p.x(), p.y(), p.z());
      placed->SetFocalPoint(p.x() + d.x(), p.y() + d.y(), p.z() + d.z());
      placed->SetPositional(!directional);
      placed->SetConeAngle(light.kind == dspace::Light::Kind::Spot ? light.cone_deg : 180.0);
    }
    placed->SetColor(light.color[0], light.color[1], light.color[2]);
    placed->SetIntensity(light.intensity);
    this->renderer->AddLight(placed);
  }
}

void vtkDspaceViewport::Internals::DrawCornerAxes(const dspace::DrawView& view) {
  if (!this->cornerAxes || !this->ornaments) {
    return;
  }
  const int size = std::max(std::min(view.width, view.height) / 6, 1);
  // The root's axes as the camera sees them, from three metres away.
  dspace::Pose X_RC =
      this->scene->Frames().RelativePose(dspace::RootFrame, view.camera.frame) * view.camera.X_FC;
  X_RC.scale = 1.0;
  X_RC.position = X_RC.rotation * Eigen::Vector3d(0.0, 0.0, -3.0);
  dspace::DrawView corner;
  corner.camera = {dspace::RootFrame, X_RC};
  corner.projection.kind = dspace::Projection::Kind::Orthographic;
  corner.projection.height = 2.6;
  corner.projection.nearDistance = 0.1;
  corner.projection.farDistance = 10.0;
  corner.width = corner.height = size;
  this->cornerAxes->list.Build(this->cornerAxes->scene, corner, {});
  vtkOpenGLState* state = this->context->GetHub()->GetState();
  state->vtkglViewport(0, 0, size, size);
  state->vtkglScissor(0, 0, size, size);
  state->vtkglEnable(GL_SCISSOR_TEST);
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglClearDepth(0.0);
  state->vtkglClear(GL_DEPTH_BUFFER_BIT);
  state->vtkglClearDepth(1.0);
  if (!this->axesDrawer) {
    this->axesDrawer = std::make_unique<dspace::SceneDrawer>(
        this->context->GetHub(), this->context->GetStore(), this->context->CountStatistics());
  }
  const dspace::RenderStatistics before = this->context->GetStatistics();
  this->axesDrawer->DrawColor(this->cornerAxes->list, corner, *this->sceneTarget, this->samples);
  // The read-outs speak of the scene.
  this->context->CountStatistics().trianglesDrawn = before.trianglesDrawn;
  this->context->CountStatistics().drawCalls = before.drawCalls;
  this->context->CountStatistics().translucentLayers = before.translucentLayers;
  state->vtkglViewport(0, 0, view.width, view.height);
  state->vtkglScissor(0, 0, view.width, view.height);
}

void vtkDspaceViewport::Internals::Draw(const dspace::DrawFilter& filter, bool overlays) {
  const dspace::DrawView view = this->View(this->samples); // refuses a vantage without camera
  vtkDspaceHubWindow* hub = this->context->GetHub();
  dspace::VtkErrorTrap trap;
  hub->MakeCurrent();
  this->PrepareTargets();
  if (!this->drawer) {
    this->drawer = std::make_unique<dspace::SceneDrawer>(hub, this->context->GetStore(),
                                                         this->context->CountStatistics());
  }
  this->list.Build(*this->scene, view, filter);
  this->ActivateScene();
  if (this->renderer->GetViewProps()->GetNumberOfItems() > 0) {
    this->PlaceVtkCamera(view);
    this->SyncVtkLights();
  }
  std::exception_ptr failure; // must not pass through VTK's frames
  this->renderer->ClearPicture = [&] {
    try {
      this->drawer->Clear(this->background);
    } catch (...) {
      failure = std::current_exception();
    }
  };
  this->renderer->DrawScene = [&] {
    try {
      this->drawer->DrawColor(this->list, view, *this->sceneTarget, this->samples,
                              &this->background);
      if (overlays) {
        this->DrawCornerAxes(view);
      }
    } catch (...) {
      failure = std::current_exception();
    }
  };
  hub->Render();
  if (!failure) {
    this->drawer->Downsample(*this->sceneTarget, *this->displayTarget, this->samples);
    if (overlays && this->overlay->GetViewProps()->GetNumberOfItems() > 0) {
      this->ActivateDisplay();
      hub->Render();
    }
  }
  this->context->GetStore().Collect();
  ++this->context->CountStatistics().framesDrawn;
  if (failure) {
    std::rethrow_exception(failure);
  }
  const GLenum error = glGetError();
  if (error != GL_NO_ERROR) {
    throw Error(Error::Kind::Resource, this->Object(),
                "OpenGL reported error " + std::to_string(error) + " while drawing");
  }
  trap.Check(this->Object());
}

void vtkDspaceViewport::Internals::DrawLabels(const dspace::DrawFilter& filter) {
  const bool same = this->labelRevision == this->scene->Revision() &&
                    this->labelFilter.physicalOnly == filter.physicalOnly &&
                    this->labelFilter.pickableOnly == filter.pickableOnly &&
                    this->labelFilter.hiddenFragments == filter.hiddenFragments;
  if (same) {
    return;
  }
  this->labelView = this->View(1);
  vtkDspaceHubWindow* hub = this->context->GetHub();
  hub->MakeCurrent();
  if (!this->labelDrawer) {
    this->labelTarget =
        std::make_unique<dspace::RenderTarget>(hub, dspace::RenderTarget::Format::Label, true);
    this->labelDrawer = std::make_unique<dspace::SceneDrawer>(hub, this->context->GetStore(),
                                                              this->context->CountStatistics());
  }
  this->labelTarget->Resize(this->width, this->height);
  this->labelList.Build(*this->scene, this->labelView, filter);
  this->labelDrawer->DrawLabels(this->labelList, this->labelView, *this->labelTarget);
  this->labelRevision = this->scene->Revision();
  this->labelFilter = filter;
}

vtkDspaceViewport::vtkDspaceViewport() : Impl(std::make_unique<Internals>()) {}

vtkDspaceViewport::~vtkDspaceViewport() {
  Internals& self = *this->Impl;
  if (!self.context) {
    return;
  }
  vtkDspaceHubWindow* hub = self.context->GetHub();
  if (hub->GetContext()) {
    hub->MakeCurrent();
    hub->Deactivate();
    // Not RemoveRenderer: it would release the resources of props that other viewports show.
    self.renderer->RemoveAllViewProps();
    self.overlay->RemoveAllViewProps();
    self.renderer->SetRenderWindow(nullptr);
    self.overlay->SetRenderWindow(nullptr);
  }
  self.drawer.reset();
  self.axesDrawer.reset();
  self.labelDrawer.reset();
  self.sceneTarget.reset();
  self.displayTarget.reset();
  self.labelTarget.reset();
}

void vtkDspaceViewport::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Name: " << this->Impl->name << "\n";
  os << indent << "Size: " << this->Impl->width << " x " << this->Impl->height << "\n";
}

void vtkDspaceViewport::Initialize(vtkDspaceRenderContext* context,
                                   std::shared_ptr<dspace::Scene> scene, const std::string& name,
                                   const std::string& vantage, int width, int height) {
  Internals& self = *this->Impl;
  CheckSize("viewport '" + name + "'", width, height);
  scene->Vantage(vantage); // refuses one that does not exist
  context->Initialize();
  self.context = context;
  self.scene = std::move(scene);
  self.name = name;
  self.vantage = vantage;
  self.width = width;
  self.height = height;
  vtkDspaceHubWindow* hub = context->GetHub();
  self.sceneRenderers->AddItem(self.renderer);
  self.overlayRenderers->AddItem(self.overlay);
  self.renderer->SetRenderWindow(hub);
  self.overlay->SetRenderWindow(hub);
  self.renderer->AutomaticLightCreationOff();
  self.overlay->SetPreserveColorBuffer(1);
  self.overlay->GetActiveCamera(); // else VTK resets it at the first picture
  self.renderer->GetActiveCamera();
}

int vtkDspaceViewport::GetWidth() {
  return this->Impl->width;
}
int vtkDspaceViewport::GetHeight() {
  return this->Impl->height;
}
bool vtkDspaceViewport::GetVisible() {
  return this->Impl->visible;
}
vtkRenderer* vtkDspaceViewport::GetRenderer() {
  return this->Impl->renderer;
}
vtkRenderer* vtkDspaceViewport::GetOverlayRenderer() {
  return this->Impl->overlay;
}
void vtkDspaceViewport::Invalidate() {
  this->Impl->stale = true;
}
const std::string& vtkDspaceViewport::GetName() const {
  return this->Impl->name;
}
std::shared_ptr<dspace::Scene> vtkDspaceViewport::GetScene() const {
  return this->Impl->scene;
}
const std::string& vtkDspaceViewport::GetVantage() const {
  return this->Impl->vantage;
}
const std::string& vtkDspaceViewport::GetCamera() const {
  return this->Impl->camera;
}
int vtkDspaceViewport::GetSamples() const {
  return this->Impl->samples;
}

void vtkDspaceViewport::SetVantage(const std::string& vantage) {
  this->Impl->scene->Vantage(vantage);
  this->Impl->vantage = vantage;
  this->Impl->camera.clear();
  this->Impl->stale = true;
  this->Impl->labelRevision = 0;
}

void vtkDspaceViewport::SetCamera(const std::string& camera) {
  if (!camera.empty()) {
    this->Impl->scene->Vantage(this->Impl->vantage).GetCamera(camera);
  }
  this->Impl->camera = camera;
  this->Impl->stale = true;
  this->Impl->labelRevision = 0;
}

void vtkDspaceViewport::Resize(int width, int height) {
  Internals& self = *this->Impl;
  CheckSize(self.Object(), width, height);
  if (width == self.width && height == self.height) {
    return;
  }
  self.width = width;
  self.height = height;
  self.stale = true;
  self.labelRevision = 0;
  for (auto& entry : self.tableActors) { // they stand in corners
    self.overlay->RemoveViewProp(entry.second);
    entry.second = dspace::MakeTextTableActor(self.tables.at(entry.first), width, height);
    self.overlay->AddViewProp(entry.second);
  }
}

void vtkDspaceViewport::SetVisible(bool visible) {
  this->Impl->visible = visible;
}

void vtkDspaceViewport::SetBackground(const std::array<double, 3>& bottom,
                                      const std::array<double, 3>& top) {
  CheckColor(this->Impl->Object(), bottom);
  CheckColor(this->Impl->Object(), top);
  this->Impl->background = {bottom, top};
  this->Impl->stale = true;
}

void vtkDspaceViewport::SetSamples(int samples) {
  if (samples < 1 || samples > 8) {
    throw Error(Error::Kind::InvalidArgument, this->Impl->Object(),
                "samples " + std::to_string(samples) + " is refused; 1 to 8");
  }
  this->Impl->samples = samples;
  this->Impl->stale = true;
}

void vtkDspaceViewport::SetOrnamentsVisible(bool visible) {
  this->Impl->ornaments = visible;
  this->Impl->stale = true;
}

void vtkDspaceViewport::SetFragmentVisible(const std::string& fragment, bool visible) {
  this->Impl->scene->Fragments().Get(fragment);
  if (visible) {
    this->Impl->hidden.erase(fragment);
  } else {
    this->Impl->hidden.insert(fragment);
  }
  this->Impl->stale = true;
}

void vtkDspaceViewport::SetTextTable(const dspace::TextTable& table) {
  table.Check();
  Internals& self = *this->Impl;
  const auto found = self.tables.find(table.name);
  if (found != self.tables.end() && found->second == table) {
    return;
  }
  auto actor = dspace::MakeTextTableActor(table, self.width, self.height);
  if (self.tableActors[table.name]) {
    self.overlay->RemoveViewProp(self.tableActors[table.name]);
  }
  self.overlay->AddViewProp(actor);
  self.tableActors[table.name] = actor;
  self.tables[table.name] = table;
  self.stale = true;
}

void vtkDspaceViewport::RemoveTextTable(const std::string& name) {
  Internals& self = *this->Impl;
  if (self.tables.erase(name) == 0) {
    throw Error(Error::Kind::NotFound, self.Object(), "has no text table '" + name + "'");
  }
  self.overlay->RemoveViewProp(self.tableActors[name]);
  self.tableActors.erase(name);
  self.stale = true;
}

void vtkDspaceViewport::SetCornerAxes(bool visible) {
  Internals& self = *this->Impl;
  if (visible != static_cast<bool>(self.cornerAxes)) {
    self.cornerAxes = visible ? std::make_unique<CornerAxes>() : nullptr;
    self.stale = true;
  }
}

bool vtkDspaceViewport::IsOutdated() {
  return this->Impl->stale || this->Impl->drawnRevision != this->Impl->scene->Revision();
}

bool vtkDspaceViewport::Render() {
  if (!this->Impl->visible) {
    return false;
  }
  if (!this->IsOutdated()) {
    ++this->Impl->context->CountStatistics().framesSkipped;
    return false;
  }
  this->ForceRender();
  return true;
}

void vtkDspaceViewport::ForceRender() {
  Internals& self = *this->Impl;
  self.Draw(self.Filter({}), true);
  self.stale = false;
  self.drawnRevision = self.scene->Revision();
}

dspace::Capture vtkDspaceViewport::GetCapture(const dspace::CaptureRequest& request) {
  Internals& self = *this->Impl;
  dspace::Capture capture;
  capture.width = self.width;
  capture.height = self.height;
  const dspace::DrawFilter filter = self.Filter(request);
  if (request.color) {
    if (request.physicalOnly || !request.hiddenFragments.empty()) {
      self.Draw(filter, !request.physicalOnly);
      self.stale = true; // this picture is the request's, not the viewport's
    } else if (this->IsOutdated()) {
      this->ForceRender();
    }
    self.context->GetHub()->MakeCurrent();
    capture.color = self.displayTarget->ReadColor();
    for (std::size_t i = 3; i < capture.color.size(); i += 4) {
      capture.color[i] = 255;
    }
  }
  if (request.label || request.depth) {
    self.DrawLabels(filter);
    if (request.label) {
      capture.label = self.labelTarget->ReadLabel(0, 0, self.width, self.height);
    }
    if (request.depth) {
      capture.depth = self.labelTarget->ReadDepth(0, 0, self.width, self.height);
      for (float& value : capture.depth) {
        value = static_cast<float>(self.labelView.projection.DepthFromBuffer(value));
      }
    }
  }
  return capture;
}

dspace::PickResult vtkDspaceViewport::Pick(double x, double y, int radius) {
  Internals& self = *this->Impl;
  if (!std::isfinite(x) || !std::isfinite(y) || x < -0.5 || y < -0.5 || x >= self.width - 0.5 ||
      y >= self.height - 0.5 || radius < 0 || radius > 256) {
    throw Error(Error::Kind::InvalidArgument, self.Object(),
                "pick at (" + std::to_string(x) + ", " + std::to_string(y) + ") with radius " +
                    std::to_string(radius) + " is refused; pixels within " +
                    std::to_string(self.width) + " x " + std::to_string(self.height) +
                    ", radius 0 to 256");
  }
  dspace::DrawFilter filter = self.Filter({});
  filter.pickableOnly = true;
  self.DrawLabels(filter);
  const int px = static_cast<int>(std::floor(x + 0.5));
  const int py = static_cast<int>(std::floor(y + 0.5));
  const int x0 = std::max(px - radius, 0);
  const int y0 = std::max(py - radius, 0);
  const int w = std::min(px + radius, self.width - 1) - x0 + 1;
  const int h = std::min(py + radius, self.height - 1) - y0 + 1;
  const auto labels = self.labelTarget->ReadLabel(x0, y0, w, h);
  const auto depths = self.labelTarget->ReadDepth(x0, y0, w, h);
  int best = -1;
  int bestDistance = radius * radius + 1;
  for (int i = 0; i < w * h; ++i) {
    const int dx = x0 + i % w - px;
    const int dy = y0 + i / w - py;
    if (labels[i] != 0 && dx * dx + dy * dy < bestDistance) {
      best = i;
      bestDistance = dx * dx + dy * dy;
    }
  }
  dspace::PickResult result;
  if (best < 0) {
    return result;
  }
  // The pixel's own centre is what was drawn: the depth belongs to that ray.
  const bool there = bestDistance == 0;
  const double rayX = there ? x : x0 + best % w;
  const double rayY = there ? y : y0 + best / w;
  const dspace::DrawView& view = self.labelView;
  result.object = labels[best];
  result.frame = self.scene->Object(result.object).frame;
  result.depth = view.projection.DepthFromBuffer(depths[best]);
  const dspace::Projection::Ray ray =
      view.projection.PixelRay(there ? px : rayX, there ? py : rayY, self.width, self.height);
  result.p_camera =
      ray.origin + ray.direction * ((result.depth - ray.origin.z()) / ray.direction.z());
  result.cameraFrame = view.camera.frame;
  const Eigen::Vector3d p_A = view.camera.X_FC.Apply(result.p_camera);
  const dspace::FrameTree& frames = self.scene->Frames();
  result.p_frame = frames.RelativePose(result.frame, view.camera.frame).Apply(p_A);
  result.p_root = frames.RelativePose(dspace::RootFrame, view.camera.frame).Apply(p_A);
  return result;
}

void vtkDspaceViewport::Run(const std::function<void(vtkRenderWindow*)>& f) {
  Internals& self = *this->Impl;
  self.context->GetHub()->MakeCurrent();
  self.PrepareTargets();
  self.ActivateScene();
  dspace::VtkErrorTrap trap;
  f(self.context->GetHub());
  self.stale = true;
  trap.Check(self.Object());
}
