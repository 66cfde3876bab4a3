#include <dspace/import/worker/ModelBytes.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <dspace/import/files/ImageReader.h>

namespace dspace {
namespace {

using Images = std::vector<std::shared_ptr<const Image>>;

// The least bytes that a record takes, for ByteReader::Count: those of its numbers and counts.
constexpr std::size_t LeastText = 8;
constexpr std::size_t LeastImage = 28;
constexpr std::size_t LeastMaterial = 80;
constexpr std::size_t LeastMesh = 54;
constexpr std::size_t LeastNode = 149;
constexpr std::size_t LeastLight = 53;
constexpr std::size_t LeastChannel = 22;
constexpr std::size_t LeastAnimation = 16;

class ImageTable {
public:
  explicit ImageTable(const std::vector<const Material*>& materials) {
    for (const Material* material : materials) {
      this->Add(material->texture.get());
      this->Add(material->normalTexture.get());
    }
  }
  const std::vector<const Image*>& All() const { return this->All_; }
  std::int32_t Index(const std::shared_ptr<const Image>& image) const {
    return image ? this->Index_.at(image.get()) : -1;
  }

private:
  void Add(const Image* image) {
    if (image && this->Index_.emplace(image, static_cast<std::int32_t>(this->All_.size())).second) {
      this->All_.push_back(image);
    }
  }
  std::vector<const Image*> All_;
  std::map<const Image*, std::int32_t> Index_;
};

void WriteTexts(const std::vector<std::string>& texts, ByteWriter& into) {
  into.Number<std::uint64_t>(texts.size());
  for (const std::string& text : texts) {
    into.Text(text);
  }
}

template<typename E> void WriteEnumerator(E value, ByteWriter& into) {
  into.Number(static_cast<std::uint8_t>(value));
}

template<typename Numbers> void WriteNumbers(const Numbers& numbers, ByteWriter& into) {
  for (const double number : numbers) {
    into.Number(number);
  }
}

void WriteMaterial(const Material& material, const ImageTable& images, ByteWriter& into) {
  into.Text(material.name);
  WriteNumbers(material.color, into);
  into.Number(material.opacity);
  into.Number(material.metallic);
  into.Number(material.roughness);
  WriteNumbers(material.emissive, into);
  into.Number(images.Index(material.texture));
  into.Number(images.Index(material.normalTexture));
  into.Number(material.normalScale);
  into.Number<std::uint8_t>(material.repeatTexture);
  into.Number<std::uint8_t>(material.lit);
  into.Number<std::uint8_t>(material.doubleSided);
}

void WriteMesh(const Mesh& mesh, ByteWriter& into) {
  into.Text(mesh.name);
  WriteEnumerator(mesh.primitive, into);
  into.Array(mesh.positions);
  into.Array(mesh.normals);
  into.Array(mesh.tcoords);
  into.Array(mesh.colors);
  into.Array(mesh.indices);
  into.Number<std::int32_t>(mesh.material);
  into.Number<std::uint8_t>(mesh.solid);
}

void WriteNode(const ModelNode& node, ByteWriter& into) {
  into.Text(node.name);
  into.Number<std::int32_t>(node.parent);
  const Eigen::Matrix4d local = node.local.matrix();
  WriteNumbers(std::vector<double>(local.data(), local.data() + local.size()), into);
  into.Array(std::vector<std::int32_t>(node.meshes.begin(), node.meshes.end()));
  into.Number<std::uint8_t>(node.range.has_value());
  if (node.range) {
    WriteNumbers(node.range->center, into);
    into.Number(node.range->from);
    into.Number(node.range->to);
  }
}

void WriteLight(const ModelLight& light, ByteWriter& into) {
  into.Text(light.name);
  WriteEnumerator(light.kind, into);
  into.Number<std::int32_t>(light.node);
  WriteNumbers(light.color, into);
  into.Number(light.intensity);
  into.Number(light.cone_deg);
}

void WriteAnimation(const ModelAnimation& animation, ByteWriter& into) {
  into.Text(animation.name);
  into.Number<std::uint64_t>(animation.channels.size());
  for (const ModelChannel& channel : animation.channels) {
    into.Number<std::int32_t>(channel.node);
    WriteEnumerator(channel.property, into);
    WriteEnumerator(channel.interpolation, into);
    into.Array(channel.time_s);
    into.Array(channel.value);
  }
}

std::vector<std::string> ReadTexts(ByteReader& from) {
  std::vector<std::string> texts(from.Count(LeastText));
  for (std::string& text : texts) {
    text = from.Text();
  }
  return texts;
}

void ReadNumbers(ByteReader& from, double* numbers, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    numbers[i] = from.Number<double>();
  }
}

std::shared_ptr<const Image> ReadIndexed(ByteReader& from, const Images& images) {
  const auto index = from.Number<std::int32_t>();
  if (index < -1 || index >= static_cast<std::int64_t>(images.size())) {
    from.Fail("a material names an image that is not there");
  }
  return index < 0 ? nullptr : images[static_cast<std::size_t>(index)];
}

Material ReadMaterial(ByteReader& from, const Images& images) {
  Material material;
  material.name = from.Text();
  ReadNumbers(from, material.color.data(), 3);
  material.opacity = from.Number<double>();
  material.metallic = from.Number<double>();
  material.roughness = from.Number<double>();
  ReadNumbers(from, material.emissive.data(), 3);
  material.texture = ReadIndexed(from, images);
  material.normalTexture = ReadIndexed(from, images);
  material.normalScale = from.Number<double>();
  if (!std::isfinite(material.normalScale)) {
    from.Fail("a material's scale of normals is not finite");
  }
  material.repeatTexture = from.Flag();
  material.lit = from.Flag();
  material.doubleSided = from.Flag();
  return material;
}

Mesh ReadMesh(ByteReader& from) {
  Mesh mesh;
  mesh.name = from.Text();
  mesh.primitive = from.Enumerator(Mesh::Primitive::Points);
  mesh.positions = from.Array<float>();
  mesh.normals = from.Array<float>();
  mesh.tcoords = from.Array<float>();
  mesh.colors = from.Array<std::uint8_t>();
  mesh.indices = from.Array<std::uint32_t>();
  mesh.material = from.Number<std::int32_t>();
  mesh.solid = from.Flag();
  return mesh;
}

ModelNode ReadNode(ByteReader& from) {
  ModelNode node;
  node.name = from.Text();
  node.parent = from.Number<std::int32_t>();
  Eigen::Matrix4d local;
  ReadNumbers(from, local.data(), static_cast<std::size_t>(local.size()));
  if (local.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    from.Fail("a node's transform is not affine");
  }
  node.local.matrix() = local;
  const auto meshes = from.Array<std::int32_t>();
  node.meshes.assign(meshes.begin(), meshes.end());
  if (from.Flag()) {
    DistanceRange range;
    ReadNumbers(from, range.center.data(), 3);
    range.from = from.Number<double>();
    range.to = from.Number<double>();
    node.range = range;
  }
  return node;
}

void RequireNode(const ByteReader& from, int node, const Model& model) {
  if (node < 0 || node >= static_cast<std::int64_t>(model.nodes.size())) {
    from.Fail("a light or a channel names a node that is not there");
  }
}

ModelLight ReadLight(ByteReader& from, const Model& model) {
  ModelLight light;
  light.name = from.Text();
  light.kind = from.Enumerator(ModelLight::Kind::Spot);
  light.node = from.Number<std::int32_t>();
  RequireNode(from, light.node, model);
  ReadNumbers(from, light.color.data(), 3);
  light.intensity = from.Number<double>();
  light.cone_deg = from.Number<double>();
  if (!std::all_of(light.color.begin(), light.color.end(),
                   [](double each) { return std::isfinite(each); }) ||
      !std::isfinite(light.intensity) || !std::isfinite(light.cone_deg)) {
    from.Fail("a number of a light is not finite");
  }
  return light;
}

ModelChannel ReadChannel(ByteReader& from, const Model& model) {
  ModelChannel channel;
  channel.node = from.Number<std::int32_t>();
  RequireNode(from, channel.node, model);
  channel.property = from.Enumerator(ModelChannel::Property::Scale);
  channel.interpolation = from.Enumerator(ModelChannel::Interpolation::CubicSpline);
  channel.time_s = from.Array<double>();
  channel.value = from.Array<double>();
  const std::size_t numbers = channel.property == ModelChannel::Property::Rotation ? 4 : 3;
  const std::size_t each =
      channel.interpolation == ModelChannel::Interpolation::CubicSpline ? 3 : 1;
  const auto finite = [](double number) { return std::isfinite(number); };
  if (channel.time_s.empty() || channel.value.size() != channel.time_s.size() * numbers * each ||
      !std::all_of(channel.time_s.begin(), channel.time_s.end(), finite) ||
      !std::all_of(channel.value.begin(), channel.value.end(), finite) ||
      !std::is_sorted(channel.time_s.begin(), channel.time_s.end())) {
    from.Fail("the keys of a channel are not ascending, not finite or too few");
  }
  return channel;
}

ModelAnimation ReadAnimation(ByteReader& from, const Model& model) {
  ModelAnimation animation;
  animation.name = from.Text();
  animation.channels.resize(from.Count(LeastChannel));
  for (ModelChannel& channel : animation.channels) {
    channel = ReadChannel(from, model);
  }
  return animation;
}

} // namespace

