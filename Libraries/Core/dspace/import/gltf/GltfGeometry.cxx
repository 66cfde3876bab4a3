// Geometry of a glTF file: what Assimp is asked to decode (accessors, sparse values, Draco, strips
// and fans). It gets a document of our own making: only what a mesh needs, every range checked, and
// integers that Assimp would misread (it copies their bytes as floats) turned into floats before.
#include <dspace/import/gltf/GltfGeometry.h>

#include <algorithm>
#include <map>

#include <dspace/import/gltf/GltfAccessor.h>
#include <dspace/import/gltf/GltfDecoder.h>

namespace dspace {

namespace {

class GeometryReader {
public:
  GeometryReader(const GltfDocument& document, const GltfMaterials& materials,
                 const ImportOptions& options, std::vector<std::string>& warnings)
      : Document_(document), Materials_(materials), Warnings_(warnings),
        Maximum_(MaximumElements(document, options)), Left_(Maximum_) {}

  GltfGeometry Read() {
    GltfGeometry out;
    const Json::Value& meshes = this->Document_.Array("meshes");
    this->StartDocument();
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      out.meshesOf.emplace_back();
      this->AddMesh(i, out.meshesOf.back());
    }
    if (!this->Request_.primitives.empty()) {
      out.meshes = DecodeGltf(this->Document_, this->Materials_, this->Request_, this->Warnings_);
    }
    return out;
  }

private:
  // Vertex attributes, indices and faces that the file may have: by the triangles accepted, and by
  // its bytes, since a small file can name one array in any number of primitives.
  static std::size_t MaximumElements(const GltfDocument& document, const ImportOptions& options) {
    std::size_t bytes = 0;
    for (const std::string& buffer : document.Buffers()) {
      bytes += buffer.size();
    }
    return std::min(std::min<std::size_t>(options.maximumTriangles, 700000000) * 8 + 1024,
                    bytes * 16 + (std::size_t(1) << 20));
  }

  void StartDocument() {
    this->Request_.json["asset"]["version"] = "2.0";
    // Index for index as in the file, with nothing but what decoding needs.
    for (std::size_t i = 0; i < this->Document_.Array("bufferViews").size(); ++i) {
      const Json::Value& view = this->Document_.Element("bufferViews", i);
      this->Request_.json["bufferViews"].append(
          Copy(view, {"buffer", "byteOffset", "byteLength", "byteStride"}));
    }
    for (std::size_t i = 0; i < this->Document_.Array("accessors").size(); ++i) {
      const Json::Value& accessor = this->Document_.Element("accessors", i);
      this->Request_.json["accessors"].append(
          Copy(accessor, {"bufferView", "byteOffset", "componentType", "count", "type", "sparse"}));
    }
  }

  static Json::Value Copy(const Json::Value& from, std::initializer_list<const char*> keys) {
    Json::Value to(Json::objectValue);
    for (const char* key : keys) {
      if (!from[key].isNull()) {
        to[key] = from[key];
      }
    }
    return to;
  }

  // Takes `count` elements from what the file may have in all.
  void Take(std::size_t count, const std::string& where) {
    if (count > this->Left_) {
      this->Document_.Fail(where + " takes the file beyond the number of vertices that is accepted",
                           Error::Kind::Resource);
    }
    this->Left_ -= count;
  }

  void AddMesh(std::size_t index, std::vector<int>& members) {
    const Json::Value& mesh = this->Document_.Element("meshes", index);
    const std::string name = mesh["name"].isString() ? mesh["name"].asString() : "";
    const std::string label =
        "meshes[" + std::to_string(index) + "]" + (name.empty() ? "" : " '" + name + "'");
    const Json::Value& primitives = mesh["primitives"];
    if (!primitives.isArray() || primitives.empty()) {
      this->Document_.Fail(label + " has no primitives");
    }
    for (Json::ArrayIndex p = 0; p < primitives.size(); ++p) {
      const std::string where = label + ".primitives[" + std::to_string(p) + "]";
      if (!primitives[p].isObject() || !primitives[p]["attributes"].isObject()) {
        this->Document_.Fail(where + " has no attributes");
      }
      if (primitives[p]["attributes"]["POSITION"].isNull()) {
        this->Warnings_.push_back(where + " has no positions and is left out");
        continue;
      }
      members.push_back(static_cast<int>(this->Request_.primitives.size()));
      this->AddPrimitive(primitives[p], name, where);
    }
  }

