#include "vtkDspaceViewport.h"

#include "vtkDspaceHubWindow.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceRenderer.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderer.h"
#include "vtkSmartPointer.h"

#include <dspace/Error.h>
#include <dspace/render/ColorPicture.h>
#include <dspace/render/CornerAxes.h>
#include <dspace/render/LabelPicture.h>
#include <dspace/render/ViewportLimits.h>
#include <dspace/render/VtkErrorTrap.h>
#include <dspace/render/text/ColorBars.h>
#include <dspace/render/text/TextTables.h>

using dspace::Error;

vtkStandardNewMacro(vtkDspaceViewport);

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
  dspace::TextTables tables;
  dspace::ColorBars bars;
  std::unique_ptr<dspace::CornerAxes> cornerAxes;
  std::function<void()> prepare; // before drawing; may be empty
  dspace::LabelPicture labels;
  dspace::ColorPicture picture; // stands last: it gives the window back before the rest goes

  bool stale = true;               // something of the viewport's own changed
  std::uint64_t drawnRevision = 0; // of the scene, in the picture that is there

  // Colour bars over text tables, each kind by name, whatever came first.
  void RaiseOverlays() {
    this->tables.Raise(this->picture.Overlay());
    this->bars.Raise(this->picture.Overlay());
  }
  std::string Object() const { return "viewport '" + this->name + "'"; }

  // The view of the camera, `factor` samples a pixel across and down.
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
      this->scene->Fragments().Get(fragment); // rejects names that do not exist
      filter.hiddenFragments.insert(fragment);
    }
    return filter;
  }

  void Draw(const dspace::DrawFilter& filter, bool overlays, bool complete) {
    dspace::ColorPicture::Request request;
    request.view = this->View(this->samples); // rejects a vantage without camera
    request.view.complete = complete;
    request.samples = this->samples;
    request.filter = filter;
    request.background = this->background;
    request.overlays = overlays;
    request.axes = overlays && this->ornaments ? this->cornerAxes.get() : nullptr;
    this->picture.Draw(this->Object(), *this->scene, request);
  }

  // The viewport's own picture.
  void DrawOwn(bool complete) {
    // Before: what arrives while it is drawn makes it outdated.
    const std::uint64_t revision = this->scene->Revision();
    this->Draw(this->Filter({}), true, complete);
    this->stale = false;
    this->drawnRevision = revision;
  }

  void DrawLabels(const dspace::DrawFilter& filter) {
    this->context->GetHub()->MakeCurrent();
    if (!this->labels.IsCurrent(*this->scene, filter)) {
      dspace::DrawView view = this->View(1);
      view.complete = true;
      this->labels.Draw(this->context, *this->scene, view, filter);
    }
  }

  // The camera or the size is another.
  void ViewChanged() {
    this->stale = true;
    this->labels.Invalidate();
  }
};

vtkDspaceViewport::vtkDspaceViewport() : Impl(std::make_unique<Internals>()) {}

vtkDspaceViewport::~vtkDspaceViewport() = default;

void vtkDspaceViewport::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Name: " << this->Impl->name << "\n";
  os << indent << "Size: " << this->Impl->width << " x " << this->Impl->height << "\n";
}

void vtkDspaceViewport::Initialize(vtkDspaceRenderContext* context,
                                   std::shared_ptr<dspace::Scene> scene, const std::string& name,
                                   const std::string& vantage, int width, int height, int samples) {
  Internals& self = *this->Impl;
  const std::string object = "viewport '" + name + "'";
  dspace::CheckSize(object, width, height);
  scene->Vantage(vantage); // rejects one that does not exist
  context->Initialize();
  dspace::CheckSamples(*context->GetHub(), object, width, height, samples);
  self.context = context;
  self.scene = std::move(scene);
  self.name = name;
  self.vantage = vantage;
  self.width = width;
  self.height = height;
  self.samples = samples;
  self.picture.Connect(context);
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
  return this->Impl->picture.Renderer();
}
vtkRenderer* vtkDspaceViewport::GetOverlayRenderer() {
  return this->Impl->picture.Overlay();
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
  this->Impl->ViewChanged();
}

void vtkDspaceViewport::SetCamera(const std::string& camera) {
  if (!camera.empty()) {
    this->Impl->scene->Vantage(this->Impl->vantage).GetCamera(camera);
  }
  this->Impl->camera = camera;
  this->Impl->ViewChanged();
}

