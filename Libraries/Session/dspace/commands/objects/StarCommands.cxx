// Stars.
#include <cstring>
#include <limits>

#include <dspace/Checks.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/scene/stars/StarField.h>

namespace dspace::session {
namespace {

std::vector<float> FloatsOf(const std::string& bytes, std::size_t count, const std::string& object,
                            const char* what) {
  if (bytes.size() != 4 * count) {
    Reject(object, std::string(what) + " has " + std::to_string(bytes.size()) +
                       " bytes; accepted: " + std::to_string(4 * count) + ", float32 for " +
                       std::to_string(count) + " numbers");
  }
  std::vector<float> numbers(count);
  if (count > 0) { // little-endian, as the machine
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
  }
  return numbers;
}

StarLook LookOf(const v1::StarLook& from, StarLook look) {
  look.gain = from.has_gain() ? from.gain() : look.gain;
  look.spread = from.has_spread() ? from.spread() : look.spread;
  look.faintest = from.has_faintest() ? from.faintest() : look.faintest;
  return look;
}

void CreateStars(const Context& context, v1::CreateStars& command) {
  v1::ObjectSettings& settings = *command.mutable_object();
  const std::string name =
      settings.name().empty() ? context.GetScene().FreeObjectName("stars") : settings.name();
  const std::string label = "object '" + name + "'";
  if (settings.material().ByteSizeLong() > 0 || settings.has_line_width() ||
      settings.has_point_size()) {
    Reject(label, "a material, line width or point size is given; accepted for stars: none, since "
                  "each star has its own light");
  }
  const std::size_t count = command.magnitude().size() / 4;
  const std::vector<float> magnitudes = FloatsOf(command.magnitude(), count, label, "magnitude");
  const std::vector<float> directions =
      FloatsOf(command.direction(), 3 * count, label, "direction");
  const std::vector<float> colors =
      command.color_index().empty()
          ? std::vector<float>(count, std::numeric_limits<float>::quiet_NaN())
          : FloatsOf(command.color_index(), count, label, "color_index");
  std::vector<Star> stars(count);
  for (std::size_t i = 0; i < count; ++i) {
    stars[i] = {Eigen::Vector3f(directions.data() + 3 * i), magnitudes[i], colors[i]};
  }
  const auto field = std::make_shared<StarField>(label, std::move(stars));
  field->SetLook(label, LookOf(command.look(), {}));
  const ObjectId id = AddObject(context, settings, name, {}, false, field);
  context.scene->stars[id] = field;
}

// With all fields, so that the last command is enough.
void PutLook(const StarLook& from, v1::StarLook* to) {
  to->set_gain(from.gain);
  to->set_spread(from.spread);
  to->set_faintest(from.faintest);
}

void SetStars(const Context& context, v1::SetStars& command) {
  context.GetScene().Object(command.object()); // throws where there is none
  const std::string label = ObjectLabel(context.GetScene(), command.object());
  const auto found = context.scene->stars.find(command.object());
  if (found == context.scene->stars.end()) {
    Reject(label, "it is not stars");
  }
  StarField& field = *found->second;
  field.SetLook(label, LookOf(command.look(), field.Look()));
  PutLook(field.Look(), command.mutable_look());
}

} // namespace

void AddStarCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreateStars, &C::mutable_create_stars, CreateStars);
  registry.Add(C::kSetStars, &C::mutable_set_stars, SetStars);
}

} // namespace dspace::session
