// Materials and textures of a glTF file (sections 3.8 and 3.9), taken from its JSON: Assimp loses
// wrap modes, WebP alternatives and which texture coordinates a texture uses.
#include <dspace/import/gltf/GltfMaterials.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <dspace/import/files/ImageReader.h>
#include <dspace/import/files/ImportFile.h>
#include <dspace/import/files/TextureBudget.h>

namespace dspace {

namespace {

// sRGB encoding of a linear value in [0, 1] (IEC 61966-2-1).
double Encode(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return std::clamp(v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055, 0.0, 1.0);
}

double Decode(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// Mean of the first three channels of an image, each in [0, 1]; decoded from sRGB when `linear`.
std::array<double, 3> MeanColor(const Image& image, bool linear) {
  std::array<double, 256> table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double v = static_cast<double>(i) / 255.0;
    table[i] = linear ? Decode(v) : v;
  }
  std::array<double, 3> sum = {0.0, 0.0, 0.0};
  const std::size_t n = static_cast<std::size_t>(image.channels);
  for (std::size_t p = 0; p < image.pixels.size(); p += n) {
    for (std::size_t c = 0; c < 3; ++c) {
      sum[c] += table[image.pixels[p + (n >= 3 ? c : 0)]];
    }
  }
  const std::size_t pixels = image.pixels.size() / n;
  for (double& s : sum) {
    s /= static_cast<double>(pixels);
  }
  return sum;
}

// An image without its alpha channel (cutoff < 0), or with alpha 0 or 255 by `cutoff` of 255.
std::shared_ptr<const Image> WithAlpha(const std::shared_ptr<const Image>& image, double cutoff) {
  const std::size_t n = static_cast<std::size_t>(image->channels);
  if (n != 2 && n != 4) {
    return image;
  }
  const std::size_t kept = cutoff < 0.0 ? n - 1 : n;
  auto out = std::make_shared<Image>();
  out->name = image->name + (cutoff < 0.0 ? "#opaque" : "#mask");
  out->width = image->width;
  out->height = image->height;
  out->channels = static_cast<int>(kept);
  out->pixels.reserve(image->pixels.size() / n * kept);
  for (std::size_t p = 0; p < image->pixels.size(); p += n) {
    out->pixels.insert(out->pixels.end(), image->pixels.begin() + std::ptrdiff_t(p),
                       image->pixels.begin() + std::ptrdiff_t(p + n - 1));
    if (kept == n) {
      out->pixels.push_back(image->pixels[p + n - 1] >= cutoff ? 255 : 0);
    }
  }
  return out;
}

class MaterialReader {
public:
  MaterialReader(const GltfDocument& document, std::vector<std::string>& warnings)
      : Document_(document), Warnings_(warnings) {}

  GltfMaterials Read() {
    GltfMaterials out;
    for (std::size_t i = 0; i < this->Document_.Array("materials").size(); ++i) {
      this->ReadMaterial(i, out);
    }
    return out;
  }

private:
  // Image `index`, loaded once; null, with a warning, where it cannot be read.
  std::shared_ptr<const Image> LoadImage(std::size_t index) {
    const auto found = this->Images_.find(index);
    if (found != this->Images_.end()) {
      return found->second;
    }
    const std::string where = "images[" + std::to_string(index) + "]";
    const Json::Value& json = this->Document_.Element("images", index);
    std::shared_ptr<const Image> image;
    try {
      const std::string name = this->Document_.Path() + "#" + std::to_string(index);
      if (!json["bufferView"].isNull()) {
        const GltfDocument::View view = this->Document_.BufferView(
            this->Document_.Index(json, "bufferView", "bufferViews", where));
        image = ReadImageMemory(view.data, view.length, name);
      } else {
        const std::string uri = json["uri"].isString() ? json["uri"].asString() : "";
        const std::string bytes = this->Document_.LoadUri(uri);
        image = ReadImageMemory(bytes.data(), bytes.size(), name);
      }
    } catch (const Error& e) {
      if (e.GetKind() == Error::Kind::Resource) {
        throw;
      }
      this->Warnings_.push_back(where + " is left out: " + e.what());
    }
    this->TextureBudget_.Add(image.get(), FileObject(this->Document_.Path()));
    this->Images_.emplace(index, image);
    return image;
  }

