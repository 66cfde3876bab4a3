#include <dspace/import/obj/ObjMaterials.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <tiny_obj_loader.h>

#include <dspace/Error.h>
#include <dspace/import/files/ImageReader.h>

#include <dspace/import/files/FileNames.h>
#include <dspace/import/files/ImportFile.h>
#include <dspace/import/files/TextureBudget.h>
#include <dspace/import/obj/ObjText.h>

namespace dspace {

namespace {

// Written as every material's first colour, to tell those that give none: tinyobjloader's own
// defaults cannot be told from values of the file.
constexpr double NoColor = -1.0;

double Unit(double value, double fallback) {
  return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : fallback;
}

class LibraryReader {
public:
  LibraryReader(const std::string& objPath, std::vector<std::string>& warnings)
      : ObjPath_(objPath), Warnings_(warnings) {}

  ObjMaterials Read(const std::vector<std::string>& libraries) {
    for (const std::string& library : libraries) {
      for (const std::string& name : this->FileNames(library)) {
        this->ReadLibrary(name);
      }
    }
    return std::move(this->Out_);
  }

private:
  // A library statement as one file name with blanks, where there is such a file, else as several.
  std::vector<std::string> FileNames(const std::string& library) const {
    std::error_code error;
    try {
      if (std::filesystem::exists(ResolveReference(this->ObjPath_, library), error)) {
        return {library};
      }
    } catch (const Error&) {
      return {library}; // rejected again, with its warning, where it is read
    }
    std::istringstream words(library);
    std::vector<std::string> names;
    for (std::string word; words >> word;) {
      names.push_back(word);
    }
    return names;
  }

  void ReadLibrary(const std::string& name) {
    std::string path, bytes;
    try {
      path = ResolveReference(this->ObjPath_, name);
      bytes = ReadFileText(path, std::size_t(1) << 28);
    } catch (const Error& e) {
      this->Out_.complete = false;
      this->Warnings_.push_back("material library '" + name + "' is left out: " + e.what());
      return;
    }
    // tinyobjloader knows no continued lines; names get numbers, as they may hold anything.
    std::ostringstream text;
    std::vector<std::string> names;
    ObjLines lines(bytes);
    ObjLine line;
    std::string keyword, rest;
    while (lines.Next(line)) {
      SplitKeyword(line.text, keyword, rest);
      if (keyword == "newmtl") {
        text << "newmtl m" << names.size() << "\nKd " << NoColor << " " << NoColor << " " << NoColor
             << '\n';
        names.push_back(rest);
      } else if (!names.empty()) {
        text << line.text.c_str() << '\n'; // up to a zero byte, as tinyobjloader reads it
      }
    }
    std::istringstream in(text.str());
    std::map<std::string, int> map;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    tinyobj::LoadMtl(&map, &materials, &in, &warning, &error);
    for (const tinyobj::material_t& material : materials) {
      const std::size_t index =
          material.name.size() > 1 ? std::stoul(material.name.substr(1)) : names.size();
      if (index < names.size()) {
        this->AddMaterial(material, names[index], path);
      }
    }
  }

  void AddMaterial(const tinyobj::material_t& from, const std::string& name,
                   const std::string& mtlPath) {
    if (!this->Out_.byName.emplace(name, static_cast<int>(this->Out_.materials.size())).second) {
      this->Warnings_.push_back("material '" + name + "' is defined twice; the first is taken");
      return;
    }
    Material material;
    ObjMaterials::Placement placement;
    material.name = name;
    const bool hasColor = from.diffuse[0] >= 0.0f;
    for (std::size_t c = 0; c < 3; ++c) {
      const double fallback = from.diffuse_texname.empty() ? 0.8 : 1.0;
      material.color[c] = hasColor ? Unit(from.diffuse[c], fallback) : fallback;
      material.emissive[c] = Unit(from.emission[c], 0.0);
    }
    material.opacity = Unit(from.dissolve, 1.0);
    material.metallic = Unit(from.metallic, 0.0);
    // Blinn-Phong's exponent as a roughness: alpha^2 = 2 / (Ns + 2), alpha = roughness^2.
    if (from.roughness > 0.0f) {
      material.roughness = Unit(from.roughness, 0.8);
    } else if (from.shininess > 1.0f && std::isfinite(from.shininess)) {
      material.roughness = Unit(std::pow(2.0 / (from.shininess + 2.0), 0.25), 0.8);
    }
    if (!from.diffuse_texname.empty()) {
      this->AddTexture(from, mtlPath, material, placement);
    }
    if (!from.alpha_texname.empty() && from.alpha_texname != from.diffuse_texname) {
      this->Warnings_.push_back("material '" + name + "': its opacity texture is left out");
    }
    this->Out_.materials.push_back(std::move(material));
    this->Out_.placements.push_back(placement);
  }

  void AddTexture(const tinyobj::material_t& from, const std::string& mtlPath, Material& material,
                  ObjMaterials::Placement& placement) {
    const tinyobj::texture_option_t& option = from.diffuse_texopt;
    material.repeatTexture = !option.clamp;
    for (std::size_t k = 0; k < 2; ++k) {
      const double scale = option.scale[k], offset = option.origin_offset[k];
      placement.scale[k] = std::isfinite(scale) ? scale : 1.0;
      placement.offset[k] = std::isfinite(offset) ? offset : 0.0;
    }
    const Image* added = nullptr;
    try {
      const std::string path = ResolveReference(mtlPath, from.diffuse_texname);
      auto& image = this->Images_[path];
      if (!image) {
        image = ReadImage(path);
        added = image.get();
      }
      material.texture = image;
    } catch (const Error& e) {
      this->Warnings_.push_back("material '" + material.name +
                                "': its texture is left out: " + e.what());
    }
    this->TextureBudget_.Add(added, FileObject(this->ObjPath_));
  }

  const std::string& ObjPath_;
  std::vector<std::string>& Warnings_;
  ObjMaterials Out_;
  std::map<std::string, std::shared_ptr<const Image>> Images_;
  TextureBudget TextureBudget_;
};

} // namespace

ObjMaterials ReadObjMaterials(const std::string& objPath, const std::vector<std::string>& libraries,
                              std::vector<std::string>& warnings) {
  return LibraryReader(objPath, warnings).Read(libraries);
}

} // namespace dspace
