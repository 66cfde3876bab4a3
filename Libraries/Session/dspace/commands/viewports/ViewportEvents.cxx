// What a person does in a viewport moves its camera.
#include <dspace/Checks.h>
#include <dspace/commands/scene/CameraTools.h>
#include <dspace/commands/viewports/SceneGround.h>
#include <dspace/commands/viewports/ViewportCommands.h>
#include <dspace/scene/CustomGeometry.h>
#include <dspace/scene/Stretch.h>

#include "vtkDspaceViewport.h"

namespace dspace::session {
namespace {

InputEvent::Key ToKey(const std::string& key) {
  static const std::map<std::string, InputEvent::Key> keys = {
      {"Left", InputEvent::Key::Left},    {"Right", InputEvent::Key::Right},
      {"Up", InputEvent::Key::Up},        {"Down", InputEvent::Key::Down},
      {"+", InputEvent::Key::Plus},       {"-", InputEvent::Key::Minus},
      {"f", InputEvent::Key::Frame},      {"r", InputEvent::Key::Reset},
      {"w", InputEvent::Key::Forward},    {"W", InputEvent::Key::Forward},
      {"s", InputEvent::Key::Backward},   {"S", InputEvent::Key::Backward},
      {"a", InputEvent::Key::StepLeft},   {"A", InputEvent::Key::StepLeft},
      {"d", InputEvent::Key::StepRight},  {"D", InputEvent::Key::StepRight},
      {"Escape", InputEvent::Key::Cancel}};
  const auto found = keys.find(key);
  return found == keys.end() ? InputEvent::Key::None : found->second;
}

InputEvent ToEvent(const v1::ViewportEvent& from) {
  const std::string label = "event of viewport '" + from.viewport() + "'";
  if (!v1::ViewportEvent::Type_IsValid(from.type()) ||
      !v1::ViewportEvent::Button_IsValid(from.button())) {
    Reject(label, "its type is " + std::to_string(int(from.type())) + " and its button " +
                      std::to_string(int(from.button())) + "; accepted: 0 to 5 and 0 to 3");
  }
  RequireFinite(label, "x", from.x());
  RequireFinite(label, "y", from.y());
  RequireFinite(label, "the wheel", from.wheel());
  InputEvent to;
  to.type = from.type() == v1::ViewportEvent::PRESS          ? InputEvent::Type::Press
            : from.type() == v1::ViewportEvent::RELEASE      ? InputEvent::Type::Release
            : from.type() == v1::ViewportEvent::WHEEL        ? InputEvent::Type::Wheel
            : from.type() == v1::ViewportEvent::KEY          ? InputEvent::Type::Key
            : from.type() == v1::ViewportEvent::DOUBLE_CLICK ? InputEvent::Type::DoubleClick
                                                             : InputEvent::Type::Move;
  to.x = from.x();
  to.y = from.y();
  to.button = static_cast<InputEvent::Button>(from.button());
  to.shift = from.shift();
  to.control = from.control();
  to.alt = from.alt();
  to.wheelSteps = from.wheel();
  to.key = ToKey(from.key());
  if (from.has_seconds()) {
    to.seconds = from.seconds();
  }
  return to;
}

// A sphere about all visible physical objects, in frame F; none where there is nothing.
std::optional<BoundingSphere> SceneBounds(const Scene& scene, FrameId F) {
  Eigen::AlignedBox3d box;
  for (const auto& [id, object] : scene.Objects()) {
    if ((object.levels.empty() && !object.custom) || object.nature != Nature::Physical ||
        !object.visible || (object.custom && object.custom->IsBackdrop())) {
      continue;
    }
    const BoundingSphere sphere =
        object.custom ? object.custom->Bounds() : object.levels.front().sphere;
    const Pose X = scene.Frames().RelativePose(F, object.frame);
    const double stretch = LargestStretch(object.X_FO) * X.scale;
    const Eigen::Vector3d center = X.Apply(object.X_FO * sphere.center);
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(sphere.radius * stretch);
    box.extend(Eigen::Vector3d(center - reach));
    box.extend(Eigen::Vector3d(center + reach));
  }
  if (box.isEmpty() || box.diagonal().norm() == 0.0) {
    return std::nullopt;
  }
  return BoundingSphere{box.center(), box.diagonal().norm() / 2};
}

} // namespace

void ViewportCommands::Event(const Context& context, v1::ViewportEvent& command) {
  vtkDspaceViewport& viewport = this->Get(command.viewport());
  const ViewportState& place = context.state.viewports[command.viewport()];
  const InputEvent event = ToEvent(command);
  Scene& scene = *viewport.GetScene();
  OrbitView view;
  const SceneVantage& vantage = scene.Vantage(place.vantage);
  view.camera = place.camera.empty() ? vantage.ActiveCamera() : vantage.GetCamera(place.camera);
  view.pose = scene.PlaceCamera(place.vantage, place.camera);
  view.width = viewport.GetWidth();
  view.height = viewport.GetHeight();
  const SceneGround ground(context.state.scenes.at(place.scene), view.pose.frame);
  view.ground = ground.Empty() ? nullptr : &ground;
  OrbitController& controller = this->Controllers_[command.viewport()];
  controller.SetNavigation(viewport.GetNavigation());
  if (OrbitController::NeedsPivot(event, viewport.GetNavigation().kind)) {
    const PickResult pick = viewport.Pick(event.x, event.y);
    if (pick.object != 0) {
      view.pivot_F = view.pose.X_FC.Apply(pick.p_camera);
    }
  }
  view.bounds_F = SceneBounds(scene, view.pose.frame);
  const OrbitResult result = controller.Handle(event, view);
  if (result.changed) {
    scene.SetCamera(place.vantage, result.camera);
  }
  const bool unusedKey = result.unused && !command.key().empty();
  if (result.picked || result.clicked != InputEvent::Button::None) {
    v1::Pick pick;
    pick.set_viewport(command.viewport());
    pick.set_x(result.x);
    pick.set_y(result.y);
    this->Pick(context, pick);
  }
  if (result.clicked != InputEvent::Button::None || unusedKey) {
    v1::InputReply input;
    if (!unusedKey) {
      *input.mutable_pick() = context.reply.pick();
      input.set_button(command.button());
    }
    input.set_key(unusedKey ? command.key() : "");
    input.set_x(command.x());
    input.set_y(command.y());
    input.set_shift(command.shift());
    input.set_control(command.control());
    input.set_alt(command.alt());
    *context.reply.mutable_input() = input;
  } else if (!result.picked && result.changed) {
    DescribeCamera(place.scene, scene, place.vantage, result.camera.name,
                   context.reply.mutable_camera());
  }
}

} // namespace dspace::session
