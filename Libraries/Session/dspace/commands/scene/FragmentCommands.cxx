// Fragments and lights.
#include <set>

#include <dspace/interpreter/Registry.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/Checks.h>

namespace dspace::session {
namespace {

void CreateFragment(const Context& context, v1::CreateFragment& command) {
  context.GetScene().CreateFragment(
      command.name(), ToNature(command.nature(), "fragment '" + command.name() + "'"));
}

void RemoveFragment(const Context& context, v1::RemoveFragment& command) {
  context.GetScene().RemoveFragment(command.name());
}

void SetFragmentVisible(const Context& context, v1::SetFragmentVisible& command) {
  context.GetScene().SetFragmentVisible(command.name(), command.visible());
}

void ListFragments(const Context& context, v1::ListFragments&) {
  v1::FragmentList* list = context.reply.mutable_fragments();
  const SceneFragmentManager& fragments = context.GetScene().Fragments();
  for (const std::string& name : fragments.Names()) {
    const SceneFragment& fragment = fragments.Get(name);
    v1::FragmentInfo* info = list->add_fragment();
    info->set_name(name);
    info->set_nature(FromNature(fragment.nature));
    info->set_visible(fragment.visible);
    // A fragment is a set: the order of its objects says nothing, and a snapshot need not restore
    // it.
    std::set<ObjectId> objects(fragment.objects.begin(), fragment.objects.end());
    for (const ObjectId id : objects) {
      info->add_object(id);
    }
  }
}

Light::Kind ToKind(v1::SetLight::Kind kind, const std::string& light) {
  switch (kind) {
  case v1::SetLight::DIRECTIONAL:
    return Light::Kind::Directional;
  case v1::SetLight::POINT:
    return Light::Kind::Point;
  case v1::SetLight::SPOT:
    return Light::Kind::Spot;
  case v1::SetLight::HEAD:
    return Light::Kind::Head;
  case v1::SetLight::AMBIENT:
    return Light::Kind::Ambient;
  default:
    Refuse(light, "its kind is " + std::to_string(int(kind)) + "; accepted: 0 to 4");
  }
}

v1::SetLight::Kind FromLightKind(Light::Kind kind) {
  switch (kind) {
  case Light::Kind::Point:
    return v1::SetLight::POINT;
  case Light::Kind::Spot:
    return v1::SetLight::SPOT;
  case Light::Kind::Head:
    return v1::SetLight::HEAD;
  case Light::Kind::Ambient:
    return v1::SetLight::AMBIENT;
  case Light::Kind::Directional:
    break;
  }
  return v1::SetLight::DIRECTIONAL;
}

void SetLight(const Context& context, v1::SetLight& command) {
  const std::string label = "light '" + command.name() + "'";
  Light light;
  light.name = command.name();
  light.kind = ToKind(command.kind(), label);
  light.frame = ToFrame(command.frame());
  if (command.has_direction()) {
    light.direction = ToVector(command.direction());
  }
  light.position = ToVector(command.position());
  if (command.has_cone_deg()) {
    light.cone_deg = command.cone_deg();
  }
  if (command.has_color()) {
    light.color = ToColor(command.color(), label);
  }
  if (command.has_intensity()) {
    light.intensity = command.intensity();
  }
  if (command.has_attenuation()) {
    const v1::Vector3& a = command.attenuation();
    light.attenuation = {a.x(), a.y(), a.z()};
  }
  light.enabled = !command.disabled();
  context.GetScene().SetLight(light);
}

void RemoveLight(const Context& context, v1::RemoveLight& command) {
  context.GetScene().RemoveLight(command.name());
}

void ListLights(const Context& context, v1::ListLights&) {
  v1::LightList* list = context.reply.mutable_lights();
  for (const Light& light : context.GetScene().Fragments().Lights()) {
    v1::SetLight* out = list->add_light();
    out->set_name(light.name);
    out->set_kind(FromLightKind(light.kind));
    out->set_frame(light.frame);
    Put(light.direction, out->mutable_direction());
    Put(light.position, out->mutable_position());
    out->set_cone_deg(light.cone_deg);
    Put(light.color, out->mutable_color());
    out->set_intensity(light.intensity);
    Put(Eigen::Vector3d(light.attenuation[0], light.attenuation[1], light.attenuation[2]),
        out->mutable_attenuation());
    out->set_disabled(!light.enabled);
  }
}

} // namespace

void AddFragmentCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreateFragment, &C::mutable_create_fragment, CreateFragment);
  registry.Add(C::kRemoveFragment, &C::mutable_remove_fragment, RemoveFragment);
  registry.Add(C::kSetFragmentVisible, &C::mutable_set_fragment_visible, SetFragmentVisible);
  registry.Add(C::kListFragments, &C::mutable_list_fragments, ListFragments);
  registry.Add(C::kSetLight, &C::mutable_set_light, SetLight);
  registry.Add(C::kRemoveLight, &C::mutable_remove_light, RemoveLight);
  registry.Add(C::kListLights, &C::mutable_list_lights, ListLights);
}

} // namespace dspace::session
