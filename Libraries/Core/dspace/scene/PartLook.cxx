#include <dspace/scene/PartLook.h>

namespace dspace {

MaterialOverride OverrideOf(const GraphicsObject& object, const Part& part) {
  MaterialOverride made = object.material;
  const auto found = object.parts.find(part.name);
  if (found == object.parts.end()) {
    return made;
  }
  const MaterialOverride& over = found->second.material;
  const auto take = [](auto& to, const auto& from) {
    if (from) {
      to = from;
    }
  };
  take(made.color, over.color);
  take(made.opacity, over.opacity);
  take(made.metallic, over.metallic);
  take(made.roughness, over.roughness);
  take(made.texture, over.texture);
  take(made.lit, over.lit);
  take(made.wireframe, over.wireframe);
  take(made.emissive, over.emissive);
  take(made.reflectance, over.reflectance);
  return made;
}

bool IsPartVisible(const GraphicsObject& object, const Part& part) {
  const auto found = object.parts.find(part.name);
  return found == object.parts.end() || found->second.visible;
}

Material LookOf(const GraphicsObject& object, const Part& part) {
  Material look = part.material ? *part.material : Material();
  const MaterialOverride over = OverrideOf(object, part);
  look.color = over.color.value_or(look.color);
  look.opacity = over.opacity.value_or(look.opacity);
  look.metallic = over.metallic.value_or(look.metallic);
  look.roughness = over.roughness.value_or(look.roughness);
  look.emissive = over.emissive.value_or(look.emissive);
  look.reflectance = over.reflectance.value_or(look.reflectance);
  look.texture = over.texture.value_or(look.texture);
  look.lit = over.lit.value_or(look.lit) && part.mesh->primitive == Mesh::Primitive::Triangles &&
             !object.billboard && !part.mesh->normals.empty();
  if (part.mesh->tcoords.empty()) {
    look.texture = nullptr;
    look.normalTexture = nullptr;
  }
  return look;
}

bool IsTranslucent(const Material& look, const Mesh& mesh) {
  if (look.opacity < 1.0 || (look.texture && look.texture->channels % 2 == 0)) {
    return true;
  }
  for (std::size_t i = 3; i < mesh.colors.size(); i += 4) {
    if (mesh.colors[i] != 255) {
      return true;
    }
  }
  return false;
}

} // namespace dspace
