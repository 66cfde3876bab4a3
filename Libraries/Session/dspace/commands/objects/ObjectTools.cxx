#include <dspace/commands/objects/ObjectTools.h>

#include <dspace/Checks.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {

std::string ObjectLabel(const Scene& scene, ObjectId id) {
  const auto found = scene.Objects().find(id);
  return found == scene.Objects().end() ? "object " + std::to_string(id)
                                        : "object '" + found->second.name + "'";
}

Reflectance ToReflectance(const v1::Reflectance& from, const std::string& object) {
  if (!v1::Reflectance::Model_IsValid(from.model())) {
    Reject(object, "model " + std::to_string(from.model()) +
                       " of its reflectance is unknown; accepted: 0 to " +
                       std::to_string(v1::Reflectance::Model_MAX));
  }
  Reflectance made;
  made.model = static_cast<Reflectance::Model>(from.model());
  if (from.has_lunar_weight()) {
    made.lunarWeight = from.lunar_weight();
  }
  const auto take = [](bool has, double value, double& to) { to = has ? value : to; };
  take(from.has_single_scattering_albedo(), from.single_scattering_albedo(),
       made.singleScatteringAlbedo);
  take(from.has_phase_asymmetry(), from.phase_asymmetry(), made.phaseAsymmetry);
  take(from.has_phase_partition(), from.phase_partition(), made.phasePartition);
  take(from.has_opposition_amplitude(), from.opposition_amplitude(), made.oppositionAmplitude);
  take(from.has_opposition_width(), from.opposition_width(), made.oppositionWidth);
  take(from.has_roughness_deg(), from.roughness_deg(), made.roughness_deg);
  made.Check(object);
  return made;
}

namespace {

// With the parameters that its model has.
void PutReflectance(const Reflectance& from, v1::Reflectance* to) {
  to->set_model(static_cast<v1::Reflectance::Model>(from.model));
  if (from.lunarWeight) {
    to->set_lunar_weight(*from.lunarWeight);
  }
  if (from.model == Reflectance::Model::Hapke) {
    to->set_single_scattering_albedo(from.singleScatteringAlbedo);
    to->set_phase_asymmetry(from.phaseAsymmetry);
    to->set_phase_partition(from.phasePartition);
    to->set_opposition_amplitude(from.oppositionAmplitude);
    to->set_opposition_width(from.oppositionWidth);
    to->set_roughness_deg(from.roughness_deg);
  }
}

} // namespace

MaterialOverride ApplyMaterial(v1::Material& material, const MaterialOverride& base, State& state,
                               const std::string& object) {
  MaterialOverride made = base;
  if (material.has_color()) {
    made.color = ToColor(material.color(), object);
  }
  if (material.has_emissive()) {
    made.emissive = ToColor(material.emissive(), object);
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
  if (material.has_reflectance()) {
    made.reflectance = ToReflectance(material.reflectance(), object);
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
  if (from.emissive) {
    Put(*from.emissive, to->mutable_emissive());
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
  if (from.reflectance) {
    PutReflectance(*from.reflectance, to->mutable_reflectance());
  }
  if (from.texture) {
    to->set_texture(*from.texture ? (*from.texture)->name : "");
  }
}

ObjectId AddObject(const Context& context, v1::ObjectSettings& settings, const std::string& what,
                   std::vector<DetailLevel> levels, bool billboard,
                   std::shared_ptr<const CustomGeometry> custom) {
  Scene& scene = context.GetScene();
  GraphicsObject object;
  object.id = settings.id();
  object.name = settings.name().empty() ? scene.FreeObjectName(what) : settings.name();
  const std::string label = "object '" + object.name + "'";
  object.frame = ToFrame(settings.frame());
  object.nature = ToNature(settings.nature(), label);
  object.fragment = settings.fragment();
  object.X_FO = ToAffine(settings.offset(), label);
  object.levels = std::move(levels);
  object.custom = std::move(custom);
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
