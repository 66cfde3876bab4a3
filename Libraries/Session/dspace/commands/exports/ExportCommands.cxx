// Scenes to files of other programs.
#include <dspace/Checks.h>
#include <dspace/export/SceneExport.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/messages/CommandTraits.h>
#include <dspace/state/ModelCache.h>

namespace dspace::session {
namespace {

constexpr std::size_t StandardTriangles = 200000;

void ExportScene(const Context& context, v1::ExportScene& command) {
  command.set_path(AbsolutePath(command.path()));
  const std::string label = "file '" + command.path() + "'";
  SceneExportOptions options;
  options.ornaments = command.ornaments();
  options.lights = !command.no_lights();
  options.fragments = {command.fragment().begin(), command.fragment().end()};
  options.times = {command.time_s().begin(), command.time_s().end()};
  options.frames = {command.frame().begin(), command.frame().end()};
  if (command.pose_size() % PoseSize != 0) {
    Reject(label, "the animation has " + std::to_string(command.pose_size()) +
                      " numbers of poses; accepted: 8 a pose");
  }
  for (int i = 0; i < command.pose_size(); i += PoseSize) {
    options.poses.push_back(PoseFromRow(command.pose().data() + i));
  }
  const std::size_t budget =
      command.triangle_budget() ? command.triangle_budget() : StandardTriangles;
  const SceneState& state = *context.scene;
  options.partsOf = [&state, budget](const GraphicsObject& object) {
    return state.GroundOf(object, budget);
  };
  for (std::string& warning : dspace::ExportScene(*state.scene, command.path(), options)) {
    context.reply.add_warning(std::move(warning));
  }
}

} // namespace

void AddExportCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kExportScene, &C::mutable_export_scene, ExportScene);
}

} // namespace dspace::session
