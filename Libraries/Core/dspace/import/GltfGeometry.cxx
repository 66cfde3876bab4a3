// Geometry of a glTF file through Assimp, which decodes accessors, sparse values, Draco, strips and
// fans. Assimp is handed a document of our own making: one mesh a primitive, only what a mesh
// needs, every range checked, and integers that Assimp would misread (it copies their bytes as
// floats) turned into floats before.
#include "GltfDocument.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include "GltfAccessor.h"
#include "MeshRepair.h"

namespace dspace {

namespace {

// What Assimp may open: the document and its buffers, in memory; no file at all.
class MemoryFiles : public Assimp::IOSystem {
public:
  void Add(const std::string& name, const std::string* bytes) { this->Files_[name] = bytes; }

  bool Exists(const char* file) const override { return this->Find(file) != nullptr; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    const std::string* bytes = mode[0] == 'r' ? this->Find(file) : nullptr;
    return bytes ? new Stream(*bytes) : nullptr;
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

private:
  class Stream : public Assimp::IOStream {
  public:
    explicit Stream(const std::string& bytes) : Bytes_(bytes) {}
    size_t Read(void* out, size_t size, size_t count) override {
      const size_t left = this->Bytes_.size() - this->At_;
      const size_t n = size == 0 ? 0 : std::min(count, left / size);
      std::memcpy(out, this->Bytes_.data() + this->At_, n * size);
      this->At_ += n * size;
      return n;
    }
    size_t Write(const void*, size_t, size_t) override { return 0; }
    aiReturn Seek(size_t offset, aiOrigin origin) override {
      const size_t base = origin == aiOrigin_SET   ? 0
                          : origin == aiOrigin_CUR ? this->At_
                                                   : this->Bytes_.size();
      if (offset > this->Bytes_.size() - base) {
        return aiReturn_FAILURE;
      }
      this->At_ = base + offset;
      return aiReturn_SUCCESS;
    }
    size_t Tell() const override { return this->At_; }
    size_t FileSize() const override { return this->Bytes_.size(); }
    void Flush() override {}

  private:
    const std::string& Bytes_;
    size_t At_ = 0;
  };

  const std::string* Find(const char* file) const {
    const char* slash = std::strrchr(file, '/');
    const auto found = this->Files_.find(slash ? slash + 1 : file);
    return found == this->Files_.end() ? nullptr : found->second;
  }

  std::map<std::string, const std::string*> Files_;
};

// One primitive of the file, as the document for Assimp has it.
struct Primitive {
  std::string name;
  std::string where;
  int material = -1;
  bool draco = false;
  std::size_t mode = 4;     // section 5.24.4: 0 points, ... 4 triangles, ... 6 fan
  std::size_t vertices = 0; // as the file says
  std::size_t corners = 0;  // indices, or vertices where there are none

