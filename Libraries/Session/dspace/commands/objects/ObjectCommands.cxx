// Objects: imported from files, changed, removed.
#include <cmath>
#include <filesystem>

#include <dspace/Checks.h>
#include <dspace/commands/objects/ImportTools.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

void ImportObject(const Context& context, v1::ImportObject& command) {
  ImportLabel(command);
  const double scale = ImportScale(command);
  const Eigen::Quaterniond rotation = ImportRotation(command);
  std::vector<DetailLevel> levels;
  for (v1::ImportObject::Level& level : *command.mutable_level()) {
    DetailLevel made;
    made.parts = PartsOf(ImportLevel(context, command, level, false, false), scale, rotation);
    made.minimumPixels = level.minimum_pixels();
    levels.push_back(std::move(made));
  }
  const std::string stem = std::filesystem::path(command.level(0).path()).stem().string();
  AddObject(context, *command.mutable_object(), stem, std::move(levels));
}

void RemoveObject(const Context& context, v1::RemoveObject& command) {
  const ObjectId id = command.object();
  SceneState& state = *context.scene;
  for (const auto& [name, robot] : state.robots) {
    if (robot->HasObject(id)) {
      Reject(ObjectLabel(*state.scene, id),
             "it belongs to robot '" + name + "'; accepted: hide it, or remove the robot");
    }
  }
  for (const auto& [base, model] : state.models) {
    if (model.HasObject(id)) {
      Reject(ObjectLabel(*state.scene, id),
             "it belongs to a model whose nodes are frames; accepted: hide it, or remove frame '" +
                 state.scene->Frames().Path(base) + "'");
    }
  }
  for (const auto& [name, terrain] : state.terrains) {
    if (terrain->Object() == id) {
      Reject(ObjectLabel(*state.scene, id),
             "it is terrain '" + name + "'; accepted: command remove_terrain");
    }
  }
  state.scene->RemoveObject(id);
  state.EraseRemoved();
}

void SetObjectVisible(const Context& context, v1::SetObjectVisible& command) {
  context.GetScene().SetObjectVisible(command.object(), command.visible());
}

void SetMaterial(const Context& context, v1::SetMaterial& command) {
  Scene& scene = context.GetScene();
  const auto drawn = context.scene->drawn.find(command.object());
  if (drawn != context.scene->drawn.end() && drawn->second.IsProp()) {
    Reject(ObjectLabel(scene, command.object()),
           "it is a prop of VTK; accepted: the vtkProperty of the prop");
  }
  const MaterialOverride imported;
  const MaterialOverride& old = scene.Object(command.object()).material;
  const MaterialOverride& base = command.replace() ? imported : old;
  scene.SetObjectMaterial(command.object(),
                          ApplyMaterial(*command.mutable_material(), base, context.state,
                                        ObjectLabel(scene, command.object())));
}

void SetObjectOffset(const Context& context, v1::SetObjectOffset& command) {
  Scene& scene = context.GetScene();
  for (const auto& [name, terrain] : context.scene->terrains) {
    if (terrain->Object() == command.object()) {
      Reject(ObjectLabel(scene, command.object()),
             "terrain '" + name + "' is queried in its frame; accepted: move the frame");
    }
  }
  if (context.scene->trajectories.count(command.object())) {
    Reject(ObjectLabel(scene, command.object()),
           "it is a trajectory, whose points are in its frame; accepted: move the frame");
  }
  scene.SetObjectOffset(command.object(),
                        ToAffine(command.offset(), ObjectLabel(scene, command.object())));
}

void AttachObject(const Context& context, v1::AttachObject& command) {
  const auto found = context.scene->trajectories.find(command.object());
  if (found != context.scene->trajectories.end() && found->second->Follower() != NoFrame) {
    Reject(ObjectLabel(context.GetScene(), command.object()),
           "frame '" + context.Frames().Path(found->second->Follower()) +
               "' follows it; accepted: set_trajectory_frame with frame 0 first");
  }
  context.GetScene().AttachObject(command.object(), ToFrame(command.frame()));
}

void MoveToFragment(const Context& context, v1::MoveToFragment& command) {
  context.GetScene().MoveToFragment(command.object(), command.fragment());
}

} // namespace

void AddObjectCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kImportObject, &C::mutable_import_object, ImportObject);
  registry.Add(C::kRemoveObject, &C::mutable_remove_object, RemoveObject);
  registry.Add(C::kSetObjectVisible, &C::mutable_set_object_visible, SetObjectVisible);
  registry.Add(C::kSetMaterial, &C::mutable_set_material, SetMaterial);
  registry.Add(C::kSetObjectOffset, &C::mutable_set_object_offset, SetObjectOffset);
  registry.Add(C::kAttachObject, &C::mutable_attach_object, AttachObject);
  registry.Add(C::kMoveToFragment, &C::mutable_move_to_fragment, MoveToFragment);
}

} // namespace dspace::session
