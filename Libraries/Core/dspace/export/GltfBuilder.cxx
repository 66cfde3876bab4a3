#include <dspace/export/GltfBuilder.h>

#include <algorithm>
#include <sstream>

#include <dspace/Error.h>
#include <dspace/import/files/PngBytes.h>
#include <dspace/scene/LinearLight.h>
#include <dspace/scene/PartLook.h>

namespace dspace {
namespace {

int TypeOf(int components) {
  switch (components) {
  case 1:
    return TINYGLTF_TYPE_SCALAR;
  case 2:
    return TINYGLTF_TYPE_VEC2;
  case 3:
    return TINYGLTF_TYPE_VEC3;
  default:
    return TINYGLTF_TYPE_VEC4;
  }
}

std::vector<double> Doubles(const std::array<float, 3>& values) {
  return {values[0], values[1], values[2]};
}

} // namespace

GltfBuilder::GltfBuilder() {
  this->File_.asset.version = "2.0";
  this->File_.asset.generator = "Dspace";
}

int GltfBuilder::View(const void* data, std::size_t bytes, int target) {
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = this->Data_.size();
  view.byteLength = bytes;
  view.target = target;
  const auto* first = static_cast<const unsigned char*>(data);
  this->Data_.insert(this->Data_.end(), first, first + bytes);
  this->Data_.resize((this->Data_.size() + 3) / 4 * 4); // accessors begin at multiples of 4
  this->File_.bufferViews.push_back(view);
  return int(this->File_.bufferViews.size()) - 1;
}

int GltfBuilder::Accessor(int view, int componentType, int type, std::size_t count) {
  tinygltf::Accessor accessor;
  accessor.bufferView = view;
  accessor.componentType = componentType;
  accessor.type = type;
  accessor.count = count;
  this->File_.accessors.push_back(accessor);
  return int(this->File_.accessors.size()) - 1;
}

int GltfBuilder::Floats(const std::vector<float>& values, int components, bool withBounds,
                        int target) {
  const int index = this->Accessor(this->View(values.data(), values.size() * sizeof(float), target),
                                   TINYGLTF_COMPONENT_TYPE_FLOAT, TypeOf(components),
                                   values.size() / std::size_t(components));
  if (withBounds) {
    auto& accessor = this->File_.accessors.back();
    accessor.minValues.assign(values.begin(), values.begin() + components);
    accessor.maxValues = accessor.minValues;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t k = i % std::size_t(components);
      accessor.minValues[k] = std::min<double>(accessor.minValues[k], values[i]);
      accessor.maxValues[k] = std::max<double>(accessor.maxValues[k], values[i]);
    }
  }
  return index;
}

const GltfBuilder::Arrays& GltfBuilder::ArraysOf(const std::shared_ptr<const Mesh>& mesh) {
  Arrays& arrays = this->Arrays_[mesh.get()];
  if (arrays.mesh) {
    return arrays;
  }
  arrays.mesh = mesh;
  arrays.position = this->Floats(mesh->positions, 3, true, TINYGLTF_TARGET_ARRAY_BUFFER);
  if (!mesh->normals.empty()) {
    arrays.normal = this->Floats(mesh->normals, 3, false, TINYGLTF_TARGET_ARRAY_BUFFER);
  }
  if (!mesh->tcoords.empty()) {
    std::vector<float> tcoords = mesh->tcoords;
    for (std::size_t i = 1; i < tcoords.size(); i += 2) {
      tcoords[i] = 1.0f - tcoords[i]; // glTF's images begin at the top
    }
    arrays.tcoord = this->Floats(tcoords, 2, false, TINYGLTF_TARGET_ARRAY_BUFFER);
  }
  if (!mesh->colors.empty()) {
    std::vector<float> colors(mesh->colors.size());
    for (std::size_t i = 0; i < colors.size(); ++i) {
      const double value = mesh->colors[i] / 255.0;
      colors[i] = i % 4 == 3 ? float(value) : LinearFromSrgb(value);
    }
    arrays.color = this->Floats(colors, 4, false, TINYGLTF_TARGET_ARRAY_BUFFER);
  }
  arrays.index = this->Accessor(
      this->View(mesh->indices.data(), mesh->indices.size() * sizeof(std::uint32_t),
                 TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER),
      TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, mesh->indices.size());
  return arrays;
}

int GltfBuilder::ImageOf(const std::shared_ptr<const Image>& image) {
  // Files of several models may refer to one image, which each of them has read.
  const auto found =
      std::find_if(this->Images_.begin(), this->Images_.end(), [&](const auto& other) {
        return other == image ||
               (other->width == image->width && other->height == image->height &&
                other->channels == image->channels && other->pixels == image->pixels);
      });
  if (found != this->Images_.end()) {
    return int(found - this->Images_.begin());
  }
  const std::vector<std::uint8_t> png = PngBytes(*image);
  tinygltf::Image file;
  file.mimeType = "image/png";
  file.bufferView = this->View(png.data(), png.size(), 0);
  this->File_.images.push_back(file);
  this->Images_.push_back(image);
  return int(this->Images_.size()) - 1;
}

