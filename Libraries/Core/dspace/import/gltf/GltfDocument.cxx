#include <dspace/import/gltf/GltfDocument.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>

#include <dspace/FileText.h>
#include <dspace/Utf8.h>
#include <dspace/import/files/FileNames.h>
#include <dspace/import/files/ImportFile.h>

namespace dspace {

namespace {

constexpr std::size_t MaximumCount = std::size_t(1) << 40;
constexpr std::size_t MaximumJsonBytes = std::size_t(1) << 28; // a tree takes 10 times its text

// Little-endian 32-bit number at `offset`.
std::uint32_t Word(const std::string& bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (int k = 3; k >= 0; --k) {
    value = (value << 8) | static_cast<unsigned char>(bytes[offset + std::size_t(k)]);
  }
  return value;
}

// Decodes base64 (RFC 4648), standard or URL alphabet; false when it is none.
bool DecodeBase64(const char* begin, const char* end, std::string& out) {
  std::uint32_t bits = 0;
  int count = 0;
  while (end != begin && end[-1] == '=') {
    --end;
  }
  for (; begin != end; ++begin) {
    const char c = *begin;
    const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+' || c == '-' ? 62
                      : c == '/' || c == '_' ? 63
                                             : -1;
    if (value < 0) {
      return false;
    }
    bits = (bits << 6) | static_cast<std::uint32_t>(value);
    if ((count += 6) >= 8) {
      count -= 8;
      out += static_cast<char>((bits >> count) & 0xff);
    }
  }
  return true;
}

} // namespace

GltfDocument::GltfDocument(const std::string& path, Contents contents) : Path_(path) {
  std::string json = ReadFileBytes(path);
  if (json.compare(0, 4, "glTF") == 0) {
    json = this->SplitContainer(json);
  }
  json = ToFileText(std::move(json), FileObject(path));
  const std::size_t mark = json.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0;
  this->ParseJson(json.data() + mark, json.data() + json.size());
  this->CheckVersion();
  if (contents == Contents::All) {
    this->LoadBuffers();
  }
}

void GltfDocument::Fail(const std::string& message, Error::Kind kind) const {
  throw Error(kind, FileObject(this->Path_), message);
}

// Section 4.4: header of 12 bytes, a JSON chunk, at most one binary chunk, then chunks to skip.
std::string GltfDocument::SplitContainer(const std::string& bytes) {
  if (bytes.size() < 20) {
    this->Fail("is truncated: a GLB has a header of 20 bytes, this file " +
               std::to_string(bytes.size()));
  }
  if (Word(bytes, 4) != 2) {
    this->Fail("is GLB version " + std::to_string(Word(bytes, 4)) +
                   (Word(bytes, 4) == 1 ? ", which holds glTF 1.0" : "") +
                   "; glTF 2.0 is read, into which gltf-pipeline converts it",
               Error::Kind::Unsupported);
  }
  if (Word(bytes, 8) > bytes.size()) {
    this->Fail("is truncated: its header says " + std::to_string(Word(bytes, 8)) +
               " bytes, it has " + std::to_string(bytes.size()));
  }
  const std::size_t end = Word(bytes, 8);
  std::string json;
  for (std::size_t at = 12; at + 8 <= end;) {
    const std::size_t length = Word(bytes, at);
    const std::uint32_t type = Word(bytes, at + 4);
    if (length > end - at - 8) {
      this->Fail("is truncated: a chunk of " + std::to_string(length) + " bytes at " +
                 std::to_string(at) + " passes the end");
    }
    if (at == 12 && type != 0x4e4f534a) {
      this->Fail("is damaged: its first chunk is not JSON");
    }
    if (at == 12) {
      json = bytes.substr(at + 8, length);
    } else if (type == 0x004e4942 && !this->HasBinaryChunk_) {
      this->BinaryChunk_ = bytes.substr(at + 8, length);
      this->HasBinaryChunk_ = true;
    }
    at += 8 + length;
  }
  return json;
}

void GltfDocument::ParseJson(const char* begin, const char* end) {
  if (static_cast<std::size_t>(end - begin) > MaximumJsonBytes) {
    this->Fail("has " + std::to_string(end - begin) + " bytes of JSON; at most " +
                   std::to_string(MaximumJsonBytes) + " are read",
               Error::Kind::Resource);
  }
  Json::CharReaderBuilder builder;
  Json::CharReaderBuilder::strictMode(&builder.settings_);
  builder["stackLimit"] = 100; // glTF itself nests about ten deep
  std::string message;
  bool good = false;
  try {
    const std::unique_ptr<Json::CharReader> reader(builder.newCharReader());
    good = reader->parse(begin, end, &this->Root_, &message);
  } catch (const std::exception& e) {
    message = e.what();
  }
  if (!good || !this->Root_.isObject()) {
    this->Fail("is not glTF: its JSON is damaged or truncated: " + Utf8Beginning(message, 200));
  }
  // Version 1 has objects where version 2 has arrays, and its asset may be absent.
  const Json::Value& root = this->Root_; // whose [] makes no members
  if (root["meshes"].isObject() && root["accessors"].isObject()) {
    this->Fail("is glTF 1.0; glTF 2.0 is read, into which gltf-pipeline converts it",
               Error::Kind::Unsupported);
  }
  for (const char* name : {"accessors", "cameras", "extensionsUsed", "bufferViews", "buffers",
                           "images", "materials", "meshes", "nodes", "samplers", "scenes",
                           "textures", "animations", "skins", "extensionsRequired"}) {
    if (this->Root_.isMember(name) && !this->Root_[name].isArray()) {
      this->Fail(std::string("'") + name + "' is not an array");
    }
  }
}

const Json::Value& GltfDocument::Array(const char* name) const {
  static const Json::Value empty(Json::arrayValue);
  return this->Root_.isMember(name) ? this->Root_[name] : empty;
}

const Json::Value& GltfDocument::Element(const char* name, std::size_t index) const {
  const Json::Value& element = this->Array(name)[static_cast<Json::ArrayIndex>(index)];
  if (!element.isObject()) {
    this->Fail(std::string(name) + "[" + std::to_string(index) + "] is not an object");
  }
  return element;
}

std::size_t GltfDocument::Count(const Json::Value& object, const char* key, std::size_t fallback,
                                const std::string& where) const {
  const Json::Value& value = object[key];
  if (value.isNull()) {
    return fallback;
  }
  if (!value.isUInt64() || value.asUInt64() > MaximumCount) {
    this->Fail(where + "." + key + " is not a whole number from 0 to 2^40");
  }
  return static_cast<std::size_t>(value.asUInt64());
}

std::size_t GltfDocument::Index(const Json::Value& object, const char* key, const char* name,
                                const std::string& where) const {
  const std::size_t size = this->Array(name).size();
  const std::size_t index = this->Count(object, key, MaximumCount, where);
  if (index >= size) {
    this->Fail(where + "." + key +
               (index == MaximumCount ? " is missing; an index" : " is " + std::to_string(index)) +
               " of the " + std::to_string(size) + " " + name +
               (index == MaximumCount ? " is needed" : ""));
  }
  return index;
}

double GltfDocument::Number(const Json::Value& object, const char* key, double fallback,
                            const std::string& where) const {
  const Json::Value& value = object[key];
  if (value.isNull()) {
    return fallback;
  }
  if (!value.isNumeric() || !std::isfinite(value.asDouble())) {
    this->Fail(where + "." + key + " is not a finite number");
  }
  return value.asDouble();
}

std::vector<double> GltfDocument::Numbers(const Json::Value& object, const char* key, std::size_t n,
                                          const std::vector<double>& fallback,
                                          const std::string& where) const {
  const Json::Value& value = object[key];
  if (value.isNull()) {
    return fallback;
  }
  std::vector<double> numbers;
  bool good = value.isArray() && value.size() == n;
  for (Json::ArrayIndex i = 0; good && i < n; ++i) {
    good = value[i].isNumeric() && std::isfinite(value[i].asDouble());
    numbers.push_back(good ? value[i].asDouble() : 0.0);
  }
  if (!good) {
    this->Fail(where + "." + key + " is not an array of " + std::to_string(n) + " finite numbers");
  }
  return numbers;
}

GltfDocument::View GltfDocument::BufferView(std::size_t index) const {
  const std::string where = "bufferViews[" + std::to_string(index) + "]";
  const Json::Value& json = this->Element("bufferViews", index);
  const std::string& buffer = this->Buffers_[this->Index(json, "buffer", "buffers", where)];
  const std::size_t offset = this->Count(json, "byteOffset", 0, where);
  View view;
  view.length = this->Count(json, "byteLength", 0, where);
  view.stride = this->Count(json, "byteStride", 0, where);
  if (view.stride != 0 && (view.stride < 4 || view.stride > 252)) {
    this->Fail(where + ".byteStride is " + std::to_string(view.stride) + ", outside 4 to 252");
  }
  if (view.length == 0 || offset + view.length > buffer.size()) {
    this->Fail(where + " has bytes " + std::to_string(offset) + " to " +
               std::to_string(offset + view.length) + " of a buffer of " +
               std::to_string(buffer.size()));
  }
  view.data = buffer.data() + offset;
  return view;
}

void GltfDocument::CheckVersion() const {
  const Json::Value& asset = this->Root_["asset"];
  const std::string version =
      asset.isObject() && asset["version"].isString() ? asset["version"].asString() : "";
  if (version.compare(0, 2, "2.") != 0) {
    this->Fail(version.empty() ? "is not glTF: asset.version is missing"
                               : "is glTF " + version +
                                     "; glTF 2.0 is read, into which gltf-pipeline converts it",
               version.empty() ? Error::Kind::Corrupt : Error::Kind::Unsupported);
  }
}

std::string GltfDocument::LoadUri(const std::string& uri) const {
  if (uri.compare(0, 5, "data:") == 0) {
    const std::size_t comma = uri.find(',');
    const std::size_t mark = uri.find(";base64");
    std::string bytes;
    if (comma == std::string::npos || mark == std::string::npos || mark > comma ||
        !DecodeBase64(uri.data() + comma + 1, uri.data() + uri.size(), bytes)) {
      this->Fail("has a data: URI that is not base64");
    }
    return bytes;
  }
  const std::string decoded = ResolveReference(this->Path_, PercentDecode(uri));
  const std::string literal = ResolveReference(this->Path_, uri);
  std::error_code error;
  const bool useLiteral =
      !std::filesystem::exists(decoded, error) && std::filesystem::exists(literal, error);
  try {
    return ReadFileBytes(useLiteral ? literal : decoded);
  } catch (const Error& e) {
    throw Error(e.GetKind(), FileObject(this->Path_), std::string("needs ") + e.what());
  }
}

void GltfDocument::LoadBuffers() {
  for (std::size_t i = 0; i < this->Array("buffers").size(); ++i) {
    const std::string where = "buffers[" + std::to_string(i) + "]";
    const Json::Value& json = this->Element("buffers", i);
    const std::size_t length = this->Count(json, "byteLength", 0, where);
    std::string bytes;
    if (json["uri"].isString()) {
      bytes = this->LoadUri(json["uri"].asString());
    } else if (json["uri"].isNull() && i == 0 && this->HasBinaryChunk_) {
      bytes = std::move(this->BinaryChunk_);
    } else {
      this->Fail(where + " has neither a uri nor a binary chunk");
    }
    if (bytes.size() < length) {
      this->Fail(where + " is truncated: byteLength is " + std::to_string(length) + ", " +
                 std::to_string(bytes.size()) + " bytes are there");
    }
    bytes.resize(length);
    this->Buffers_.push_back(std::move(bytes));
  }
}

} // namespace dspace
