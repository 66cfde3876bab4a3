#include "vtkDspaceViewport.h"

#include "vtkDspaceHubWindow.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceRenderer.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderer.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <dspace/Error.h>
#include <dspace/render/ColorPicture.h>
#include <dspace/render/CornerAxes.h>
#include <dspace/render/LabelPicture.h>
#include <dspace/render/LensView.h>
#include <dspace/render/RadiancePicture.h>
#include <dspace/render/ViewportLimits.h>
#include <dspace/render/messages/VtkErrorTrap.h>
#include <dspace/render/text/ColorBars.h>
#include <dspace/render/text/TextTables.h>

using dspace::Error;

vtkStandardNewMacro(vtkDspaceViewport);

namespace {

// The names of the parts of all levels, in the order of DrawFilter::partsOf.
std::vector<std::string> PartsOf(const dspace::GraphicsObject& object) {
  std::vector<std::string> names;
  for (const dspace::DetailLevel& level : object.levels) {
    for (const dspace::Part& part : level.parts) {
      names.push_back(part.name);
    }
  }
  return names;
}

} // namespace

struct vtkDspaceViewport::Internals {
  vtkSmartPointer<vtkDspaceRenderContext> context;
  std::shared_ptr<dspace::Scene> scene;
  std::string name;
  std::string vantage;
  std::string camera;
  std::optional<std::pair<dspace::CameraPose, dspace::Projection>> fixed; // in place of the camera
  int width = 0;
  int height = 0;
  int samples = 2;
  bool visible = true;
  bool ornaments = true;
  dspace::ViewLook look;
  dspace::Navigation navigation;
  std::set<std::string> hidden;
  dspace::SceneDrawer::Background background;
  dspace::TextTables tables;
  dspace::ColorBars bars;
  std::unique_ptr<dspace::CornerAxes> cornerAxes;
  std::function<void()> prepare; // before drawing; may be empty
  std::function<bool(const dspace::ColorBar&, const dspace::DrawFilter&)> explains; // may be empty
  dspace::LabelPicture labels;
  dspace::LabelPicture parts; // of the object that was picked last
  dspace::RadiancePicture radiance;
  dspace::AnglePicture angles;
  LensMaker lensMaker; // empty: no lens
  std::unique_ptr<dspace::LensView> lens;
  std::size_t labelledSource = 0; // of the lens, in the labels
  dspace::ColorPicture picture;   // stands last: it gives the window back before the rest goes

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
    if (this->fixed) {
      view.camera = this->fixed->first;
      view.projection = this->fixed->second;
    } else {
      view.camera = this->scene->PlaceCamera(this->vantage, this->camera);
      view.projection =
          (this->camera.empty() ? this->scene->Vantage(this->vantage).ActiveCamera()
                                : this->scene->Vantage(this->vantage).GetCamera(this->camera))
              .projection;
    }
    view.width = this->width * factor;
    view.height = this->height * factor;
    view.samples = factor;
    view.viewport = this->name;
    view.look = this->look;
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
    if (!overlays) { // a physical picture
      request.view.look.fill = 0.0;
    }
    request.samples = this->samples;
    request.filter = filter;
    request.background = this->background;
    request.overlays = overlays;
    request.axes = overlays && this->ornaments ? this->cornerAxes.get() : nullptr;
    request.beforeOverlays = [this](const dspace::DrawFilter& drawn) {
      this->bars.ShowIf([&](const dspace::ColorBar& bar) {
        return bar.terrain.empty() || (this->explains && this->explains(bar, drawn));
      });
    };
    request.covered = [&] {
      return this->bars.Covered(request.view.width / this->samples,
                                request.view.height / this->samples);
    };
    if (this->lens) {
      this->lens->Draw(this->Object(), *this->scene, request);
      request.view = this->View(1);
      request.samples = 1;
      request.instead = [this] { this->lens->Show(); };
    }
    this->picture.Draw(this->Object(), *this->scene, request);
  }

  bool Complete() const { return this->lens ? this->lens->Complete() : this->picture.Complete(); }

  // Throws unless OpenGL draws pictures of the lens' sources.
  void CheckSources(const dspace::ViewLens& checked, int n) const {
    for (const dspace::ViewLens::Source& source : checked.sources) {
      dspace::CheckSamples(*this->context->GetHub(), "source view of the lens of " + this->Object(),
                           source.width, source.height, n);
    }
  }

  void RequireNoLens(const char* what) const {
    if (this->lens) {
      throw Error(Error::Kind::Unsupported, this->Object(),
                  std::string(what) + " of a view through a lens is rejected; accepted: its "
                                      "colour, a pick, or an image that is simulated");
    }
  }

  // The viewport's own picture.
  void DrawOwn(bool complete) {
    // Before: what arrives while it is drawn makes it outdated.
    const std::uint64_t revision = this->scene->Revision();
    this->Draw(this->Filter({}), true, complete);
    this->stale = false;
    this->drawnRevision = revision;
  }

  void DrawLabels(dspace::LabelPicture& picture, const dspace::DrawFilter& filter) {
    this->context->GetHub()->MakeCurrent();
    if (!picture.IsCurrent(*this->scene, filter)) {
      dspace::DrawView view = this->View(1);
      if (this->lens) {
        view = this->lens->SourceView(view, this->labelledSource, 1);
      }
      view.complete = true;
      dspace::VtkErrorTrap trap(this->context->GetMessages()); // of props
      picture.Draw(this->context, *this->scene, view, filter);
      trap.Check(this->Object());
    }
  }

  // Vectors in the coordinates of a view as vectors in the root.
  std::vector<float> Rooted(std::vector<float> vectors, const dspace::CameraPose& camera) const {
    Eigen::Matrix3d R_CV = Eigen::Matrix3d::Identity(); // the view's Y is up, its Z backwards
    R_CV(1, 1) = R_CV(2, 2) = -1.0;
    const Eigen::Quaterniond q_RF = this->scene->Frames().WorldPose(camera.frame).rotation;
    const Eigen::Matrix3f R_RV =
        ((q_RF * camera.X_FC.rotation).toRotationMatrix() * R_CV).cast<float>();
    Eigen::Map<Eigen::Matrix3Xf> columns(vectors.data(), 3, Eigen::Index(vectors.size() / 3));
    columns = (R_RV * columns).eval();
    return vectors;
  }

  // Planes that hold light, its angles and normals.
  void DrawLight(const dspace::CaptureRequest& request, dspace::Capture& capture) {
    const dspace::DrawFilter filter = this->Filter(request);
    dspace::VtkErrorTrap trap(this->context->GetMessages()); // of props
    if (request.radiance) {
      dspace::DrawView view = this->View(this->samples);
      view.complete = true;
      this->radiance.Draw(this->context, *this->scene, view, filter);
      capture.radiance = this->radiance.Radiances();
    }
    if (request.incidence || request.emission || request.phase || request.litFraction) {
      dspace::DrawView view = this->View(1);
      view.complete = true;
      this->angles.Draw(this->context, *this->scene, view, filter);
      using Angle = dspace::AnglePicture::Angle;
      const auto put = [this](bool asked, Angle angle, std::vector<float>& to) {
        if (asked) {
          to = this->angles.Degrees(angle);
        }
      };
      put(request.incidence, Angle::Incidence, capture.incidence);
      put(request.emission, Angle::Emission, capture.emission);
      put(request.phase, Angle::Phase, capture.phase);
      if (request.litFraction) {
        capture.litFraction = this->angles.LitFractions();
      }
    }
    if (request.normal) {
      dspace::DrawView view = this->View(1);
      view.complete = true;
      this->angles.DrawNormals(this->context, *this->scene, view, filter);
      capture.normal = this->Rooted(this->angles.Normals(), view.camera);
    }
    trap.Check(this->Object());
  }

  // From a pixel of the picture and a radius to those of its source, whose labels are drawn next.
  // Returns false where the lens has no ray.
  bool FollowLens(double& x, double& y, int& radius) {
    const dspace::ViewLens& of = this->lens->Lens();
    const auto column = std::size_t(x + 0.5), row = std::size_t(y + 0.5); // above -0.5
    const dspace::ViewLens::Place& place = of.places[row * std::size_t(of.width) + column];
    if (place.source < 0.0f) {
      return false;
    }
    const auto source = std::size_t(place.source);
    if (source != this->labelledSource) {
      this->labelledSource = source;
      this->labels.Invalidate();
      this->parts.Invalidate();
    }
    x = std::clamp(double(place.x), 0.0, of.sources[source].width - 1.0);
    y = std::clamp(double(place.y), 0.0, of.sources[source].height - 1.0);
    radius = int(std::ceil(double(radius) * double(place.footprint)));
    return true;
  }

  // The camera or the size is another.
  void ViewChanged() {
    this->labelledSource = 0;
    this->stale = true;
    this->labels.Invalidate();
    this->parts.Invalidate();
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

void vtkDspaceViewport::SetFixedView(const dspace::CameraPose& camera,
                                     const dspace::Projection& projection) {
  projection.Check(this->Impl->Object());
  this->Impl->fixed.emplace(camera, projection);
  this->Impl->ViewChanged();
}

void vtkDspaceViewport::SetLens(LensMaker maker) {
  Internals& self = *this->Impl;
  if (maker) {
    const std::shared_ptr<const dspace::ViewLens> lens = maker(self.width, self.height);
    self.CheckSources(*lens, self.samples);
    if (self.lens) {
      self.lens->SetLens(lens);
    } else {
      self.lens = std::make_unique<dspace::LensView>(self.context, lens);
    }
  } else {
    self.lens.reset();
  }
  self.lensMaker = std::move(maker);
  self.ViewChanged();
}

bool vtkDspaceViewport::HasLens() const {
  return this->Impl->lens != nullptr;
}

void vtkDspaceViewport::Resize(int width, int height) {
  Internals& self = *this->Impl;
  dspace::CheckSize(self.Object(), width, height);
  if (width == self.width && height == self.height) {
    return;
  }
  dspace::CheckSamples(*self.context->GetHub(), self.Object(), width, height, self.samples);
  if (self.lens) {
    const std::shared_ptr<const dspace::ViewLens> lens = self.lensMaker(width, height);
    self.CheckSources(*lens, self.samples);
    self.lens->SetLens(lens);
  }
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
  if (self.lens) {
    self.CheckSources(self.lens->Lens(), samples);
  }
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

void vtkDspaceViewport::SetLook(const dspace::ViewLook& look) {
  Internals& self = *this->Impl;
  dspace::CheckLook(*self.context->GetHub(), self.Object(), look);
  self.look = look;
  self.stale = true;
}

void vtkDspaceViewport::SetNavigation(const dspace::Navigation& navigation) {
  navigation.Check(this->Impl->Object());
  this->Impl->navigation = navigation;
}

const dspace::Navigation& vtkDspaceViewport::GetNavigation() const {
  return this->Impl->navigation;
}

double vtkDspaceViewport::GetUsedExposure() const {
  return this->Impl->lens ? this->Impl->lens->Exposure() : this->Impl->picture.Exposure();
}

const dspace::ViewLook& vtkDspaceViewport::GetLook() const {
  return this->Impl->look;
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

void vtkDspaceViewport::SetBarShown(
    std::function<bool(const dspace::ColorBar&, const dspace::DrawFilter&)> shown) {
  this->Impl->explains = std::move(shown);
}

bool vtkDspaceViewport::IsOutdated() {
  if (this->Impl->prepare) {
    this->Impl->prepare();
  }
  dspace::VtkErrorTrap trap(this->Impl->context->GetMessages()); // pipelines of props are updated
  const bool outdated =
      this->Impl->stale || this->Impl->drawnRevision != this->Impl->scene->Revision();
  trap.Check(this->Impl->Object());
  return outdated;
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

std::vector<std::uint8_t> vtkDspaceViewport::GetPicture() {
  if (this->Impl->picture.Texture() == 0) {
    this->ForceRender();
  }
  return this->Impl->picture.Read();
}

unsigned int vtkDspaceViewport::GetTexture() const {
  return this->Impl->picture.Texture();
}

void vtkDspaceViewport::MakeContextCurrent() {
  this->Impl->context->GetHub()->MakeCurrent();
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
    } else if (this->IsOutdated() || !self.Complete()) {
      self.DrawOwn(true);
    }
    capture.color = self.picture.Read();
  }
  const bool labels = request.label || request.depth || request.range;
  const bool light = request.radiance || request.incidence || request.emission || request.phase ||
                     request.litFraction || request.normal;
  if (labels || light) {
    self.RequireNoLens("a plane but colour");
  }
  if (labels) {
    self.DrawLabels(self.labels, filter);
    if (request.label) {
      capture.label = self.labels.Labels();
    }
    if (request.depth) {
      capture.depth = self.labels.Depths();
    }
    if (request.range) {
      capture.range = self.labels.Ranges();
    }
  }
  if (light) {
    self.DrawLight(request, capture);
  }
  return capture;
}

std::vector<dspace::ObjectVisibility> vtkDspaceViewport::Explain() {
  Internals& self = *this->Impl;
  self.RequireNoLens("an explanation");
  const dspace::DrawFilter filter = self.Filter({});
  self.DrawLabels(self.labels, filter);
  return dspace::ExplainView(*self.scene, self.labels.View(), filter, self.labels.Labels());
}

dspace::PickResult vtkDspaceViewport::Pick(double x, double y, int radius) {
  Internals& self = *this->Impl;
  dspace::CheckPick(self.Object(), x, y, radius, self.width, self.height);
  dspace::DrawFilter filter = self.Filter({});
  filter.pickableOnly = true;
  if (self.lens && !self.FollowLens(x, y, radius)) {
    return {};
  }
  self.DrawLabels(self.labels, filter);
  std::array<int, 2> pixel;
  dspace::PickResult pick = self.labels.Pick(*self.scene, x, y, radius, pixel);
  if (pick.object == 0) {
    return pick;
  }
  if (self.lens) { // from the source's axes to the camera's
    pick.p_camera = self.lens->Lens().sources[self.labelledSource].X_CF.Apply(pick.p_camera);
    pick.depth = pick.p_camera.z();
  }
  const std::vector<std::string> parts = PartsOf(self.scene->Object(pick.object));
  const bool same = std::all_of(parts.begin(), parts.end(),
                                [&](const std::string& name) { return name == parts[0]; });
  if (same) {
    pick.part = parts.empty() ? std::string() : parts[0];
    return pick;
  }
  filter.partsOf = pick.object;
  self.DrawLabels(self.parts, filter);
  const std::uint32_t number = self.parts.LabelAt(pixel);
  pick.part = number > 0 && number <= parts.size() ? parts[number - 1] : std::string();
  return pick;
}

void vtkDspaceViewport::Run(const std::function<void(vtkRenderWindow*)>& f) {
  Internals& self = *this->Impl;
  self.picture.Activate(self.width, self.height, self.samples);
  dspace::VtkErrorTrap trap(self.context->GetMessages());
  f(self.context->GetHub());
  self.stale = true;
  trap.Check(self.Object());
}