  void AddPrimitive(const Json::Value& from, const std::string& name, const std::string& where) {
    GltfPrimitive primitive;
    primitive.name = name;
    primitive.where = where;
    if (!from["material"].isNull()) {
      primitive.material =
          static_cast<int>(this->Document_.Index(from, "material", "materials", where));
    }
    const Json::Value& draco = from["extensions"]["KHR_draco_mesh_compression"];
    primitive.draco = draco.isObject();

    Json::Value to(Json::objectValue);
    primitive.mode = this->Document_.Count(from, "mode", 4, where);
    if (primitive.mode > 6) {
      this->Document_.Fail(where + ".mode is " + std::to_string(primitive.mode) +
                           "; 0 to 6 are known");
    }
    to["mode"] = static_cast<Json::UInt>(primitive.mode);
    this->AddAttributes(from["attributes"], primitive, to);
    primitive.corners = primitive.vertices;
    if (!from["indices"].isNull()) {
      this->AddIndices(from, primitive, to);
    }
    if (primitive.draco) {
      this->AddDraco(draco, primitive, to);
    }
    Json::Value mesh, node;
    mesh["name"] = "p" + std::to_string(this->Request_.primitives.size());
    mesh["primitives"].append(to);
    node["mesh"] = static_cast<Json::UInt>(this->Request_.primitives.size());
    this->Request_.json["meshes"].append(mesh);
    this->Request_.json["nodes"].append(node);
    this->Request_.json["scenes"][0]["nodes"].append(node["mesh"]);
    this->Request_.primitives.push_back(std::move(primitive));
  }

  void AddAttributes(const Json::Value& from, GltfPrimitive& primitive, Json::Value& to) {
    const std::size_t set =
        primitive.material < 0 ? 0 : this->Materials_.uses[std::size_t(primitive.material)].set;
    struct Wanted {
      std::string from;
      const char* to;
      std::size_t minimum, maximum; // components
    };
    const Wanted wanted[] = {{"POSITION", "POSITION", 3, 3},
                             {"NORMAL", "NORMAL", 3, 3},
                             {"TEXCOORD_" + std::to_string(set), "TEXCOORD_0", 2, 2},
                             {"COLOR_0", "COLOR_0", 3, 4}};
    std::size_t& count = primitive.vertices;
    for (const Wanted& attribute : wanted) {
      if (from[attribute.from].isNull()) {
        continue;
      }
      const std::string where = primitive.where + "." + attribute.from;
      const GltfAccessor accessor = CheckGltfAccessor(
          this->Document_, this->Document_.Index(from, attribute.from.c_str(), "accessors", where),
          this->Maximum_);
      this->Take(accessor.count, where);
      count = count == 0 ? accessor.count : count;
      if (accessor.count != count) {
        this->Document_.Fail(where + " has " + std::to_string(accessor.count) + " elements for " +
                             std::to_string(count) + " vertices");
      }
      if (accessor.components < attribute.minimum || accessor.components > attribute.maximum) {
        this->Document_.Fail(where + " is of type " + accessor.type);
      }
      to["attributes"][attribute.to] =
          static_cast<Json::UInt>(this->AccessorFor(accessor, attribute.maximum, primitive.draco));
    }
  }

  // The accessor that Assimp reads right for `accessor`: itself, or one of floats made from it.
  std::size_t AccessorFor(const GltfAccessor& accessor, std::size_t components, bool draco) {
    const bool plain = accessor.componentType == GltfAccessor::Float && accessor.hasView &&
                       accessor.components == components;
    if (plain || draco) {
      return accessor.index;
    }
    const auto found = this->Converted_.find({accessor.index, components});
    if (found != this->Converted_.end()) {
      return found->second;
    }
    const std::vector<float> values =
        GltfAccessorFloats(this->Document_, accessor, components, 1.0f);
    Json::Value view, made;
    view["buffer"] = static_cast<Json::UInt64>(this->Document_.Buffers().size());
    view["byteOffset"] = static_cast<Json::UInt64>(this->Request_.extra.size());
    view["byteLength"] = static_cast<Json::UInt64>(values.size() * sizeof(float));
    made["bufferView"] = this->Request_.json["bufferViews"].size();
    made["componentType"] = GltfAccessor::Float;
    made["count"] = static_cast<Json::UInt64>(accessor.count);
    made["type"] = "VEC" + std::to_string(components);
    this->Request_.extra.append(reinterpret_cast<const char*>(values.data()),
                                values.size() * sizeof(float));
    this->Request_.json["bufferViews"].append(view);
    this->Request_.json["accessors"].append(made);
    return this->Converted_[{accessor.index, components}] =
               this->Request_.json["accessors"].size() - 1;
  }

