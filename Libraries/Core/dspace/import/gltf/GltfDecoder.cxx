#include <dspace/import/gltf/GltfDecoder.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <dspace/import/model/MeshRepair.h>

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

class Decoder {
public:
  Decoder(const GltfDocument& document, const GltfMaterials& materials, GltfRequest& request,
          std::vector<std::string>& warnings)
      : Document_(document), Materials_(materials), Request_(request), Warnings_(warnings) {}

  std::vector<Mesh> Decode() {
    std::vector<Mesh> out;
    auto* files = new MemoryFiles; // owned by the importer
    Assimp::Importer importer;
    importer.SetIOHandler(files);
    std::vector<const std::string*> buffers;
    for (const std::string& buffer : this->Document_.Buffers()) {
      buffers.push_back(&buffer);
    }
    buffers.push_back(&this->Request_.extra);
    for (std::size_t i = 0; i < buffers.size(); ++i) {
      Json::Value buffer;
      buffer["uri"] = "buffer" + std::to_string(i);
      buffer["byteLength"] = static_cast<Json::UInt64>(buffers[i]->size());
      this->Request_.json["buffers"].append(buffer);
      files->Add("buffer" + std::to_string(i), buffers[i]);
    }
    this->Request_.json["scene"] = 0;
    Json::StreamWriterBuilder writer;
    writer["indentation"] = "";
    const std::string text = Json::writeString(writer, this->Request_.json);
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
    for (std::size_t i = 0; i < this->Request_.primitives.size(); ++i) {
      const auto found = byName.find("p" + std::to_string(i));
      if (found == byName.end()) {
        this->Document_.Fail(this->Request_.primitives[i].where + " was not decoded");
      }
      out.push_back(this->Convert(*found->second, this->Request_.primitives[i]));
    }
    return out;
  }

private:
  Mesh Convert(const aiMesh& from, const GltfPrimitive& primitive) {
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
    DropUnusedVertices(mesh);
    return mesh;
  }

  void ConvertTcoords(const aiMesh& from, const GltfPrimitive& primitive, Mesh& mesh) const {
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
  void ConvertColors(const aiMesh& from, const GltfPrimitive& primitive, Mesh& mesh) const {
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

  void ConvertFaces(const aiMesh& from, const GltfPrimitive& primitive, Mesh& mesh) {
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
  GltfRequest& Request_;
  std::vector<std::string>& Warnings_;
};

} // namespace

std::vector<Mesh> DecodeGltf(const GltfDocument& document, const GltfMaterials& materials,
                             GltfRequest& request, std::vector<std::string>& warnings) {
  return Decoder(document, materials, request, warnings).Decode();
}

} // namespace dspace
