// Objects: imported from files, changed, removed.
#include <cmath>
#include <filesystem>

#include <dspace/FrameRules.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/Checks.h>

namespace dspace::session {
namespace {

// Files seldom say their unit: a size that no vehicle or building has is pointed out, not changed.
void WarnOfSize(const Model& model, double scale, v1::Reply& reply) {
  const Eigen::AlignedBox3d bounds = model.Bounds();
  const double size = bounds.isEmpty() ? 0.0 : scale * bounds.sizes().maxCoeff();
  if (size > 1000.0 || (size > 0.0 && size < 1e-3)) {
    reply.add_warning("file '" + model.path + "': the model is " + NumberText(size) +
                      " m across; give `scale` if its unit is not the metre");
  }
}

DetailLevel LoadLevel(const Context& context, v1::ImportObject& command,
                      v1::ImportObject::Level& level, const Eigen::Quaterniond& rotation) {
  level.set_path(AbsolutePath(level.path()));
  const double scale = command.has_scale() ? command.scale() : 1.0;
  ImportOptions options;
  options.strict = command.strict();
  options.pointCloud = command.point_cloud();
  const std::shared_ptr<const Model> model = context.state.models.LoadModel(level.path(), options);
  for (const std::string& warning : model->warnings) {
    context.reply.add_warning(warning);
  }
  WarnOfSize(*model, scale, context.reply);
  DetailLevel made;
  made.parts = PartsOf(model, scale, rotation);
  made.minimumPixels = level.minimum_pixels();
  return made;
}

void ImportObject(const Context& context, v1::ImportObject& command) {
  if (command.level_size() == 0 || command.level(0).path().empty()) {
    Reject("command import_object", "it names no file; accepted: at least one level with a path");
  }
  const std::string file = "file '" + command.level(0).path() + "'";
  const double scale = command.has_scale() ? command.scale() : 1.0;
  Require(scale >= MinimumScale && scale <= MaximumScale, file, "the scale", scale,
          "1e-12 to 1e12");
  Eigen::Quaterniond rotation = RotationToZUp(command.up(), file);
  if (command.has_rotation()) {
    rotation = ToRotation(command.rotation(), file) * rotation;
  }
  std::vector<DetailLevel> levels;
  for (v1::ImportObject::Level& level : *command.mutable_level()) {
    levels.push_back(LoadLevel(context, command, level, rotation));
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
  scene.SetObjectOffset(command.object(),
                        ToAffine(command.offset(), ObjectLabel(scene, command.object())));
}

void AttachObject(const Context& context, v1::AttachObject& command) {
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
