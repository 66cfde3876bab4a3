// A glTF 2.0 file opened: its JSON, checked where it is used, and its buffers. Internal.
#ifndef DSPACE_IMPORT_GLTF_DOCUMENT_H
#define DSPACE_IMPORT_GLTF_DOCUMENT_H

#include <cstddef>
#include <string>
#include <vector>

#include <json/json.h>

#include <dspace/Error.h>

namespace dspace {

// Section numbers in the sources are those of the glTF 2.0 specification (Khronos).
class GltfDocument {
public:
  // Opens text (.gltf) or binary (.glb) by content, and loads every buffer (data: URIs, files
  // beside the model, the binary chunk). Throws Error: NotFound naming a missing buffer file,
  // Unsupported (glTF 1), Corrupt. With Contents::Json
  // the buffers are left where they are, and need not exist.
  enum class Contents { All, Json };
  explicit GltfDocument(const std::string& path, Contents contents = Contents::All);

  const std::string& Path() const { return this->Path_; }
  const Json::Value& Root() const { return this->Root_; }
  const std::vector<std::string>& Buffers() const { return this->Buffers_; }

  // The top-level array `name`, empty where absent; element `index` of it, always an object.
  const Json::Value& Array(const char* name) const;
  const Json::Value& Element(const char* name, std::size_t index) const;

  // `object[key]` as an index into the top-level array `name`. Throws Error(Corrupt), naming
  // `where`, unless it is one.
  std::size_t Index(const Json::Value& object, const char* key, const char* name,
                    const std::string& where) const;
  // `object[key]` as a whole number of at most 2^40, `fallback` where absent.
  std::size_t Count(const Json::Value& object, const char* key, std::size_t fallback,
                    const std::string& where) const;
  // `object[key]` as a finite number, `fallback` where absent.
  double Number(const Json::Value& object, const char* key, double fallback,
                const std::string& where) const;
  // `object[key]` as `n` finite numbers, `fallback` where absent.
  std::vector<double> Numbers(const Json::Value& object, const char* key, std::size_t n,
                              const std::vector<double>& fallback, const std::string& where) const;

  // Bytes of a bufferView, as (start, length) in its buffer; checked.
  struct View {
    const char* data = nullptr;
    std::size_t length = 0;
    std::size_t stride = 0; // 0: tightly packed
  };
  View BufferView(std::size_t index) const;

  // Bytes that an image or buffer `uri` stands for: data: or a file. Throws Error(NotFound) naming
  // the file where it does not exist.
  std::string LoadUri(const std::string& uri) const;

  [[noreturn]] void Fail(const std::string& message, Error::Kind kind = Error::Kind::Corrupt) const;

private:
  std::string SplitContainer(const std::string& bytes);
  void ParseJson(const char* begin, const char* end);
  void CheckVersion() const;
  void LoadBuffers();

  std::string Path_;
  Json::Value Root_;
  std::string BinaryChunk_;
  bool HasBinaryChunk_ = false;
  std::vector<std::string> Buffers_;
};

} // namespace dspace

#endif
