#include <dspace/commands/objects/ObjectTools.h>

#include <dspace/messages/Convert.h>
#include <dspace/scene/Checks.h>

namespace dspace::session {

std::string ObjectLabel(const Scene& scene, ObjectId id) {
  const auto found = scene.Objects().find(id);
  return found == scene.Objects().end() ? "object " + std::to_string(id)
                                        : "object '" + found->second.name + "'";
}

std::string FreeObjectName(const Scene& scene, const std::string& wanted) {
  std::string name = wanted;
  for (int n = 2; scene.FindObject(name) != 0; ++n) {
    name = wanted + " " + std::to_string(n);
  }
  return name;
}

MaterialOverride ApplyMaterial(v1::Material& material, const MaterialOverride& base, State& state,
                               const std::string& object) {
  MaterialOverride made = base;
  if (material.has_color()) {
    made.color = ToColor(material.color(), object);
  }
  const auto fraction = [&object](const char* what, double value) {
    RequireFraction(object, what, value);
    return value;
  };
  if (material.has_opacity()) {
    made.opacity = fraction("the opacity", material.opacity());
  }
  if (material.has_metallic()) {
    made.metallic = fraction("metallic", material.metallic());
  }
  if (material.has_roughness()) {
    made.roughness = fraction("the roughness", material.roughness());
  }
  if (material.has_lit()) {
    made.lit = material.lit();
  }
  if (material.has_wireframe()) {
    made.wireframe = material.wireframe();
  }
  if (material.has_texture()) {
    material.set_texture(AbsolutePath(material.texture()));
    made.texture =
        material.texture().empty() ? nullptr : state.models.LoadImage(material.texture());
  }
  return made;
}

void PutMaterial(const MaterialOverride& from, v1::Material* to) {
  if (from.color) {
    Put(*from.color, to->mutable_color());
  }
  if (from.opacity) {
    to->set_opacity(*from.opacity);
  }
  if (from.metallic) {
    to->set_metallic(*from.metallic);
  }
  if (from.roughness) {
    to->set_roughness(*from.roughness);
  }
  if (from.lit) {
    to->set_lit(*from.lit);
  }
  if (from.wireframe) {
    to->set_wireframe(*from.wireframe);
  }
  if (from.texture) {
    to->set_texture(*from.texture ? (*from.texture)->name : "");
  }
}

ObjectId AddObject(const Context& context, v1::ObjectSettings& settings, const std::string& what,
                   std::vector<DetailLevel> levels, bool billboard) {
  Scene& scene = context.GetScene();
  GraphicsObject object;
  object.id = settings.id();
  object.name = settings.name().empty() ? FreeObjectName(scene, what) : settings.name();
  const std::string label = "object '" + object.name + "'";
  object.frame = ToFrame(settings.frame());
  object.nature = ToNature(settings.nature(), label);
  object.fragment = settings.fragment();
  object.X_FO = ToAffine(settings.offset(), label);
  object.levels = std::move(levels);
  object.material = ApplyMaterial(*settings.mutable_material(), {}, context.state, label);
  object.visible = !settings.hidden();
  object.pickable = !settings.unpickable();
  object.billboard = billboard;
  if (settings.has_line_width()) {
    object.lineWidth = settings.line_width();
    Require(object.lineWidth > 0 && object.lineWidth <= 100, label, "the line width",
            object.lineWidth, "above 0, up to 100 pixels");
  }
  if (settings.has_point_size()) {
    object.pointSize = settings.point_size();
    Require(object.pointSize > 0 && object.pointSize <= 1000, label, "the point size",
            object.pointSize, "above 0, up to 1000 pixels");
  }
  const std::string name = object.name;
  const ObjectId id = scene.AddObject(std::move(object));
  settings.set_id(id);
  settings.set_name(name);
  context.reply.mutable_object()->set_object(id);
  context.reply.mutable_object()->set_name(name);
  return id;
}

} // namespace dspace::session