  // The image of a textureInfo object, or null; `repeat` is its sampler's wrap mode.
  std::shared_ptr<const Image> LoadTexture(const Json::Value& info, const std::string& where,
                                           bool* repeat = nullptr) {
    const std::size_t index = this->Document_.Index(info, "index", "textures", where);
    const std::string name = "textures[" + std::to_string(index) + "]";
    const Json::Value& texture = this->Document_.Element("textures", index);
    if (repeat && !texture["sampler"].isNull()) {
      const Json::Value& sampler = this->Document_.Element(
          "samplers", this->Document_.Index(texture, "sampler", "samplers", name));
      *repeat = this->Document_.Count(sampler, "wrapS", 10497, name) != 33071;
    }
    // The WebP twin is only taken where there is no other: every reader has PNG and JPEG.
    const Json::Value& webp = texture["extensions"]["EXT_texture_webp"];
    const Json::Value& source = texture["source"].isNull() ? webp : texture;
    if (source.isNull() || source["source"].isNull()) {
      this->Warnings_.push_back(name + " has no image that is read");
      return nullptr;
    }
    return this->LoadImage(this->Document_.Index(source, "source", "images", name));
  }

  GltfTextureUse ReadUse(const Json::Value& info, const std::string& where) const {
    GltfTextureUse use;
    use.set = this->Document_.Count(info, "texCoord", 0, where);
    const Json::Value& transform = info["extensions"]["KHR_texture_transform"];
    if (transform.isObject()) {
      use.set = this->Document_.Count(transform, "texCoord", use.set, where);
      const std::vector<double> offset =
          this->Document_.Numbers(transform, "offset", 2, {0.0, 0.0}, where);
      const std::vector<double> scale =
          this->Document_.Numbers(transform, "scale", 2, {1.0, 1.0}, where);
      // The extension turns with v downwards, so counter-clockwise is the other way round here.
      const double angle = -this->Document_.Number(transform, "rotation", 0.0, where);
      use.transform = Eigen::Translation2d(offset[0], offset[1]) * Eigen::Rotation2Dd(angle) *
                      Eigen::Scaling(scale[0], scale[1]);
    }
    return use;
  }

  void ReadSurface(const Json::Value& json, const std::string& where, Material& material,
                   GltfTextureUse& use) {
    const Json::Value& glossy = json["extensions"]["KHR_materials_pbrSpecularGlossiness"];
    const bool isGlossy = json["pbrMetallicRoughness"].isNull() && glossy.isObject();
    const Json::Value& pbr = isGlossy ? glossy : json["pbrMetallicRoughness"];
    std::vector<double> factor = {1.0, 1.0, 1.0, 1.0};
    material.metallic = isGlossy ? 0.0 : 1.0;
    material.roughness = 1.0;
    if (pbr.isObject()) {
      factor = this->Document_.Numbers(pbr, isGlossy ? "diffuseFactor" : "baseColorFactor", 4,
                                       factor, where);
      const Json::Value& base = pbr[isGlossy ? "diffuseTexture" : "baseColorTexture"];
      if (!base.isNull()) {
        material.texture = this->LoadTexture(base, where, &material.repeatTexture);
        use = this->ReadUse(base, where);
      }
      if (isGlossy) {
        material.roughness = 1.0 - this->Document_.Number(pbr, "glossinessFactor", 1.0, where);
      } else {
        material.metallic = this->Document_.Number(pbr, "metallicFactor", 1.0, where);
        material.roughness = this->Document_.Number(pbr, "roughnessFactor", 1.0, where);
      }
      const Json::Value& surface = pbr["metallicRoughnessTexture"];
      const auto image = surface.isNull() ? nullptr : this->LoadTexture(surface, where);
      if (image) {
        const std::array<double, 3> mean = MeanColor(*image, false);
        material.roughness *= mean[1];
        material.metallic *= mean[2];
        this->Warnings_.push_back(where +
                                  ": its metallic-roughness texture is replaced by its mean");
      }
    }
    for (int c = 0; c < 3; ++c) {
      material.color[std::size_t(c)] = Encode(factor[std::size_t(c)]);
    }
    material.opacity = std::clamp(factor[3], 0.0, 1.0);
    material.metallic = std::clamp(material.metallic, 0.0, 1.0);
    material.roughness = std::clamp(material.roughness, 0.0, 1.0);
  }

