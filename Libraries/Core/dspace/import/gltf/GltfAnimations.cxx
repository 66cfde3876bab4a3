#include <dspace/import/gltf/GltfAnimations.h>

#include <algorithm>
#include <cmath>

#include <dspace/import/gltf/GltfAccessor.h>

namespace dspace {

namespace {

constexpr std::size_t MaximumKeys = 10000000; // of a channel

class AnimationReader {
public:
  AnimationReader(const GltfDocument& document, const std::vector<int>& indexOf)
      : Document_(document), IndexOf_(indexOf) {}

  ModelAnimation Read(std::size_t index) {
    const Json::Value& json = this->Document_.Element("animations", index);
    ModelAnimation animation;
    animation.name = json["name"].isString() ? json["name"].asString() : "";
    const std::string label = "animations[" + std::to_string(index) + "]";
    if (!json["channels"].isArray() || !json["samplers"].isArray()) {
      this->Document_.Fail(label + " has no channels and samplers");
    }
    for (Json::ArrayIndex c = 0; c < json["channels"].size(); ++c) {
      this->AddChannel(json, c, label + ".channels[" + std::to_string(c) + "]", animation);
    }
    return animation;
  }

  std::size_t LeftOut = 0; // channels

private:
  void AddChannel(const Json::Value& json, Json::ArrayIndex index, const std::string& where,
                  ModelAnimation& animation) {
    const Json::Value& from = json["channels"][index];
    if (!from.isObject() || !from["target"].isObject()) {
      this->Document_.Fail(where + " has no target");
    }
    const Json::Value& target = from["target"];
    const std::string path = target["path"].isString() ? target["path"].asString() : "";
    ModelChannel channel;
    if (path == "translation") {
      channel.property = ModelChannel::Property::Translation;
    } else if (path == "rotation") {
      channel.property = ModelChannel::Property::Rotation;
    } else if (path == "scale") {
      channel.property = ModelChannel::Property::Scale;
    } else {
      ++this->LeftOut;
      return;
    }
    if (target["node"].isNull()) {
      return; // section 3.11: such a channel is ignored
    }
    channel.node = this->IndexOf_[this->Document_.Index(target, "node", "nodes", where)];
    const std::size_t sampler =
        this->Document_.Count(from, "sampler", json["samplers"].size(), where);
    if (sampler >= json["samplers"].size() ||
        !json["samplers"][Json::ArrayIndex(sampler)].isObject()) {
      this->Document_.Fail(where + ".sampler is " + std::to_string(sampler) + " of " +
                           std::to_string(json["samplers"].size()) + " samplers");
    }
    this->ReadSampler(json["samplers"][Json::ArrayIndex(sampler)], where, channel);
    if (channel.node >= 0) { // else it is of another scene
      animation.channels.push_back(std::move(channel));
    }
  }

  std::vector<double> Values(const Json::Value& sampler, const char* key, std::size_t components,
                             const std::string& where) const {
    const GltfAccessor accessor = CheckGltfAccessor(
        this->Document_, this->Document_.Index(sampler, key, "accessors", where), 3 * MaximumKeys);
    if (accessor.components != components) {
      this->Document_.Fail(where + "." + key + " is of type " + accessor.type);
    }
    const std::vector<float> values =
        GltfAccessorFloats(this->Document_, accessor, components, 0.0f);
    if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) {
      this->Document_.Fail(where + "." + key + " has a value that is not finite");
    }
    return {values.begin(), values.end()};
  }

  void ReadSampler(const Json::Value& json, const std::string& where, ModelChannel& channel) const {
    const std::string word =
        json["interpolation"].isString() ? json["interpolation"].asString() : "LINEAR";
    if (word == "STEP") {
      channel.interpolation = ModelChannel::Interpolation::Step;
    } else if (word == "CUBICSPLINE") {
      channel.interpolation = ModelChannel::Interpolation::CubicSpline;
    } else if (word != "LINEAR") {
      this->Document_.Fail(where + ": its interpolation is '" + word +
                           "'; STEP, LINEAR and CUBICSPLINE are known");
    }
    channel.time_s = this->Values(json, "input", 1, where);
    const std::size_t components = channel.property == ModelChannel::Property::Rotation ? 4 : 3;
    channel.value = this->Values(json, "output", components, where);
    const std::size_t each =
        components * (channel.interpolation == ModelChannel::Interpolation::CubicSpline ? 3 : 1);
    if (channel.value.size() != each * channel.time_s.size()) {
      this->Document_.Fail(where + " has " + std::to_string(channel.value.size() / components) +
                           " values for " + std::to_string(channel.time_s.size()) + " times");
    }
    for (std::size_t i = 1; i < channel.time_s.size(); ++i) {
      if (!(channel.time_s[i] > channel.time_s[i - 1])) {
        this->Document_.Fail(where + ": its times do not ascend at key " + std::to_string(i));
      }
    }
    for (std::size_t i = 0; components == 4 && i < channel.time_s.size(); ++i) {
      const std::size_t at = i * each + (each > 4 ? 4 : 0);
      const double length = Eigen::Map<const Eigen::Vector4d>(&channel.value[at]).norm();
      if (!(length > 1e-6)) {
        this->Document_.Fail(where + ": key " + std::to_string(i) + " is not a rotation");
      }
    }
  }

  const GltfDocument& Document_;
  const std::vector<int>& IndexOf_;
};

} // namespace

std::vector<ModelAnimation> ReadGltfAnimations(const GltfDocument& document,
                                               const std::vector<int>& indexOf,
                                               std::vector<std::string>& leftOut) {
  AnimationReader reader(document, indexOf);
  std::vector<ModelAnimation> animations;
  for (std::size_t i = 0; i < document.Array("animations").size(); ++i) {
    ModelAnimation animation = reader.Read(i);
    if (!animation.channels.empty()) {
      animations.push_back(std::move(animation));
    }
  }
  if (reader.LeftOut > 0) {
    leftOut.push_back(std::to_string(reader.LeftOut) + " channels of animations that move no node");
  }
  return animations;
}

} // namespace dspace