void WriteImage(const Image& image, ByteWriter& into) {
  into.Text(image.name);
  into.Number<std::int32_t>(image.width);
  into.Number<std::int32_t>(image.height);
  into.Number<std::int32_t>(image.channels);
  into.Array(image.pixels);
}

std::shared_ptr<const Image> ReadImageBytes(ByteReader& from) {
  auto image = std::make_shared<Image>();
  image->name = from.Text();
  image->width = from.Number<std::int32_t>();
  image->height = from.Number<std::int32_t>();
  image->channels = from.Number<std::int32_t>();
  image->pixels = from.Array<std::uint8_t>();
  const auto side = [](int pixels) { return pixels >= 1 && pixels <= MaximumImageSide; };
  if (!side(image->width) || !side(image->height) || image->channels < 1 || image->channels > 4 ||
      image->pixels.size() !=
          std::size_t(image->width) * std::size_t(image->height) * std::size_t(image->channels)) {
    from.Fail("the pixels of an image do not fit its size");
  }
  return image;
}

void WriteMaterials(const std::vector<const Material*>& materials, ByteWriter& into) {
  const ImageTable images(materials);
  into.Number<std::uint64_t>(images.All().size());
  for (const Image* image : images.All()) {
    WriteImage(*image, into);
  }
  into.Number<std::uint64_t>(materials.size());
  for (const Material* material : materials) {
    WriteMaterial(*material, images, into);
  }
}