int GltfBuilder::TextureOf(const std::shared_ptr<const Image>& image, bool repeat) {
  const auto found = this->Textures_.emplace(std::make_pair(image.get(), repeat),
                                             int(this->File_.textures.size()));
  if (!found.second) {
    return found.first->second;
  }
  tinygltf::Sampler sampler;
  sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
  sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
  sampler.wrapS = repeat ? TINYGLTF_TEXTURE_WRAP_REPEAT : TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
  sampler.wrapT = sampler.wrapS;
  tinygltf::Texture texture;
  texture.sampler = int(this->File_.samplers.size());
  texture.source = this->ImageOf(image);
  this->File_.samplers.push_back(sampler);
  this->File_.textures.push_back(texture);
  return found.first->second;
}

int GltfBuilder::MaterialOf(const Material& look, const Mesh& mesh) {
  const bool translucent = IsTranslucent(look, mesh);
  std::ostringstream key;
  key.precision(17);
  key << look.name.size() << ' ' << look.name;
  for (const double value :
       {look.color[0], look.color[1], look.color[2], look.opacity, look.metallic, look.roughness,
        look.emissive[0], look.emissive[1], look.emissive[2], look.normalScale}) {
    key << ' ' << value;
  }
  key << ' ' << look.texture.get() << ' ' << look.normalTexture.get() << ' ' << look.repeatTexture
      << look.lit << translucent;
  const auto found = this->Materials_.emplace(key.str(), int(this->File_.materials.size()));
  if (!found.second) {
    return found.first->second;
  }
  tinygltf::Material material;
  material.name = look.name;
  material.doubleSided = true; // as Dspace draws it
  material.alphaMode = translucent ? "BLEND" : "OPAQUE";
  auto& pbr = material.pbrMetallicRoughness;
  pbr.baseColorFactor = Doubles(LinearColor(look.color));
  pbr.baseColorFactor.push_back(look.opacity);
  pbr.metallicFactor = look.metallic;
  pbr.roughnessFactor = look.roughness;
  if (look.texture) {
    pbr.baseColorTexture.index = this->TextureOf(look.texture, look.repeatTexture);
  }
  if (look.lit && look.normalTexture && look.normalTexture->channels != 4) { // of tangent space
    material.normalTexture.index = this->TextureOf(look.normalTexture, look.repeatTexture);
    material.normalTexture.scale = look.normalScale;
  }
  material.emissiveFactor = Doubles(LinearColor(look.emissive));
  if (!look.lit) {
    material.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
    auto& used = this->File_.extensionsUsed;
    if (std::find(used.begin(), used.end(), "KHR_materials_unlit") == used.end()) {
      used.push_back("KHR_materials_unlit");
    }
    // An unlit surface shows its base colour alone.
    for (std::size_t k = 0; k < 3; ++k) {
      pbr.baseColorFactor[k] = std::min(1.0, pbr.baseColorFactor[k] + material.emissiveFactor[k]);
    }
    material.emissiveFactor = {0.0, 0.0, 0.0};
  }
  this->File_.materials.push_back(material);
  return found.first->second;
}

int GltfBuilder::MeshOf(const std::shared_ptr<const Mesh>& mesh, const Material& look) {
  const int material = this->MaterialOf(look, *mesh);
  const auto found =
      this->Meshes_.emplace(std::make_pair(mesh.get(), material), int(this->File_.meshes.size()));
  if (!found.second) {
    return found.first->second;
  }
  const Arrays& arrays = this->ArraysOf(mesh);
  tinygltf::Primitive primitive;
  const auto attribute = [&primitive](const char* name, int accessor) {
    if (accessor >= 0) {
      primitive.attributes[name] = accessor;
    }
  };
  attribute("POSITION", arrays.position);
  attribute("NORMAL", arrays.normal);
  attribute("TEXCOORD_0", arrays.tcoord);
  attribute("COLOR_0", arrays.color);
  primitive.indices = arrays.index;
  primitive.material = material;
  primitive.mode = mesh->primitive == Mesh::Primitive::Triangles ? TINYGLTF_MODE_TRIANGLES
                   : mesh->primitive == Mesh::Primitive::Lines   ? TINYGLTF_MODE_LINE
                                                                 : TINYGLTF_MODE_POINTS;
  tinygltf::Mesh file;
  file.name = mesh->name;
  file.primitives.push_back(std::move(primitive));
  this->File_.meshes.push_back(std::move(file));
  return found.first->second;
}

std::string GltfBuilder::Bytes(const std::string& object) {
  if (!this->Data_.empty()) {
    tinygltf::Buffer buffer;
    buffer.data = std::move(this->Data_);
    this->File_.buffers = {std::move(buffer)};
  }
  std::ostringstream stream;
  // A megabyte for what is no array.
  const std::size_t bytes = this->File_.buffers.empty() ? 0 : this->File_.buffers[0].data.size();
  if (bytes > 0xffffffffull - (std::size_t(1) << 20)) {
    throw Error(Error::Kind::Resource, object,
                "its arrays take " + std::to_string(bytes) +
                    " bytes; accepted: less than 4 GiB, the limit of binary glTF");
  }
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&this->File_, stream, false, true)) {
    throw Error(Error::Kind::Internal, object, "tinygltf cannot write the scene");
  }
  return stream.str();
}

} // namespace dspace