  // Faces, lines or points that the corners make.
  std::size_t FaceCount() const {
    switch (this->mode) {
    case 0:
    case 2: // a loop has as many lines as corners
      return this->corners;
    case 1:
      return this->corners / 2;
    case 3:
      return this->corners > 1 ? this->corners - 1 : 0;
    case 4:
      return this->corners / 3;
    default:
      return this->corners > 2 ? this->corners - 2 : 0;
    }
  }
};

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
    if (!this->Primitives_.empty()) {
      this->Decode(out.meshes);
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
    this->Json_["asset"]["version"] = "2.0";
    // Index for index as in the file, with nothing but what decoding needs.
    for (std::size_t i = 0; i < this->Document_.Array("bufferViews").size(); ++i) {
      const Json::Value& view = this->Document_.Element("bufferViews", i);
      this->Json_["bufferViews"].append(
          Copy(view, {"buffer", "byteOffset", "byteLength", "byteStride"}));
    }
    for (std::size_t i = 0; i < this->Document_.Array("accessors").size(); ++i) {
      const Json::Value& accessor = this->Document_.Element("accessors", i);
      this->Json_["accessors"].append(
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
    if (!mesh["weights"].isNull()) {
      this->Warnings_.push_back(label + ": its morph targets are left out");
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
      members.push_back(static_cast<int>(this->Primitives_.size()));
      this->AddPrimitive(primitives[p], name, where);
    }
  }

  void AddPrimitive(const Json::Value& from, const std::string& name, const std::string& where) {
    Primitive primitive;
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
    mesh["name"] = "p" + std::to_string(this->Primitives_.size());
    mesh["primitives"].append(to);
    node["mesh"] = static_cast<Json::UInt>(this->Primitives_.size());
    this->Json_["meshes"].append(mesh);
    this->Json_["nodes"].append(node);
    this->Json_["scenes"][0]["nodes"].append(node["mesh"]);
    this->Primitives_.push_back(std::move(primitive));
  }

  void AddAttributes(const Json::Value& from, Primitive& primitive, Json::Value& to) {
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
    view["byteOffset"] = static_cast<Json::UInt64>(this->Extra_.size());
    view["byteLength"] = static_cast<Json::UInt64>(values.size() * sizeof(float));
    made["bufferView"] = this->Json_["bufferViews"].size();
    made["componentType"] = GltfAccessor::Float;
    made["count"] = static_cast<Json::UInt64>(accessor.count);
    made["type"] = "VEC" + std::to_string(components);
    this->Extra_.append(reinterpret_cast<const char*>(values.data()),
                        values.size() * sizeof(float));
    this->Json_["bufferViews"].append(view);
    this->Json_["accessors"].append(made);
    return this->Converted_[{accessor.index, components}] = this->Json_["accessors"].size() - 1;
  }

  void AddIndices(const Json::Value& from, Primitive& primitive, Json::Value& to) {
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
    // Assimp drops faces with indices out of range without a word.
    const std::uint32_t largest =
        primitive.draco ? 0 : GltfAccessorMaximum(this->Document_, accessor);
    if (largest >= primitive.vertices) {
      this->Document_.Fail(where + " has index " + std::to_string(largest) + " of " +
                           std::to_string(primitive.vertices) + " vertices");
    }
    primitive.corners = accessor.count;
    to["indices"] = static_cast<Json::UInt>(index);
  }

  void AddDraco(const Json::Value& from, const Primitive& primitive, Json::Value& to) {
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
    if (!this->Json_.isMember("extensionsRequired")) {
      this->Json_["extensionsRequired"].append("KHR_draco_mesh_compression");
      this->Json_["extensionsUsed"].append("KHR_draco_mesh_compression");
    }
  }

  std::string TextureSet(const Primitive& primitive) const {
    return std::to_string(
        primitive.material < 0 ? 0 : this->Materials_.uses[std::size_t(primitive.material)].set);
  }

  void Decode(std::vector<Mesh>& out) {
    auto* files = new MemoryFiles; // owned by the importer
    Assimp::Importer importer;
    importer.SetIOHandler(files);
    std::vector<const std::string*> buffers;
    for (const std::string& buffer : this->Document_.Buffers()) {
      buffers.push_back(&buffer);
    }
    buffers.push_back(&this->Extra_);
    for (std::size_t i = 0; i < buffers.size(); ++i) {
      Json::Value buffer;
      buffer["uri"] = "buffer" + std::to_string(i);
      buffer["byteLength"] = static_cast<Json::UInt64>(buffers[i]->size());
      this->Json_["buffers"].append(buffer);
      files->Add("buffer" + std::to_string(i), buffers[i]);
    }
    this->Json_["scene"] = 0;
    Json::StreamWriterBuilder writer;
    writer["indentation"] = "";
    const std::string text = Json::writeString(writer, this->Json_);
    files->Add("document.gltf", &text);

    const aiScene* scene = importer.ReadFile("document.gltf", 0);
    if (!scene) {
      this->Document_.Fail(std::string("its geometry cannot be decoded: ") +
                           importer.GetErrorString());
    }
    std::map<std::string, const aiMesh*> byName;
    for (unsigned int i = 0; i < scene->mNumMeshes; ++i) {
      byName[scene->mMeshes[i]->mName.C_Str()] = scene->mMeshes[i];
    }
    for (std::size_t i = 0; i < this->Primitives_.size(); ++i) {
      const auto found = byName.find("p" + std::to_string(i));
      if (found == byName.end()) {
        this->Document_.Fail(this->Primitives_[i].where + " was not decoded");
      }
      out.push_back(this->Convert(*found->second, this->Primitives_[i]));
    }
  }

  Mesh Convert(const aiMesh& from, const Primitive& primitive) {
    Mesh mesh;
    mesh.name = primitive.name;
    mesh.material = primitive.material;
    const std::size_t n = from.mNumVertices;
    const auto copy = [n](const aiVector3D* v, std::vector<float>& to) {
      to.reserve(3 * n);
      for (std::size_t i = 0; v && i < n; ++i) {
        to.insert(to.end(), {v[i].x, v[i].y, v[i].z});
      }
    };
    copy(from.mVertices, mesh.positions);
    copy(from.mNormals, mesh.normals);
    this->ConvertTcoords(from, primitive, mesh);
    this->ConvertColors(from, primitive, mesh);
    this->ConvertFaces(from, primitive, mesh);
    if (!NormalizeNormals(mesh)) {
      this->Warnings_.push_back(primitive.where +
                                ": its normals are left out, some have no length");
    }
    DropUnusedVertices(mesh);
    return mesh;
  }

  void ConvertTcoords(const aiMesh& from, const Primitive& primitive, Mesh& mesh) const {
    const aiVector3D* t = from.mTextureCoords[0];
    const Eigen::Affine2d transform =
        primitive.material < 0 ? Eigen::Affine2d::Identity()
                               : this->Materials_.uses[std::size_t(primitive.material)].transform;
    for (std::size_t i = 0; t && i < from.mNumVertices; ++i) {
      // Assimp has turned v = 0 to the bottom row; the transform is meant for glTF's own v.
      const Eigen::Vector2d uv = transform * Eigen::Vector2d(t[i].x, 1.0 - double(t[i].y));
      mesh.tcoords.push_back(static_cast<float>(uv.x()));
      mesh.tcoords.push_back(static_cast<float>(1.0 - uv.y()));
    }
  }

  // Linear to sRGB, as Material has its colours; alpha stays linear.
  void ConvertColors(const aiMesh& from, const Primitive& primitive, Mesh& mesh) const {
    const bool opaque =
        primitive.material < 0 || this->Materials_.opaque[std::size_t(primitive.material)];
    const auto byte = [](double v) {
      return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(v, 0.0, 1.0)));
    };
    const auto encode = [&](double v) {
      return byte(v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055);
    };
    for (std::size_t i = 0; from.mColors[0] && i < from.mNumVertices; ++i) {
      const aiColor4D& c = from.mColors[0][i];
      if (!std::isfinite(c.r) || !std::isfinite(c.g) || !std::isfinite(c.b) ||
          !std::isfinite(c.a)) {
        this->Document_.Fail(primitive.where + ".COLOR_0 has a value that is not finite");
      }
      mesh.colors.insert(mesh.colors.end(), {encode(c.r), encode(c.g), encode(c.b),
                                             opaque ? std::uint8_t(255) : byte(c.a)});
    }
  }

