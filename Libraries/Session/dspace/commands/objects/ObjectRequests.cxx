// What objects there are, and what they are like.
#include <set>

#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/commands/objects/ShaderMessages.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/CustomGeometry.h>

namespace dspace::session {
namespace {

std::uint64_t TrianglesOf(const DetailLevel& level) {
  std::uint64_t triangles = 0;
  for (const Part& part : level.parts) {
    if (part.mesh && part.mesh->primitive == Mesh::Primitive::Triangles) {
      triangles += part.mesh->PrimitiveCount();
    }
  }
  return triangles;
}

void DescribeParts(const GraphicsObject& object, v1::ObjectInfo* info) {
  std::set<std::string> named = {""};
  for (const DetailLevel& level : object.levels) {
    for (const Part& part : level.parts) {
      if (named.insert(part.name).second) {
        info->add_part(part.name);
      }
    }
  }
  for (const auto& [name, over] : object.parts) {
    v1::SetPart* part = info->add_part_override();
    part->set_part(name);
    PutMaterial(over.material, part->mutable_material());
    part->set_visible(over.visible);
  }
}

void Describe(const GraphicsObject& object, const SceneState& scene, v1::ObjectInfo* info) {
  info->set_id(object.id);
  info->set_name(object.name);
  info->set_frame(object.frame);
  info->set_nature(FromNature(object.nature));
  info->set_fragment(object.fragment);
  info->set_visible(object.visible);
  PutMaterial(object.material, info->mutable_material());
  DescribeParts(object, info);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      info->add_offset(object.X_FO(row, column));
    }
  }
  if (object.shader) {
    PutShader(*object.shader, info->mutable_shader());
  }
  for (const DetailLevel& level : object.levels) {
    info->add_level(level.minimumPixels);
  }
  if (!object.levels.empty()) {
    const BoundingSphere& bounds = object.levels.front().sphere;
    info->set_triangles(TrianglesOf(object.levels.front()));
    Put(bounds.center, info->mutable_bounds_center());
    info->set_bounds_radius(bounds.radius);
    if (const Eigen::AlignedBox3d& box = object.levels.front().box; !box.isEmpty()) {
      Put(Eigen::Vector3d(box.min()), info->mutable_box_minimum());
      Put(Eigen::Vector3d(box.max()), info->mutable_box_maximum());
    }
  }
  if (const auto drawn = scene.drawn.find(object.id); drawn != scene.drawn.end()) {
    info->set_drawer(drawn->second.drawer);
    info->set_left_out(drawn->second.leftOut);
  }
  if (const auto stars = scene.stars.find(object.id); stars != scene.stars.end()) {
    const StarLook& look = stars->second->Look();
    info->mutable_stars()->set_gain(look.gain);
    info->mutable_stars()->set_spread(look.spread);
    info->mutable_stars()->set_faintest(look.faintest);
  }
  if (object.custom && !object.custom->IsBackdrop()) {
    const BoundingSphere bounds = object.custom->Bounds();
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(bounds.radius);
    Put(bounds.center, info->mutable_bounds_center());
    info->set_bounds_radius(bounds.radius);
    Put(bounds.center - reach, info->mutable_box_minimum());
    Put(bounds.center + reach, info->mutable_box_maximum());
  }
}

void FindObject(const Context& context, v1::FindObject& command) {
  const ObjectId id = context.GetScene().FindObject(command.name());
  if (id == 0) {
    throw Error(Error::Kind::NotFound, "object '" + command.name() + "'",
                "there is no such object in scene '" + context.sceneName + "'");
  }
  context.reply.mutable_object()->set_object(id);
  context.reply.mutable_object()->set_name(command.name());
}

void DescribeObject(const Context& context, v1::DescribeObject& command) {
  Describe(context.GetScene().Object(command.object()), *context.scene,
           context.reply.mutable_object_info());
}

void ListObjects(const Context& context, v1::ListObjects&) {
  v1::ObjectList* list = context.reply.mutable_objects();
  for (const auto& [id, object] : context.GetScene().Objects()) {
    Describe(object, *context.scene, list->add_object());
  }
}

} // namespace

void AddObjectRequests(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kFindObject, &C::mutable_find_object, FindObject);
  registry.Add(C::kDescribeObject, &C::mutable_describe_object, DescribeObject);
  registry.Add(C::kListObjects, &C::mutable_list_objects, ListObjects);
}

} // namespace dspace::session
