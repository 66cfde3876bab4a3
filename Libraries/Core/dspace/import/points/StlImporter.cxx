// ReadStl: text and binary STL. Vertices at exactly the same place become one.
#include <dspace/import/files/ImportFile.h>
#include <dspace/import/files/Importers.h>
#include <dspace/import/files/NumberWords.h>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string_view>
#include <unordered_map>

namespace dspace {

namespace {

constexpr std::size_t BinaryHeader = 84;
constexpr std::size_t BinaryTriangle = 50;

std::uint32_t LittleEndian32(const char* bytes) {
  const auto* b = reinterpret_cast<const unsigned char*>(bytes);
  return b[0] | (b[1] << 8) | (b[2] << 16) | (static_cast<std::uint32_t>(b[3]) << 24);
}

float LittleEndianFloat(const char* bytes) {
  const std::uint32_t bits = LittleEndian32(bytes);
  float value = 0.0f;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

// One solid's triangles, merged as they come.
class Solid {
public:
  Solid(const std::string& path, const std::string& name) : Object_(FileObject(path)) {
    this->Mesh_.name = name;
  }

  void AddTriangle(const std::array<float, 9>& p) {
    std::uint32_t v[3];
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = this->Vertex(&p[3 * i]);
    }
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
      ++this->Degenerate_;
      return;
    }
    this->Mesh_.indices.insert(this->Mesh_.indices.end(), v, v + 3);
  }

  // Moves the mesh into the model, hung on its node 0.
  void Finish(Model& model) {
    if (this->Degenerate_ > 0) {
      model.warnings.push_back(std::to_string(this->Degenerate_) +
                               " triangles with two equal corners are left out (" + this->Object_ +
                               ")");
    }
    if (!this->Mesh_.indices.empty()) {
      model.nodes[0].meshes.push_back(static_cast<int>(model.meshes.size()));
      model.meshes.push_back(std::move(this->Mesh_));
    }
  }

private:
  using Key = std::array<std::uint32_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::uint64_t h = 0x9e3779b97f4a7c15ULL;
      for (const std::uint32_t k : key) {
        h = (h ^ k) * 0xff51afd7ed558ccdULL;
        h ^= h >> 32;
      }
      return static_cast<std::size_t>(h);
    }
  };

  // Coordinates that are not finite are left for RepairMesh to find.
  std::uint32_t Vertex(const float* p) {
    Key key;
    for (std::size_t i = 0; i < 3; ++i) {
      const float value = p[i] + 0.0f; // -0 is 0
      std::memcpy(&key[i], &value, sizeof value);
    }
    const auto [found, fresh] =
        this->Vertices_.emplace(key, static_cast<std::uint32_t>(this->Vertices_.size()));
    if (fresh) {
      this->Mesh_.positions.insert(this->Mesh_.positions.end(), p, p + 3);
    }
    return found->second;
  }

  std::string Object_;
  Mesh Mesh_;
  std::unordered_map<Key, std::uint32_t, Hash> Vertices_;
  std::size_t Degenerate_ = 0;
};

void CheckCount(std::size_t triangles, const std::string& path, const ImportOptions& options) {
  if (triangles > options.maximumTriangles) {
    throw Error(Error::Kind::Resource, FileObject(path),
                "has more than " + std::to_string(options.maximumTriangles) + " triangles");
  }
}

void ReadBinary(const std::string& bytes, Model& model, const ImportOptions& options) {
  const std::size_t count = LittleEndian32(bytes.data() + 80);
  const std::size_t room = (bytes.size() - BinaryHeader) / BinaryTriangle;
  if (count > room) {
    throw Error(Error::Kind::Corrupt, FileObject(model.path),
                "says it has " + std::to_string(count) + " triangles, its " +
                    std::to_string(bytes.size()) + " bytes hold " + std::to_string(room));
  }
  CheckCount(count, model.path, options);
  const std::size_t rest = bytes.size() - BinaryHeader - count * BinaryTriangle;
  if (rest > 0) {
    model.warnings.push_back(std::to_string(rest) +
                             " bytes after the last triangle are left out (" +
                             FileObject(model.path) + ")");
  }
  Solid solid(model.path, "");
  for (std::size_t i = 0; i < count; ++i) {
    const char* triangle = bytes.data() + BinaryHeader + i * BinaryTriangle + 12;
    std::array<float, 9> p;
    for (std::size_t k = 0; k < 9; ++k) {
      p[k] = LittleEndianFloat(triangle + 4 * k);
    }
    solid.AddTriangle(p);
  }
  solid.Finish(model);
}

// The words of a text STL.
class Words {
public:
  Words(const std::string& text, const std::string& path) : Text_(text), Path_(path) {}