void vtkDspaceViewport::Resize(int width, int height) {
  Internals& self = *this->Impl;
  dspace::CheckSize(self.Object(), width, height);
  if (width == self.width && height == self.height) {
    return;
  }
  dspace::CheckSamples(*self.context->GetHub(), self.Object(), width, height, self.samples);
  self.width = width;
  self.height = height;
  self.ViewChanged();
  self.tables.Resize(self.picture.Overlay(), width, height);
  self.bars.Resize(self.picture.Overlay(), width, height);
  self.RaiseOverlays();
}

void vtkDspaceViewport::SetVisible(bool visible) {
  this->Impl->visible = visible;
}

void vtkDspaceViewport::SetBackground(const std::array<double, 3>& bottom,
                                      const std::array<double, 3>& top) {
  dspace::CheckColor(this->Impl->Object(), bottom);
  dspace::CheckColor(this->Impl->Object(), top);
  this->Impl->background = {bottom, top};
  this->Impl->stale = true;
}

void vtkDspaceViewport::RequireSamples(int samples) const {
  const Internals& self = *this->Impl;
  dspace::CheckSamples(*self.context->GetHub(), self.Object(), self.width, self.height, samples);
}

void vtkDspaceViewport::SetSamples(int samples) {
  this->RequireSamples(samples);
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
  Internals& self = *this->Impl;
  if (self.tables.Set(table, self.picture.Overlay(), self.width, self.height)) {
    self.RaiseOverlays();
    self.stale = true;
  }
}

void vtkDspaceViewport::RemoveTextTable(const std::string& name) {
  Internals& self = *this->Impl;
  if (!self.tables.Remove(name, self.picture.Overlay())) {
    throw Error(Error::Kind::NotFound, self.Object(), "has no text table '" + name + "'");
  }
  self.stale = true;
}

void vtkDspaceViewport::SetColorBar(const dspace::ColorBar& bar) {
  Internals& self = *this->Impl;
  if (self.bars.Set(bar, self.picture.Overlay(), self.width, self.height)) {
    self.RaiseOverlays();
    self.stale = true;
  }
}

void vtkDspaceViewport::RemoveColorBar(const std::string& name) {
  Internals& self = *this->Impl;
  if (!self.bars.Remove(name, self.picture.Overlay())) {
    throw Error(Error::Kind::NotFound, self.Object(), "has no colour bar '" + name + "'");
  }
  self.stale = true;
}

void vtkDspaceViewport::SetCornerAxes(bool visible) {
  Internals& self = *this->Impl;
  if (visible != static_cast<bool>(self.cornerAxes)) {
    self.cornerAxes = visible ? std::make_unique<dspace::CornerAxes>(self.context) : nullptr;
    self.stale = true;
  }
}

void vtkDspaceViewport::SetBeforeDrawing(std::function<void()> prepare) {
  this->Impl->prepare = std::move(prepare);
}

bool vtkDspaceViewport::IsOutdated() {
  if (this->Impl->prepare) {
    this->Impl->prepare();
  }
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
  this->IsOutdated(); // overlays as they are now
  this->Impl->DrawOwn(false);
}

dspace::Capture vtkDspaceViewport::GetCapture(const dspace::CaptureRequest& request) {
  Internals& self = *this->Impl;
  dspace::Capture capture;
  capture.width = self.width;
  capture.height = self.height;
  const dspace::DrawFilter filter = self.Filter(request);
  if (request.color) {
    if (request.physicalOnly || !request.hiddenFragments.empty()) {
      this->IsOutdated(); // overlays as they are now
      self.Draw(filter, !request.physicalOnly, true);
      self.stale = true; // this picture is the request's, not the viewport's
    } else if (this->IsOutdated() || !self.picture.Complete()) {
      self.DrawOwn(true);
    }
    capture.color = self.picture.Read();
  }
  if (request.label || request.depth) {
    self.DrawLabels(filter);
    if (request.label) {
      capture.label = self.labels.Labels();
    }
    if (request.depth) {
      capture.depth = self.labels.Depths();
    }
  }
  return capture;
}

dspace::PickResult vtkDspaceViewport::Pick(double x, double y, int radius) {
  Internals& self = *this->Impl;
  dspace::CheckPick(self.Object(), x, y, radius, self.width, self.height);
  dspace::DrawFilter filter = self.Filter({});
  filter.pickableOnly = true;
  self.DrawLabels(filter);
  return self.labels.Pick(*self.scene, x, y, radius);
}

void vtkDspaceViewport::Run(const std::function<void(vtkRenderWindow*)>& f) {
  Internals& self = *this->Impl;
  self.picture.Activate(self.width, self.height, self.samples);
  dspace::VtkErrorTrap trap(self.context->GetMessages());
  f(self.context->GetHub());
  self.stale = true;
  trap.Check(self.Object());
}