std::vector<Material> ReadMaterialBytes(ByteReader& from) {
  Images images(from.Count(LeastImage));
  for (std::shared_ptr<const Image>& image : images) {
    image = ReadImageBytes(from);
  }
  std::vector<Material> materials(from.Count(LeastMaterial));
  for (Material& material : materials) {
    material = ReadMaterial(from, images);
  }
  return materials;
}

void WriteModel(const Model& model, ByteWriter& into) {
  std::vector<const Material*> materials;
  for (const Material& material : model.materials) {
    materials.push_back(&material);
  }
  WriteMaterials(materials, into);
  into.Number<std::uint64_t>(model.meshes.size());
  for (const Mesh& mesh : model.meshes) {
    WriteMesh(mesh, into);
  }
  into.Number<std::uint64_t>(model.nodes.size());
  for (const ModelNode& node : model.nodes) {
    WriteNode(node, into);
  }
  into.Number<std::uint64_t>(model.lights.size());
  for (const ModelLight& light : model.lights) {
    WriteLight(light, into);
  }
  into.Number<std::uint64_t>(model.animations.size());
  for (const ModelAnimation& animation : model.animations) {
    WriteAnimation(animation, into);
  }
  WriteTexts(model.warnings, into);
  WriteTexts(model.leftOut, into);
}

Model ReadModelBytes(ByteReader& from, const std::string& path) {
  Model model;
  model.path = path;
  model.materials = ReadMaterialBytes(from);
  model.meshes.resize(from.Count(LeastMesh));
  for (Mesh& mesh : model.meshes) {
    mesh = ReadMesh(from);
  }
  model.nodes.resize(from.Count(LeastNode));
  for (ModelNode& node : model.nodes) {
    node = ReadNode(from);
  }
  model.lights.resize(from.Count(LeastLight));
  for (ModelLight& light : model.lights) {
    light = ReadLight(from, model);
  }
  model.animations.resize(from.Count(LeastAnimation));
  for (ModelAnimation& animation : model.animations) {
    animation = ReadAnimation(from, model);
  }
  model.warnings = ReadTexts(from);
  model.leftOut = ReadTexts(from);
  CheckModel(model);
  return model;
}

} // namespace dspace