  void ReadEmission(const Json::Value& json, const std::string& where, Material& material) {
    std::vector<double> factor =
        this->Document_.Numbers(json, "emissiveFactor", 3, {0.0, 0.0, 0.0}, where);
    const Json::Value& strength = json["extensions"]["KHR_materials_emissive_strength"];
    const double gain = strength.isObject()
                            ? this->Document_.Number(strength, "emissiveStrength", 1.0, where)
                            : 1.0;
    std::array<double, 3> mean = {1.0, 1.0, 1.0};
    const Json::Value& texture = json["emissiveTexture"];
    const bool lit = factor[0] > 0.0 || factor[1] > 0.0 || factor[2] > 0.0;
    const auto image = texture.isNull() || !lit ? nullptr : this->LoadTexture(texture, where);
    if (image) {
      mean = MeanColor(*image, true);
      this->Warnings_.push_back(where + ": its emissive texture is replaced by its mean");
    }
    for (std::size_t c = 0; c < 3; ++c) {
      material.emissive[c] = Encode(factor[c] * gain * mean[c]);
    }
  }

  // It is drawn with the texture coordinates of the base colour, which are the mesh's.
  void ReadNormals(const Json::Value& info, const std::string& where, GltfTextureUse& use,
                   Material& material) {
    if (!info.isObject()) {
      this->Document_.Fail(where + ".normalTexture is not an object");
    }
    const GltfTextureUse own = this->ReadUse(info, where);
    if (!material.texture) {
      use = own;
    } else if (own.set != use.set || !own.transform.isApprox(use.transform)) {
      this->Warnings_.push_back(where +
                                ": its normal texture is left out, since its texture coordinates "
                                "are not those of its colour");
      return;
    }
    // With an alpha channel it would be in the mesh's own axes.
    const auto image =
        this->LoadTexture(info, where, material.texture ? nullptr : &material.repeatTexture);
    material.normalTexture = image ? WithAlpha(image, -1.0) : nullptr;
    material.normalScale = this->Document_.Number(info, "scale", 1.0, where);
  }

  // Section 3.9.4: only BLEND is translucent; MASK is made a texture of alpha 0 and 255.
  void ReadAlpha(const Json::Value& json, const std::string& where, Material& material) {
    const std::string mode = json["alphaMode"].isString() ? json["alphaMode"].asString() : "OPAQUE";
    if (mode == "BLEND") {
      return;
    }
    double cutoff = -1.0;
    if (mode == "MASK") {
      const double alpha = this->Document_.Number(json, "alphaCutoff", 0.5, where);
      cutoff = material.opacity > 0.0 ? 255.0 * alpha / material.opacity : 256.0;
      cutoff = std::max(cutoff, 0.0);
    }
    material.opacity = mode == "MASK" && cutoff > 255.0 && !material.texture ? 0.0 : 1.0;
    if (material.texture) {
      auto& made = this->AlphaVariants_[{material.texture.get(), cutoff}];
      if (!made) {
        made = WithAlpha(material.texture, cutoff);
      }
      material.texture = made;
    }
  }

  void ReadMaterial(std::size_t index, GltfMaterials& out) {
    const Json::Value& json = this->Document_.Element("materials", index);
    Material material;
    GltfTextureUse use;
    material.name = json["name"].isString() ? json["name"].asString() : "";
    const std::string where = "materials[" + std::to_string(index) + "]" +
                              (material.name.empty() ? "" : " '" + material.name + "'");
    this->ReadSurface(json, where, material, use);
    this->ReadEmission(json, where, material);
    this->ReadAlpha(json, where, material);
    material.doubleSided = json["doubleSided"].isBool() && json["doubleSided"].asBool();
    material.lit = !json["extensions"]["KHR_materials_unlit"].isObject();
    if (!json["normalTexture"].isNull()) {
      this->ReadNormals(json["normalTexture"], where, use, material);
    }
    out.opaque.push_back(!json["alphaMode"].isString() || json["alphaMode"].asString() != "BLEND");
    out.materials.push_back(std::move(material));
    out.uses.push_back(use);
  }

  const GltfDocument& Document_;
  std::vector<std::string>& Warnings_;
  std::map<std::size_t, std::shared_ptr<const Image>> Images_;
  std::map<std::pair<const Image*, double>, std::shared_ptr<const Image>> AlphaVariants_;
  TextureBudget TextureBudget_;
};

} // namespace

GltfMaterials ReadGltfMaterials(const GltfDocument& document, std::vector<std::string>& warnings) {
  return MaterialReader(document, warnings).Read();
}

} // namespace dspace