  void AddIndices(const Json::Value& from, GltfPrimitive& primitive, Json::Value& to) {
    const std::string where = primitive.where + ".indices";
    const std::size_t index = this->Document_.Index(from, "indices", "accessors", primitive.where);
    const GltfAccessor accessor = CheckGltfAccessor(this->Document_, index, this->Maximum_);
    this->Take(accessor.count, where);
    if (accessor.type != "SCALAR" ||
        (accessor.componentType != 5121 && accessor.componentType != 5123 &&
         accessor.componentType != 5125)) {
      this->Document_.Fail(where + " has component type " + std::to_string(accessor.componentType) +
                           " and type " + accessor.type + "; unsigned scalars are accepted");
    }
    if (!accessor.hasView && !primitive.draco) {
      this->Document_.Fail(where + " has no buffer view");
    }
    // Assimp silently drops faces with indices out of range.
    const std::uint32_t largest =
        primitive.draco ? 0 : GltfAccessorMaximum(this->Document_, accessor);
    if (largest >= primitive.vertices) {
      this->Document_.Fail(where + " has index " + std::to_string(largest) + " of " +
                           std::to_string(primitive.vertices) + " vertices");
    }
    primitive.corners = accessor.count;
    to["indices"] = static_cast<Json::UInt>(index);
  }

  void AddDraco(const Json::Value& from, const GltfPrimitive& primitive, Json::Value& to) {
    const std::string where = primitive.where + ".extensions.KHR_draco_mesh_compression";
    const std::size_t view = this->Document_.Index(from, "bufferView", "bufferViews", where);
    this->Document_.BufferView(view);
    if (!to.isMember("indices")) {
      this->Document_.Fail(where + " has no indices accessor beside it");
    }
    if (!from["attributes"].isObject()) {
      this->Document_.Fail(where + " has no attributes");
    }
    Json::Value made;
    made["bufferView"] = static_cast<Json::UInt>(view);
    // Under the names that AddAttributes chose.
    for (const std::string& name : to["attributes"].getMemberNames()) {
      const std::size_t accessor = to["attributes"][name].asUInt();
      if (this->Document_.Element("accessors", accessor)["sparse"].isObject()) {
        this->Document_.Fail(where + " has a sparse accessor", Error::Kind::Unsupported);
      }
      for (const std::string& original : from["attributes"].getMemberNames()) {
        if (original == name || (name == "TEXCOORD_0" && original.compare(0, 9, "TEXCOORD_") == 0 &&
                                 this->TextureSet(primitive) == original.substr(9))) {
          made["attributes"][name] = static_cast<Json::UInt>(
              this->Document_.Count(from["attributes"], original.c_str(), 0, where));
        }
      }
    }
    to["extensions"]["KHR_draco_mesh_compression"] = made;
    if (!this->Request_.json.isMember("extensionsRequired")) {
      this->Request_.json["extensionsRequired"].append("KHR_draco_mesh_compression");
      this->Request_.json["extensionsUsed"].append("KHR_draco_mesh_compression");
    }
  }

  std::string TextureSet(const GltfPrimitive& primitive) const {
    return std::to_string(
        primitive.material < 0 ? 0 : this->Materials_.uses[std::size_t(primitive.material)].set);
  }

  const GltfDocument& Document_;
  const GltfMaterials& Materials_;
  std::vector<std::string>& Warnings_;
  std::size_t Maximum_; // elements that the file may have in all
  std::size_t Left_;    // of these, not yet taken
  GltfRequest Request_;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> Converted_; // accessor, components
};

} // namespace

GltfGeometry ReadGltfGeometry(const GltfDocument& document, const GltfMaterials& materials,
                              const ImportOptions& options, std::vector<std::string>& warnings) {
  return GeometryReader(document, materials, options, warnings).Read();
}

} // namespace dspace
