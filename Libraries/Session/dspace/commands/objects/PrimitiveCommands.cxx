// Objects made of primitives.
#include <dspace/Checks.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/commands/objects/PrimitiveParts.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/Markers.h>

namespace dspace::session {
namespace {

constexpr double DefaultWarn_deg = 15.0;
constexpr double DefaultLimit_deg = 30.0;

void CreatePrimitive(const Context& context, v1::CreatePrimitive& command) {
  v1::ObjectSettings& settings = *command.mutable_object();
  std::pair<double, double> limits(DefaultWarn_deg, DefaultLimit_deg);
  std::vector<Part> parts = PartsOfShape(command);
  if (command.has_tilt()) {
    const v1::CreatePrimitive::Tilt& tilt = command.tilt();
    limits = {tilt.has_warn_deg() ? tilt.warn_deg() : limits.first,
              tilt.has_limit_deg() ? tilt.limit_deg() : limits.second};
    Put(TiltColor(tilt.tilt_deg(), limits.first, limits.second),
        settings.mutable_material()->mutable_color());
  }
  std::vector<DetailLevel> levels(1);
  levels[0].parts = std::move(parts);
  const ObjectId id = AddObject(context, settings, ShapeName(command), std::move(levels));
  context.scene->primitives.insert(id);
  if (command.has_tilt()) {
    context.scene->tilts[id] = limits;
  }
}

void SetPrimitive(const Context& context, v1::SetPrimitive& command) {
  Scene& scene = context.GetScene();
  scene.Object(command.object()); // throws where there is none
  const std::string label = ObjectLabel(scene, command.object());
  if (!context.scene->primitives.count(command.object())) {
    Reject(label, "it is not a primitive; accepted: an object of create_primitive");
  }
  const v1::CreatePrimitive& shape = command.shape();
  if (shape.has_tilt() != (context.scene->tilts.count(command.object()) != 0)) {
    Reject(label, "a tilt marker cannot become another shape, nor another shape a tilt marker");
  }
  std::vector<DetailLevel> levels(1);
  levels[0].parts = PartsOfShape(shape);
  scene.SetObjectLevels(command.object(), std::move(levels));
}

void SetTilt(const Context& context, v1::SetTilt& command) {
  Scene& scene = context.GetScene();
  MaterialOverride material = scene.Object(command.object()).material;
  const auto found = context.scene->tilts.find(command.object());
  if (found == context.scene->tilts.end()) {
    Reject(ObjectLabel(scene, command.object()), "it is not a tilt marker");
  }
  material.color = TiltColor(command.tilt_deg(), found->second.first, found->second.second);
  scene.SetObjectMaterial(command.object(), material);
}

} // namespace

void AddPrimitiveCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreatePrimitive, &C::mutable_create_primitive, CreatePrimitive);
  registry.Add(C::kSetPrimitive, &C::mutable_set_primitive, SetPrimitive);
  registry.Add(C::kSetTilt, &C::mutable_set_tilt, SetTilt);
}

} // namespace dspace::session
