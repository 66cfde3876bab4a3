// Letters and labels in the scene.
#include <algorithm>

#include <dspace/Checks.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/messages/Convert.h>
#include <dspace/render/text/TextShapes.h>

namespace dspace::session {
namespace {

LabelStyle ToStyle(const v1::CreateText::Label& from) {
  LabelStyle to;
  if (from.has_font_size()) {
    to.fontSize = int(std::min<std::uint32_t>(from.font_size(), 0x7fffffffu));
  }
  if (from.has_color()) {
    to.color = ToColor(from.color(), "label");
  }
  if (from.has_background()) {
    to.background = ToColor(from.background(), "label");
  }
  if (from.has_background_opacity()) {
    to.backgroundOpacity = from.background_opacity();
    RequireFraction("label", "the background's opacity", to.backgroundOpacity);
  }
  const auto offset = [](bool given, double value, double& out) {
    if (given) {
      Require(std::abs(value) <= 10000, "label", "the offset", value, "-10000 to 10000 pixels");
      out = value;
    }
  };
  offset(from.has_offset_x(), from.offset_x(), to.offset[0]);
  offset(from.has_offset_y(), from.offset_y(), to.offset[1]);
  return to;
}

std::vector<DetailLevel> LevelsOf(const v1::CreateText& command) {
  Part part;
  if (command.has_solid()) {
    part.mesh =
        std::make_shared<const Mesh>(MakeTextMesh(command.text(), command.solid().height()));
  } else {
    part = MakeLabel(command.text(), ToStyle(command.label()));
  }
  std::vector<DetailLevel> levels(1);
  levels[0].parts.push_back(std::move(part));
  return levels;
}

void CreateText(const Context& context, v1::CreateText& command) {
  const ObjectId id = AddObject(context, *command.mutable_object(), "text", LevelsOf(command),
                                !command.has_solid());
  context.scene->texts[id] = command;
}

void SetText(const Context& context, v1::SetText& command) {
  Scene& scene = context.GetScene();
  scene.Object(command.object()); // throws where there is none
  const auto found = context.scene->texts.find(command.object());
  if (found == context.scene->texts.end()) {
    Reject(ObjectLabel(scene, command.object()), "it is no text");
  }
  v1::CreateText next = found->second;
  next.set_text(command.text());
  scene.SetObjectLevels(command.object(), LevelsOf(next));
  found->second = std::move(next);
}

} // namespace

void AddTextCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreateText, &C::mutable_create_text, CreateText);
  registry.Add(C::kSetText, &C::mutable_set_text, SetText);
}

} // namespace dspace::session