  // Lower case; empty at the end.
  std::string Next() {
    while (this->Position_ < this->Text_.size() && IsSpace(this->Text_[this->Position_])) {
      this->Line_ += this->Text_[this->Position_++] == '\n';
    }
    const std::size_t begin = this->Position_;
    while (this->Position_ < this->Text_.size() && !IsSpace(this->Text_[this->Position_])) {
      ++this->Position_;
    }
    std::string word = this->Text_.substr(begin, this->Position_ - begin);
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return word;
  }

  std::string RestOfLine() {
    const std::size_t end = std::min(this->Text_.find('\n', this->Position_), this->Text_.size());
    std::string rest = this->Text_.substr(this->Position_, end - this->Position_);
    this->Position_ = end;
    rest.erase(0, std::min(rest.find_first_not_of(" \t\r"), rest.size()));
    rest.erase(rest.find_last_not_of(" \t\r") + 1);
    return rest;
  }

  void Expect(const char* word) {
    const std::string found = this->Next();
    if (found != word) {
      this->Fail(found, std::string("'") + word + "'");
    }
  }

  float Number() {
    std::string word = this->Next();
    double value = 0.0;
    const char* begin = word.data() + (word[0] == '+');
    const auto result = std::from_chars(begin, word.data() + word.size(), value);
    const bool tiny =
        result.ec == std::errc::result_out_of_range && word.find("e-") != std::string::npos;
    const bool huge = result.ec == std::errc::result_out_of_range && !tiny;
    if (huge || IsNotFiniteWord(word) ||
        (result.ec == std::errc() && result.ptr == word.data() + word.size() &&
         !(std::abs(value) <= std::numeric_limits<float>::max()))) {
      return std::numeric_limits<float>::quiet_NaN();
    }
    if (word.empty() || result.ptr != word.data() + word.size() ||
        (result.ec != std::errc() && !tiny)) {
      this->Fail(word, "a number");
    }
    return tiny ? 0.0f : static_cast<float>(value);
  }

  [[noreturn]] void Fail(const std::string& found, const std::string& expected) const {
    throw Error(Error::Kind::Corrupt, FileObject(this->Path_),
                "line " + std::to_string(this->Line_) + ": found " +
                    (found.empty() ? "the end of the file" : "'" + Utf8Beginning(found, 60) + "'") +
                    " where " + expected + " is expected");
  }

private:
  static bool IsSpace(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

  const std::string& Text_;
  std::string Path_;
  std::size_t Position_ = 0;
  std::size_t Line_ = 1;
};

void ReadText(const std::string& text, Model& model, const ImportOptions& options) {
  Words words(text, model.path);
  std::size_t count = 0;
  for (std::string word = words.Next(); !word.empty(); word = words.Next()) {
    if (word != "solid") {
      words.Fail(word, "'solid'");
    }
    Solid solid(model.path, words.RestOfLine());
    for (word = words.Next(); word == "facet"; word = words.Next()) {
      // Their normals are often wrong or null: they are computed from the triangles.
      words.Expect("normal");
      for (int i = 0; i < 3; ++i) {
        words.Next();
      }
      words.Expect("outer");
      words.Expect("loop");
      std::array<float, 9> p;
      for (std::size_t i = 0; i < 9; ++i) {
        if (i % 3 == 0) {
          words.Expect("vertex");
        }
        p[i] = words.Number();
      }
      words.Expect("endloop");
      words.Expect("endfacet");
      CheckCount(++count, model.path, options);
      solid.AddTriangle(p);
    }
    if (word != "endsolid") {
      words.Fail(word, "'facet' or 'endsolid'");
    }
    words.RestOfLine();
    solid.Finish(model);
  }
}

// Some binary files begin with "solid" too: only a text goes on with "facet" or "endsolid".
bool IsText(const std::string& bytes) {
  const std::size_t begin = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
  std::string start = bytes.substr(begin, 1024);
  if (start.find('\0') != std::string::npos) {
    return false;
  }
  std::transform(start.begin(), start.end(), start.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return start.compare(0, 5, "solid") == 0;
}

} // namespace

Model ReadStl(const std::string& path, const ImportOptions& options) {
  const std::string bytes = ReadFileBytes(path);
  Model model;
  model.path = path;
  model.nodes.emplace_back();
  model.nodes[0].name = std::filesystem::path(path).stem().string();
  const bool exact =
      bytes.size() >= BinaryHeader &&
      bytes.size() - BinaryHeader ==
          static_cast<std::uint64_t>(LittleEndian32(bytes.data() + 80)) * BinaryTriangle;
  if (!exact && IsText(bytes)) {
    ReadText(bytes, model, options);
  } else if (bytes.size() >= BinaryHeader) {
    ReadBinary(bytes, model, options);
  } else {
    throw Error(Error::Kind::Corrupt, FileObject(path),
                "is not an STL file: neither a text that begins with 'solid' nor " +
                    std::to_string(BinaryHeader) + " bytes long");
  }
  if (model.meshes.empty()) {
    throw Error(Error::Kind::Corrupt, FileObject(path), "has no triangles");
  }
  return model;
}

} // namespace dspace
