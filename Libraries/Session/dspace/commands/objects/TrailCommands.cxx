// Trails.
#include <dspace/Checks.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/commands/objects/PrimitiveParts.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

Trail& FindTrail(const Context& context, ObjectId id) {
  context.GetScene().Object(id); // throws where there is none
  const auto found = context.scene->trails.find(id);
  if (found == context.scene->trails.end()) {
    Reject(ObjectLabel(context.GetScene(), id), "it is not a trail");
  }
  return found->second;
}

// One line as the object's only level; its vertices are relative to the trail's end.
std::vector<DetailLevel> LevelsOf(const Trail& trail) {
  std::vector<DetailLevel> levels(1);
  if (trail.Size() > 0) {
    levels[0].parts.push_back(PartOf(trail.LineMesh(trail.End())));
    levels[0].parts.back().X_OP.translation() = trail.End();
  }
  return levels;
}

void CreateTrail(const Context& context, v1::CreateTrail& command) {
  if (command.object().has_offset()) {
    Reject("trail", "it has an offset; accepted: none, its points are in the frame");
  }
  Trail trail(command.capacity(), command.minimum_spacing(), command.fade());
  const ObjectId id = AddObject(context, *command.mutable_object(), "trail", LevelsOf(trail));
  context.scene->trails.emplace(id, std::move(trail));
}

void AppendTrail(const Context& context, v1::AppendTrail& command) {
  Trail& trail = FindTrail(context, command.object());
  const std::string label = ObjectLabel(context.GetScene(), command.object());
  const std::size_t n = RowsOf(command.point_size(), 3, label, "point");
  for (std::size_t i = 0; i < n; ++i) {
    RequirePosition(label, "a point", Eigen::Vector3d(command.point().data() + 3 * i));
  }
  for (std::size_t i = 0; i < n; ++i) {
    trail.Add(Eigen::Vector3d(command.point().data() + 3 * i));
  }
  context.GetScene().SetObjectLevels(command.object(), LevelsOf(trail));
}

void ClearTrail(const Context& context, v1::ClearTrail& command) {
  Trail& trail = FindTrail(context, command.object());
  trail.Clear();
  context.GetScene().SetObjectLevels(command.object(), LevelsOf(trail));
}

} // namespace

void AddTrailCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreateTrail, &C::mutable_create_trail, CreateTrail);
  registry.Add(C::kAppendTrail, &C::mutable_append_trail, AppendTrail);
  registry.Add(C::kClearTrail, &C::mutable_clear_trail, ClearTrail);
}

} // namespace dspace::session
