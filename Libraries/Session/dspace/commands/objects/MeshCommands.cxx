// Objects made of arrays, and parts of objects.
#include <dspace/Checks.h>
#include <dspace/commands/objects/MeshArrays.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

void CreateMesh(const Context& context, v1::CreateMesh& command) {
  v1::ObjectSettings& settings = *command.mutable_object();
  const std::string label = settings.name().empty() ? "mesh" : "object '" + settings.name() + "'";
  std::vector<DetailLevel> levels = LevelsOf(*command.mutable_level(), context.state, label);
  context.scene->meshes.insert(AddObject(context, settings, "mesh", std::move(levels)));
}

void SetMesh(const Context& context, v1::SetMesh& command) {
  Scene& scene = context.GetScene();
  const ObjectId id = command.object();
  scene.Object(id); // throws where there is none
  if (context.scene->meshes.count(id) == 0) {
    Reject(ObjectLabel(scene, id), "it is not made of arrays; accepted: objects of create_mesh");
  }
  scene.SetObjectLevels(id,
                        LevelsOf(*command.mutable_level(), context.state, ObjectLabel(scene, id)));
}

constexpr std::size_t StandardTriangles = 200000;

void GetMesh(const Context& context, v1::GetMesh& command) {
  const GraphicsObject& object = context.GetScene().Object(command.object());
  const std::string label = ObjectLabel(context.GetScene(), command.object());
  const bool ground = context.scene->TerrainOf(command.object()) != nullptr;
  if (object.custom && !ground) {
    throw Error(Error::Kind::Unsupported, label,
                "code of the process draws it; accepted: objects made of meshes");
  }
  if (object.billboard) {
    Reject(label, "it is a label, whose geometry is in pixels; accepted: objects in metres");
  }
  std::vector<Part> parts;
  if (ground) {
    const std::uint64_t budget = command.triangle_budget();
    parts = context.scene->GroundOf(object, budget != 0 ? budget : StandardTriangles);
  } else if (!object.levels.empty()) {
    parts = object.levels.front().parts;
  }
  v1::MeshReply* reply = context.reply.mutable_mesh();
  for (const Part& part : parts) {
    PutMesh(object, part, reply->add_mesh());
  }
}

void SetPart(const Context& context, v1::SetPart& command) {
  Scene& scene = context.GetScene();
  const GraphicsObject& object = scene.Object(command.object());
  const auto found = object.parts.find(command.part());
  const PartOverride none;
  const PartOverride& old = found == object.parts.end() ? none : found->second;
  PartOverride made;
  made.material = ApplyMaterial(
      *command.mutable_material(), command.replace() ? none.material : old.material, context.state,
      ObjectLabel(scene, command.object()) + ", part '" + command.part() + "'");
  made.visible = command.has_visible() ? command.visible() : old.visible;
  scene.SetPart(command.object(), command.part(), made);
}

} // namespace

void AddMeshCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreateMesh, &C::mutable_create_mesh, CreateMesh);
  registry.Add(C::kSetMesh, &C::mutable_set_mesh, SetMesh);
  registry.Add(C::kGetMesh, &C::mutable_get_mesh, GetMesh);
  registry.Add(C::kSetPart, &C::mutable_set_part, SetPart);
}

} // namespace dspace::session
