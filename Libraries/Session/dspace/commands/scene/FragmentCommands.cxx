// Fragments and lights.
#include <algorithm>
#include <set>

#include <dspace/Checks.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/messages/Convert.h>

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
    for (const std::string& member : context.GetScene().MembersOf(name)) {
      info->add_member(member);
    }
  }
}

void SetLight(const Context& context, v1::SetLight& command) {
  context.GetScene().SetLight(ToLight(command));
}

// Scenes once had this light from the start, and snapshots of that time remove it.
constexpr const char* FormerLight = "sky";

void RemoveLight(const Context& context, v1::RemoveLight& command) {
  const std::vector<Light>& lights = context.GetScene().Fragments().Lights();
  if (command.name() == FormerLight &&
      std::none_of(lights.begin(), lights.end(),
                   [](const Light& light) { return light.name == FormerLight; })) {
    context.reply.add_warning("light 'sky': new scenes have no such light; a viewport's fill light "
                              "is in its place, and nothing is removed");
    return;
  }
  context.GetScene().RemoveLight(command.name());
  if (command.name() == SunName) {
    context.scene->sky.sun.reset(); // else the next time would create the light again
  }
}

void ListLights(const Context& context, v1::ListLights&) {
  v1::LightList* list = context.reply.mutable_lights();
  for (const Light& light : context.GetScene().Fragments().Lights()) {
    Put(light, list->add_light());
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
