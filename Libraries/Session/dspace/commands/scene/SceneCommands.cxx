// Scenes and time.
#include <algorithm>
#include <optional>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/commands/scene/CameraTools.h>
#include <dspace/ephemeris/Fallbacks.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/messages/Convert.h>
#include <dspace/messages/SunMessages.h>
#include <dspace/state/SunPlace.h>

namespace dspace::session {
namespace {

void CreateScene(const Context& context, v1::CreateScene& command) {
  RequireName("scene", context.sceneName);
  if (context.state.scenes.count(context.sceneName)) {
    throw Error(Error::Kind::AlreadyExists, "scene '" + context.sceneName + "'",
                "there is a scene of this name already");
  }
  auto scene = std::make_shared<Scene>(context.sceneName);
  const std::vector<std::string> vantages = scene->VantageNames();
  if (std::find(vantages.begin(), vantages.end(), DefaultVantage) == vantages.end()) {
    scene->CreateVantage(DefaultVantage);
  }
  if (!command.no_lights()) {
    scene->SetLight(ToLight(DefaultSun()));
  }
  context.state.scenes[context.sceneName].scene = std::move(scene);
  context.reply.mutable_scenes()->add_name(context.sceneName);
}

void RemoveScene(const Context& context, v1::RemoveScene&) {
  for (const auto& [name, viewport] : context.state.viewports) {
    if (viewport.scene == context.sceneName) {
      Reject("scene '" + context.sceneName + "'",
             "viewport '" + name + "' shows it; remove the viewport first");
    }
  }
  context.state.scenes.erase(context.sceneName);
}

void ListScenes(const Context& context, v1::ListScenes&) {
  v1::SceneList* list = context.reply.mutable_scenes();
  for (const auto& [name, scene] : context.state.scenes) {
    list->add_name(name);
  }
}

// Moves what follows the time, or throws and moves nothing.
void MoveSky(const Context& context, const v1::SkyStep& step) {
  std::optional<Light> sun;
  if (step.has_sun()) {
    sun = MovedSun(context.GetScene(), step.sun());
  }
  if (step.frame_size() > 0) {
    const std::size_t n = RowsOf(step.pose_size(), PoseSize, "command set_time", "sky.pose");
    if (n != std::size_t(step.frame_size())) {
      Reject("command set_time", "its sky has " + std::to_string(n) + " poses for " +
                                     std::to_string(step.frame_size()) +
                                     " frames; accepted: one for each");
    }
    context.Frames().SetLocalPoses(step.frame().data(), step.pose().data(), n);
  }
  if (sun) {
    context.GetScene().SetLight(*sun);
  }
}

void SetTime(const Context& context, v1::SetTime& command) {
  RequireFinite("scene '" + context.sceneName + "'", "the time", command.time_s());
  Scene& scene = context.GetScene();
  Scene::Lags lags;
  for (const v1::CameraLag& lag : command.lag()) {
    const Camera& camera = scene.Vantage(lag.vantage()).GetCamera(lag.camera());
    RequirePosition("camera '" + camera.name + "'", "its lag", ToVector(lag.position()));
    RequireFinite("camera '" + camera.name + "'", "the time of its lag", lag.time_s());
    lags[{lag.vantage(), lag.camera()}] = {true, lag.time_s(), lag.frame(), lag.parent(),
                                           ToVector(lag.position())};
  }
  SkyMotions& sky = context.scene->sky;
  if (!command.has_sky() || command.sky().time_s() != command.time_s()) {
    command.clear_sky();
    if (sky.Any()) {
      const FallbackScope scope; // a warning is given once, not at every step
      *command.mutable_sky() = sky.At(context.Frames(), command.time_s());
      for (std::string& warning : sky.NewFallbacks()) {
        context.reply.add_warning(std::move(warning));
      }
    }
  }
  MoveSky(context, command.sky());
  scene.SetTime(command.time_s());
  if (!command.put_lags()) { // a snapshot's has a time of a scene without one too
    context.scene->NoteTime(command.time_s());
  }
  for (std::string& warning : context.scene->MoveTrajectories()) {
    context.reply.add_warning(std::move(warning));
  }
  if (command.put_lags()) {
    scene.SetLags(std::move(lags));
  }
  context.reply.mutable_time()->set_time_s(command.time_s());
  for (const auto& [camera, lag] : scene.GetLags()) {
    PutLag(camera, lag, context.reply.mutable_time()->add_lag());
  }
}

void GetTime(const Context& context, v1::GetTime&) {
  context.reply.mutable_time()->set_time_s(context.GetScene().Time());
}

} // namespace

void AddSceneCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreateScene, &C::mutable_create_scene, CreateScene, Needs::Nothing);
  registry.Add(C::kRemoveScene, &C::mutable_remove_scene, RemoveScene);
  registry.Add(C::kListScenes, &C::mutable_list_scenes, ListScenes, Needs::Nothing);
  registry.Add(C::kSetTime, &C::mutable_set_time, SetTime);
  registry.Add(C::kGetTime, &C::mutable_get_time, GetTime);
}

} // namespace dspace::session
