#include <dspace/commands/viewports/ViewportCommands.h>

#include <algorithm>

#include <dspace/Checks.h>
#include <dspace/clipmap/gl/ClipmapDrawing.h>
#include <dspace/commands/cameras/PlacedLens.h>
#include <dspace/commands/viewports/ShownLens.h>
#include <dspace/messages/Convert.h>
#include <dspace/render/bodies/BodyDrawer.h>
#include <dspace/render/props/VtkPropDrawer.h>
#include <dspace/render/stars/StarDrawer.h>
#include <dspace/render/trajectories/TrajectoryDrawer.h>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"

namespace dspace::session {
namespace {

std::string Label(const std::string& name) {
  return "viewport '" + name + "'";
}

std::string FreeName(const std::map<std::string, ViewportState>& viewports) {
  std::string name = "viewport";
  for (int n = 2; viewports.count(name); ++n) {
    name = "viewport " + std::to_string(n);
  }
  return name;
}

// The settings of a picture's light that the command gives, over the present ones.
ViewLook ToLook(const v1::SetViewport& from, ViewLook look, const std::string& label) {
  if (from.has_shadows()) {
    look.shadows.shown = from.shadows();
  }
  if (from.has_shadow_cascades()) {
    look.shadows.cascades = ToInt(from.shadow_cascades());
  }
  if (from.has_shadow_map_size()) {
    look.shadows.size = ToInt(from.shadow_map_size());
  }
  if (from.has_shadow_distance()) {
    look.shadows.distance = from.shadow_distance();
  }
  if (from.has_cascade_colors()) {
    look.shadows.cascadeColors = from.cascade_colors();
  }
  if (from.has_lit_colors()) {
    look.shadows.litColors = from.lit_colors();
  }
  if (from.has_fill()) {
    look.fill = from.fill();
  }
  if (from.has_exposure()) {
    look.exposure = from.exposure();
  }
  if (from.has_automatic_exposure()) {
    look.automaticExposure = from.automatic_exposure();
  }
  if (from.has_tone()) {
    if (!v1::SetViewport::Tone_IsValid(from.tone())) {
      Reject(label, "its tone is " + std::to_string(int(from.tone())) +
                        "; accepted: LINEAR (0), FILMIC (1)");
    }
    look.tone = from.tone() == v1::SetViewport::FILMIC ? ToneCurve::Filmic : ToneCurve::Linear;
  }
  return look;
}

Navigation ToNavigation(const v1::SetViewport& from, Navigation to, const std::string& label) {
  if (from.has_navigation()) {
    if (!v1::SetViewport::Navigation_IsValid(from.navigation())) {
      Reject(label, "its navigation is " + std::to_string(int(from.navigation())) +
                        "; accepted: ORBIT (0), WALK (1), MAP (2)");
    }
    to.kind = static_cast<Navigation::Kind>(from.navigation());
  }
  if (from.has_eye_height()) {
    to.eyeHeight = from.eye_height();
  }
  if (from.has_walk_speed()) {
    to.walkSpeed = from.walk_speed();
  }
  to.Check(label);
  return to;
}

void PutLook(const ViewLook& from, v1::ViewportInfo& to) {
  to.set_shadows(from.shadows.shown);
  to.set_shadow_cascades(std::uint32_t(from.shadows.cascades));
  to.set_shadow_map_size(std::uint32_t(from.shadows.size));
  to.set_shadow_distance(from.shadows.distance);
  to.set_cascade_colors(from.shadows.cascadeColors);
  to.set_lit_colors(from.shadows.litColors);
  to.set_fill(from.fill);
  to.set_exposure(from.exposure);
  to.set_automatic_exposure(from.automaticExposure);
  to.set_tone(from.tone == ToneCurve::Filmic ? v1::SetViewport::FILMIC : v1::SetViewport::LINEAR);
}

constexpr double DefaultFill = 0.2; // of new viewports: shadowed sides are not black

void RequireCamera(const Scene& scene, const std::string& vantage, const std::string& camera) {
  const SceneVantage& found = scene.Vantage(vantage);
  if (!camera.empty()) {
    found.GetCamera(camera);
  }
}

} // namespace

ViewportCommands::ViewportCommands() = default;
ViewportCommands::~ViewportCommands() {
  this->Clear();
}

void ViewportCommands::Clear() {
  for (const auto& [name, viewport] : this->Viewports_) {
    viewport->SetBeforeDrawing({}); // other code may still own it
    viewport->SetBarShown({});
  }
  this->Viewports_.clear();
  this->Lenses_.clear();
  this->LensPictures_.Clear();
  this->RenderContext_ = nullptr;
}

vtkDspaceViewport* ViewportCommands::Find(const std::string& name) const {
  const auto found = this->Viewports_.find(name);
  return found == this->Viewports_.end() ? nullptr : found->second.Get();
}

vtkDspaceViewport& ViewportCommands::Get(const std::string& name) const {
  vtkDspaceViewport* viewport = this->Find(name);
  if (!viewport) {
    throw Error(Error::Kind::NotFound, Label(name), "there is no such viewport");
  }
  return *viewport;
}

void ViewportCommands::SetRenderContext(vtkDspaceRenderContext* context) {
  this->RenderContext_ = context;
  if (context) {
    RegisterClipmapDrawer(context->GetDrawers());
    RegisterBodyDrawer(context->GetDrawers());
    RegisterStarDrawer(context->GetDrawers());
    RegisterTrajectoryDrawer(context->GetDrawers());
    RegisterVtkPropDrawer(context->GetDrawers());
    for (const auto& [geometry, maker] : this->Drawers_) {
      context->GetDrawers().Register(geometry, maker);
    }
  }
}

void ViewportCommands::AddDrawer(std::type_index geometry, const CustomDrawers::Maker& maker) {
  this->Drawers_[geometry] = maker;
  if (this->RenderContext_) {
    this->RenderContext_->GetDrawers().Register(geometry, maker);
  }
}

vtkDspaceRenderContext* ViewportCommands::GetRenderContext() {
  if (!this->RenderContext_) {
    this->SetRenderContext(vtkSmartPointer<vtkDspaceRenderContext>::New());
  }
  return this->RenderContext_;
}

void ViewportCommands::ReleaseRenderContext() {
  if (this->RenderContext_) {
    this->RenderContext_->Release();
  }
}

void ViewportCommands::Create(const Context& context, v1::CreateViewport& command) {
  const std::string name =
      command.name().empty() ? FreeName(context.state.viewports) : command.name();
  const std::string vantage = command.vantage().empty() ? DefaultVantage : command.vantage();
  RequireName("viewport", name);
  if (this->Viewports_.count(name)) {
    throw Error(Error::Kind::AlreadyExists, Label(name),
                "there is a viewport of this name already");
  }
  RequireCamera(context.GetScene(), vantage, command.camera());
  auto viewport = vtkSmartPointer<vtkDspaceViewport>::New();
  const int samples = command.has_samples() ? ToInt(command.samples()) : viewport->GetSamples();
  viewport->Initialize(this->GetRenderContext(), context.scene->scene, name, vantage,
                       ToInt(command.width()), ToInt(command.height()), samples);
  if (!command.camera().empty()) {
    viewport->SetCamera(command.camera());
  }
  viewport->SetVisible(!command.hidden());
  ViewLook look = viewport->GetLook();
  look.fill = DefaultFill;
  viewport->SetLook(look);
  const State& state = context.state;
  viewport->SetBeforeDrawing(
      [this, &state, name, scene = context.sceneName, drawn = viewport.Get()] {
        const auto found = state.scenes.find(scene);
        if (found != state.scenes.end()) {
          this->LiveTables_.Update(name, found->second.telemetry, *drawn);
        }
      });
  viewport->SetBarShown(
      [&state, name, scene = context.sceneName](const ColorBar& bar, const DrawFilter& filter) {
        const auto found = state.scenes.find(scene);
        if (found == state.scenes.end() || found->second.terrains.count(bar.terrain) == 0) {
          return false;
        }
        const TerrainObject& terrain = *found->second.terrains.at(bar.terrain);
        const GraphicsObject& object = found->second.scene->Object(terrain.Object());
        const auto shown = [&](const Membership& member) { return filter.Shows(member); };
        return object.visible && shown({object.nature, object.fragment}) &&
               terrain.Explains(name, bar.layer, shown);
      });
  command.set_name(name);
  this->Viewports_[name] = viewport;
  ViewportState& place = context.state.viewports[name];
  place.scene = context.sceneName;
  place.vantage = vantage;
  place.camera = command.camera();
  context.reply.mutable_viewport()->set_name(name);
}

void ViewportCommands::Remove(const Context& context, v1::RemoveViewport& command) {
  this->Get(command.viewport()).SetBeforeDrawing({});
  this->Get(command.viewport()).SetBarShown({});
  this->LiveTables_.RemoveViewport(command.viewport());
  this->Controllers_.erase(command.viewport());
  this->Lenses_.erase(command.viewport());
  this->Viewports_.erase(command.viewport());
  const auto scene = context.state.scenes.find(context.state.viewports[command.viewport()].scene);
  if (scene != context.state.scenes.end()) {
    for (const auto& [name, terrain] : scene->second.terrains) {
      terrain->ForgetViewport(command.viewport());
    }
  }
  context.state.viewports.erase(command.viewport());
}

void ViewportCommands::Resize(const Context&, v1::ResizeViewport& command) {
  this->Get(command.viewport()).Resize(ToInt(command.width()), ToInt(command.height()));
}

void ViewportCommands::Move(const Context& context, v1::MoveViewport& command) {
  this->Get(command.viewport());
  ViewportState& place = context.state.viewports[command.viewport()];
  place.x = command.x();
  place.y = command.y();
}

void ViewportCommands::Set(const Context& context, v1::SetViewport& command) {
  vtkDspaceViewport& viewport = this->Get(command.viewport());
  ViewportState& place = context.state.viewports[command.viewport()];
  const std::string label = Label(command.viewport());
  // All checks first.
  const std::string vantage = command.has_vantage() ? command.vantage() : place.vantage;
  std::string camera = command.has_camera() ? command.camera() : place.camera;
  if (command.has_vantage() && !command.has_camera() && vantage != place.vantage) {
    camera.clear(); // another vantage has other cameras: its active one
  }
  const Scene& scene = *viewport.GetScene();
  RequireCamera(scene, vantage, camera);
  if (command.has_samples()) {
    viewport.RequireSamples(ToInt(command.samples()));
  }
  std::array<double, 3> bottom = place.background;
  std::array<double, 3> top = place.backgroundTop;
  if (command.has_background()) {
    bottom = top = ToColor(command.background(), label);
  }
  if (command.has_background_top()) {
    top = ToColor(command.background_top(), label);
  }
  const Navigation navigation = ToNavigation(command, viewport.GetNavigation(), label);
  const ViewLook before = viewport.GetLook();
  viewport.SetLook(ToLook(command, before, label));
  if (command.has_lens()) {
    try {
      this->SetLens(command.viewport(), command.lens()); // the last that can fail
    } catch (...) {
      viewport.SetLook(before);
      throw;
    }
  }
  viewport.SetNavigation(navigation);
  if (vantage != place.vantage) {
    viewport.SetCamera("");
    viewport.SetVantage(vantage);
  }
  viewport.SetCamera(camera);
  place.vantage = vantage;
  place.camera = camera;
  if (command.has_visible()) {
    viewport.SetVisible(command.visible());
  }
  if (command.has_background() || command.has_background_top()) {
    viewport.SetBackground(bottom, top);
    place.background = bottom;
    place.backgroundTop = top;
  }
  if (command.has_samples()) {
    viewport.SetSamples(int(command.samples()));
  }
  if (command.has_ornaments()) {
    viewport.SetOrnamentsVisible(command.ornaments());
    place.ornaments = command.ornaments();
  }
  if (command.has_corner_axes()) {
    viewport.SetCornerAxes(command.corner_axes());
    place.cornerAxes = command.corner_axes();
  }
}

void ViewportCommands::SetLens(const std::string& name, const std::string& json) {
  if (json.empty()) {
    this->Get(name).SetLens({});
    this->Lenses_.erase(name);
    return;
  }
  this->Get(name).SetLens(
      [model = ParseModel(json)](int width, int height) { return ShowLens(model, width, height); });
  this->Lenses_[name] = json;
}

void ViewportCommands::SetFragment(const Context& context, v1::SetViewportFragment& command) {
  vtkDspaceViewport& viewport = this->Get(command.viewport());
  viewport.GetScene()->Fragments().Get(command.fragment()); // throws where there is none
  viewport.SetFragmentVisible(command.fragment(), command.visible());
  std::set<std::string>& hidden = context.state.viewports[command.viewport()].hiddenFragments;
  if (command.visible()) {
    hidden.erase(command.fragment());
  } else {
    hidden.insert(command.fragment());
  }
}

void ViewportCommands::SetTable(const Context&, v1::SetTextTable& command) {
  this->LiveTables_.Set(command, this->Get(command.viewport()));
}

void ViewportCommands::RemoveTable(const Context&, v1::RemoveTextTable& command) {
  this->Get(command.viewport()).RemoveTextTable(command.name());
  this->LiveTables_.Remove(command.viewport(), command.name());
}

void ViewportCommands::Describe(const Context& context, v1::DescribeViewport& command) {
  vtkDspaceViewport& viewport = this->Get(command.viewport());
  const ViewportState& place = context.state.viewports[command.viewport()];
  v1::ViewportInfo* info = context.reply.mutable_viewport_info();
  info->set_name(command.viewport());
  info->set_scene(place.scene);
  info->set_vantage(place.vantage);
  info->set_camera(place.camera);
  info->set_width(std::uint32_t(viewport.GetWidth()));
  info->set_height(std::uint32_t(viewport.GetHeight()));
  info->set_x(place.x);
  info->set_y(place.y);
  info->set_visible(viewport.GetVisible());
  info->set_samples(std::uint32_t(viewport.GetSamples()));
  info->set_ornaments(place.ornaments);
  info->set_corner_axes(place.cornerAxes);
  PutLook(viewport.GetLook(), *info);
  const Navigation& navigation = viewport.GetNavigation();
  info->set_navigation(static_cast<v1::SetViewport::Navigation>(navigation.kind));
  info->set_eye_height(navigation.eyeHeight);
  info->set_walk_speed(navigation.walkSpeed);
  const auto lens = this->Lenses_.find(command.viewport());
  info->set_lens(lens == this->Lenses_.end() ? "" : lens->second);
  for (const std::string& fragment : place.hiddenFragments) {
    info->add_hidden_fragment(fragment);
  }
}

void ViewportCommands::List(const Context& context, v1::ListViewports&) {
  v1::ViewportList* list = context.reply.mutable_viewports();
  for (const auto& [name, viewport] : this->Viewports_) {
    list->add_name(name);
  }
}

void ViewportCommands::AddTo(Registry& registry) {
  using C = v1::Command;
  const auto bind = [this](auto method) {
    return [this, method](const Context& context, auto& message) {
      (this->*method)(context, message);
    };
  };
  using V = ViewportCommands;
  const auto none = Needs::Nothing; // viewports are the session's
  registry.Add(C::kCreateViewport, &C::mutable_create_viewport, bind(&V::Create));
  registry.Add(C::kRemoveViewport, &C::mutable_remove_viewport, bind(&V::Remove), none);
  registry.Add(C::kResizeViewport, &C::mutable_resize_viewport, bind(&V::Resize), none);
  registry.Add(C::kMoveViewport, &C::mutable_move_viewport, bind(&V::Move), none);
  registry.Add(C::kSetViewport, &C::mutable_set_viewport, bind(&V::Set), none);
  registry.Add(C::kSetViewportFragment, &C::mutable_set_viewport_fragment, bind(&V::SetFragment),
               none);
  registry.Add(C::kSetTextTable, &C::mutable_set_text_table, bind(&V::SetTable), none);
  registry.Add(C::kRemoveTextTable, &C::mutable_remove_text_table, bind(&V::RemoveTable), none);
  registry.Add(C::kViewportEvent, &C::mutable_viewport_event, bind(&V::Event), none);
  registry.Add(C::kDescribeViewport, &C::mutable_describe_viewport, bind(&V::Describe), none);
  registry.Add(C::kListViewports, &C::mutable_list_viewports, bind(&V::List), none);
  this->AddColorBarsTo(registry);
  this->AddShadersTo(registry);
  this->AddRequestsTo(registry);
}

} // namespace dspace::session