  void ConvertFaces(const aiMesh& from, const Primitive& primitive, Mesh& mesh) {
    const unsigned int corners = from.mPrimitiveTypes & aiPrimitiveType_TRIANGLE ? 3
                                 : from.mPrimitiveTypes & aiPrimitiveType_LINE   ? 2
                                                                                 : 1;
    mesh.primitive = corners == 3   ? Mesh::Primitive::Triangles
                     : corners == 2 ? Mesh::Primitive::Lines
                                    : Mesh::Primitive::Points;
    if (from.mNumVertices != primitive.vertices || from.mNumFaces != primitive.FaceCount()) {
      this->Document_.Fail(primitive.where + " decodes to " + std::to_string(from.mNumVertices) +
                           " vertices and " + std::to_string(from.mNumFaces) +
                           " faces; the file says " + std::to_string(primitive.vertices) + " and " +
                           std::to_string(primitive.FaceCount()));
    }
    this->Take(from.mNumFaces, primitive.where);
    mesh.indices.reserve(std::size_t(from.mNumFaces) * corners);
    for (unsigned int f = 0; f < from.mNumFaces; ++f) {
      const aiFace& face = from.mFaces[f];
      if (face.mNumIndices != corners) {
        this->Document_.Fail(primitive.where + " has a face of " +
                             std::to_string(face.mNumIndices) + " corners");
      }
      for (unsigned int k = 0; k < corners; ++k) {
        if (face.mIndices[k] >= from.mNumVertices) {
          this->Document_.Fail(primitive.where + " has index " + std::to_string(face.mIndices[k]) +
                               " of " + std::to_string(from.mNumVertices) + " vertices");
        }
        mesh.indices.push_back(face.mIndices[k]);
      }
    }
  }

  const GltfDocument& Document_;
  const GltfMaterials& Materials_;
  std::vector<std::string>& Warnings_;
  std::size_t Maximum_; // elements that the file may have in all
  std::size_t Left_;    // of these, not yet taken
  Json::Value Json_;
  std::vector<Primitive> Primitives_;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> Converted_; // accessor, components
  std::string Extra_; // floats made from integers
};

} // namespace

GltfGeometry ReadGltfGeometry(const GltfDocument& document, const GltfMaterials& materials,
                              const ImportOptions& options, std::vector<std::string>& warnings) {
  return GeometryReader(document, materials, options, warnings).Read();
}

} // namespace dspace
