// ReadPly: text and binary PLY: polygons, triangle strips, edges or bare points, with the colours,
// normals and texture coordinates of their vertices.
#include <dspace/import/files/FileNames.h>
#include <dspace/import/files/ImageReader.h>
#include <dspace/import/files/ImportFile.h>
#include <dspace/import/files/Importers.h>
#include <dspace/import/model/Polygon.h>
#include <dspace/import/points/PlyFile.h>

#include <dspace/Error.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

namespace dspace {

namespace {

// Coordinates this many times larger than the extent of the model lose too much as floats: their
// centre goes into the node's own translation.
constexpr double FarFromOrigin = 64.0;

// The first of those names that the element has as a plain value, or -1.
int FindAny(const PlyElement& element, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const int i = element.Find(name);
    if (i >= 0 && !element.properties[static_cast<std::size_t>(i)].list) {
      return i;
    }
  }
  return -1;
}

struct Vertices {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3d> normals;
  std::vector<Eigen::Vector2d> tcoords;
  std::vector<std::uint8_t> colors;
};

struct Primitives {
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> lines;
  // Of the triangles' corners, where faces have attributes of their own; else empty.
  std::vector<Eigen::Vector2d> tcoords;
  std::vector<std::array<std::uint8_t, 4>> colors;
};

class Reader {
public:
  Reader(const std::string& path, const ImportOptions& options)
      : Path_(path), Options_(options), Bytes_(ReadFileBytes(path)),
        Header_(ParsePlyHeader(this->Bytes_, path)), Values_(this->Bytes_, this->Header_, path) {}

  Model Run() {
    for (const PlyElement& element : this->Header_.elements) {
      if (element.name == "vertex") {
        this->ReadVertices(element);
      } else if (element.name == "face") {
        this->ReadFaces(element);
      } else if (element.name == "tristrips") {
        this->ReadStrips(element);
      } else if (element.name == "edge") {
        this->ReadEdges(element);
      } else {
        this->Skip(element);
        this->Warn("element " + element.name + " is not read");
      }
    }
    if (this->Values_.BytesLeft() > 0) {
      this->Warn(std::to_string(this->Values_.BytesLeft()) +
                 " bytes after the last element are left out");
    }
    this->ReadTexture();
    return this->MakeModel();
  }

private:
  [[noreturn]] void Fail(const std::string& message) const {
    throw Error(Error::Kind::Corrupt, FileObject(this->Path_), message);
  }

  void Warn(const std::string& message) {
    this->Warnings_.push_back(message + " (" + FileObject(this->Path_) + ")");
  }

  // One row: plain values by property; lists are read into `list` and `other` where wanted, else
  // skipped.
  void ReadRow(const PlyElement& element, std::uint64_t row, int wantedList,
               std::vector<double>& values, std::vector<double>& list, int otherList = -1,
               std::vector<double>* other = nullptr) {
    values.assign(element.properties.size(), 0.0);
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (!property.list) {
        values[i] = this->Values_.Next(property.type, element, row);
      } else if (static_cast<int>(i) == wantedList) {
        this->Values_.NextList(property, element, row, list);
      } else if (other && static_cast<int>(i) == otherList) {
        this->Values_.NextList(property, element, row, *other);
      } else {
        this->Values_.NextList(property, element, row, this->Unused_);
      }
    }
  }

  void Skip(const PlyElement& element) {
    std::vector<double> values;
    for (std::uint64_t row = 0; row < element.count; ++row) {
      this->ReadRow(element, row, -1, values, this->Unused_);
    }
  }

  void ReadVertices(const PlyElement& element) {
    if (this->HasVertices_) {
      this->Fail("element vertex is given twice");
    }
    this->HasVertices_ = true;
    const int p[3] = {FindAny(element, {"x"}), FindAny(element, {"y"}), FindAny(element, {"z"})};
    if (p[0] < 0 || p[1] < 0 || p[2] < 0) {
      this->Fail("element vertex has no properties x, y and z");
    }
    const int n[3] = {FindAny(element, {"nx", "normal_x"}), FindAny(element, {"ny", "normal_y"}),
                      FindAny(element, {"nz", "normal_z"})};
    const std::array<int, 4> c = FindColors(element);
    const int t[2] = {FindAny(element, {"u", "s", "texture_u", "texture_s"}),
                      FindAny(element, {"v", "t", "texture_v", "texture_t"})};
    const bool normals = n[0] >= 0 && n[1] >= 0 && n[2] >= 0;
    const bool colors = c[0] >= 0 && c[1] >= 0 && c[2] >= 0;
    const bool tcoords = t[0] >= 0 && t[1] >= 0;
    std::vector<double> row;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      this->ReadRow(element, i, -1, row, this->Unused_);
      const auto at = [&row](int k) { return row[static_cast<std::size_t>(k)]; };
      const Eigen::Vector3d position(at(p[0]), at(p[1]), at(p[2]));
      this->Vertices_.positions.push_back(position);
      if (normals) {
        this->Vertices_.normals.emplace_back(at(n[0]), at(n[1]), at(n[2]));
      }
      if (tcoords) {
        this->Vertices_.tcoords.emplace_back(at(t[0]), at(t[1]));
      }
      for (int k = 0; colors && k < 4; ++k) {
        this->Vertices_.colors.push_back(
            c[std::size_t(k)] < 0
                ? 255
                : Byte(at(c[std::size_t(k)]), element.properties[std::size_t(c[std::size_t(k)])]));
      }
    }
  }

  static std::array<int, 4> FindColors(const PlyElement& element) {
    return {FindAny(element, {"red", "diffuse_red", "r"}),
            FindAny(element, {"green", "diffuse_green", "g"}),
            FindAny(element, {"blue", "diffuse_blue", "b"}),
            FindAny(element, {"alpha", "diffuse_alpha", "a"})};
  }

  // Integers use the range of their type, floats run from 0 to 1.
  static std::uint8_t Byte(double value, const PlyProperty& property) {
    const double full = property.type == PlyType::UInt16 || property.type == PlyType::Int16
                            ? 65535.0
                        : IsPlyInteger(property.type) ? 255.0
                                                      : 1.0;
    const double scaled = value / full * 255.0;
    return scaled > 0.0 ? static_cast<std::uint8_t>(std::lround(std::min(scaled, 255.0))) : 0;
  }

  std::uint32_t Index(double value, const PlyElement& element, std::uint64_t row) const {
    if (!(value >= 0.0 && value < static_cast<double>(this->Vertices_.positions.size())) ||
        value != std::floor(value)) {
      this->Fail(element.name + " " + std::to_string(row) + " has the vertex index " +
                 std::to_string(value) + "; there are " +
                 std::to_string(this->Vertices_.positions.size()) + " vertices before it");
    }
    return static_cast<std::uint32_t>(value);
  }

  void CheckTriangles() const {
    if (this->Primitives_.triangles.size() / 3 > this->Options_.maximumTriangles) {
      throw Error(Error::Kind::Resource, FileObject(this->Path_),
                  "has more than " + std::to_string(this->Options_.maximumTriangles) +
                      " triangles");
    }
  }

  static int FindIndices(const PlyElement& element) {
    int only = -1, lists = 0;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (property.list) {
        ++lists;
        only = static_cast<int>(i);
        if (property.name == "vertex_indices" || property.name == "vertex_index") {
          return only;
        }
      }
    }
    return lists == 1 && IsPlyInteger(element.properties[std::size_t(only)].type) ? only : -1;
  }

  // A face's own attributes, for the corners of one of its triangles.
  void AddCorners(const std::array<int, 3>& triangle, const std::vector<double>& tcoords,
                  std::size_t corners, const std::array<std::uint8_t, 4>* color) {
    for (const int k : triangle) {
      if (color) {
        this->Primitives_.colors.push_back(*color);
      }
      if (tcoords.size() == 2 * corners) {
        this->Primitives_.tcoords.emplace_back(tcoords[2 * std::size_t(k)],
                                               tcoords[2 * std::size_t(k) + 1]);
      }
    }
  }

  void ReadFaces(const PlyElement& element) {
    const int indices = FindIndices(element);
    if (indices < 0 && element.count > 0) {
      this->Fail("element face has no list vertex_indices or vertex_index");
    }
    const int texcoord = element.Find("texcoord"); // MeshLab's: u v a corner
    const std::array<int, 4> c = FindColors(element);
    const bool colored = c[0] >= 0 && c[1] >= 0 && c[2] >= 0 && this->Vertices_.colors.empty();
    std::vector<double> row;
    std::vector<double> list;
    std::vector<double> tcoords;
    std::vector<Eigen::Vector3d> corners;
    std::vector<std::array<int, 3>> triangles;
    std::size_t small = 0;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      this->ReadRow(element, i, indices, row, list, texcoord, &tcoords);
      corners.clear();
      for (const double value : list) {
        corners.push_back(this->Vertices_.positions[this->Index(value, element, i)]);
      }
      small += corners.size() < 3;
      triangles.clear();
      TriangulatePolygon(corners, false, triangles);
      std::array<std::uint8_t, 4> color = {255, 255, 255, 255};
      for (std::size_t k = 0; colored && k < 4; ++k) {
        if (c[k] >= 0) {
          color[k] = Byte(row[std::size_t(c[k])], element.properties[std::size_t(c[k])]);
        }
      }
      for (const std::array<int, 3>& t : triangles) {
        for (const int k : t) {
          this->Primitives_.triangles.push_back(
              static_cast<std::uint32_t>(list[static_cast<std::size_t>(k)]));
        }
        this->AddCorners(t, tcoords, corners.size(), colored ? &color : nullptr);
      }
      this->CheckTriangles();
    }
    if (small > 0) {
      this->Warn(std::to_string(small) + " faces with fewer than 3 corners are left out");
    }
    if (this->Primitives_.tcoords.size() != this->Primitives_.triangles.size() &&
        !this->Primitives_.tcoords.empty()) {
      this->Warn("texture coordinates of faces are left out: some faces have none");
      this->Primitives_.tcoords.clear();
    }
  }

  // Strips, each ended by -1, of alternating direction.
  void ReadStrips(const PlyElement& element) {
    const int indices = FindIndices(element);
    if (indices < 0 && element.count > 0) {
      this->Fail("element tristrips has no list vertex_indices");
    }
    std::vector<double> row;
    std::vector<double> list;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      this->ReadRow(element, i, indices, row, list);
      std::vector<std::uint32_t> strip;
      for (const double value : list) {
        if (value == -1.0) {
          strip.clear();
          continue;
        }
        strip.push_back(this->Index(value, element, i));
        const std::size_t n = strip.size();
        if (n >= 3 && strip[n - 1] != strip[n - 2] && strip[n - 2] != strip[n - 3] &&
            strip[n - 1] != strip[n - 3]) {
          const bool odd = n % 2 == 0;
          const std::uint32_t a = strip[n - 3];
          const std::uint32_t b = strip[n - 2];
          this->Primitives_.triangles.insert(this->Primitives_.triangles.end(),
                                             {odd ? b : a, odd ? a : b, strip[n - 1]});
        }
      }
      this->CheckTriangles();
    }
  }

  void ReadEdges(const PlyElement& element) {
    const int a = FindAny(element, {"vertex1"});
    const int b = FindAny(element, {"vertex2"});
    std::vector<double> row;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      this->ReadRow(element, i, -1, row, this->Unused_);
      if (a >= 0 && b >= 0) {
        this->Primitives_.lines.push_back(
            this->Index(row[static_cast<std::size_t>(a)], element, i));
        this->Primitives_.lines.push_back(
            this->Index(row[static_cast<std::size_t>(b)], element, i));
      }
    }
  }

  Model MakeModel() {
    if (this->Vertices_.positions.empty()) {
      this->Fail("has no vertices");
    }
    Model model;
    model.path = this->Path_;
    model.nodes.emplace_back();
    model.nodes[0].name = std::filesystem::path(this->Path_).stem().string();
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : this->Vertices_.positions) {
      if (p.allFinite()) {
        box.extend(p);
      }
    }
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    if (!box.isEmpty() && box.center().norm() > FarFromOrigin * box.sizes().norm()) {
      origin = box.center();
      model.nodes[0].local.translate(origin);
    }
    // A file with faces and edges shows both; one with neither is a cloud of points, which
    // ReadModel rejects unless it is asked for.
    if (!this->Primitives_.triangles.empty()) {
      this->AddMesh(model, Mesh::Primitive::Triangles, this->Primitives_.triangles, origin);
    }
    if (!this->Primitives_.lines.empty()) {
      this->AddMesh(model, Mesh::Primitive::Lines, this->Primitives_.lines, origin);
    }
    if (model.meshes.empty()) {
      std::vector<std::uint32_t> all(this->Vertices_.positions.size());
      for (std::size_t i = 0; i < all.size(); ++i) {
        all[i] = static_cast<std::uint32_t>(i);
      }
      this->AddMesh(model, Mesh::Primitive::Points, all, origin);
    }
    model.warnings = this->Warnings_;
    return model;
  }

  void AddMesh(Model& model, Mesh::Primitive primitive, const std::vector<std::uint32_t>& indices,
               const Eigen::Vector3d& origin) const {
    Mesh mesh;
    mesh.primitive = primitive;
    mesh.indices = indices;
    mesh.colors = this->Vertices_.colors;
    const auto append = [](std::vector<float>& out, const auto& v) {
      for (int i = 0; i < v.size(); ++i) {
        out.push_back(static_cast<float>(v[i]));
      }
    };
    for (const Eigen::Vector3d& p : this->Vertices_.positions) {
      append(mesh.positions, (p - origin).eval());
    }
    for (const Eigen::Vector2d& t : this->Vertices_.tcoords) {
      append(mesh.tcoords, t);
    }
    for (const Eigen::Vector3d& n : this->Vertices_.normals) {
      append(mesh.normals, n.normalized().eval()); // of one without length all 0
    }
    if (primitive == Mesh::Primitive::Triangles) {
      this->GiveCornersTheirOwn(mesh);
    }
    // Vertex colours are the colours, not a tint of the default grey; what has no normals and no
    // faces to make them from cannot be lit.
    Material material;
    material.lit = primitive == Mesh::Primitive::Triangles || !mesh.normals.empty();
    if (!mesh.colors.empty()) {
      material.color = {1.0, 1.0, 1.0};
    }
    if (!mesh.tcoords.empty() && this->Texture_) {
      material.texture = this->Texture_;
      material.color = {1.0, 1.0, 1.0};
    }
    if (!mesh.colors.empty() || !material.lit || material.texture) {
      mesh.material = static_cast<int>(model.materials.size());
      model.materials.push_back(material);
    }
    model.nodes[0].meshes.push_back(static_cast<int>(model.meshes.size()));
    model.meshes.push_back(std::move(mesh));
  }

  // Vertices that faces share become one a corner where faces have attributes of their own.
  void GiveCornersTheirOwn(Mesh& mesh) const {
    const Primitives& own = this->Primitives_;
    const std::size_t n = mesh.indices.size();
    const bool colors = own.colors.size() == n;
    const bool tcoords = own.tcoords.size() == n;
    if (n == 0 || (!colors && !tcoords)) {
      return;
    }
    Mesh made;
    made.primitive = mesh.primitive;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t v = mesh.indices[i];
      const auto take = [v](const auto& from, std::size_t width, auto& to) {
        if (!from.empty()) {
          to.insert(to.end(), from.begin() + std::ptrdiff_t(v * width),
                    from.begin() + std::ptrdiff_t((v + 1) * width));
        }
      };
      take(mesh.positions, 3, made.positions);
      take(mesh.normals, 3, made.normals);
      if (colors) {
        made.colors.insert(made.colors.end(), own.colors[i].begin(), own.colors[i].end());
      } else {
        take(mesh.colors, 4, made.colors);
      }
      if (tcoords) {
        made.tcoords.push_back(static_cast<float>(own.tcoords[i].x()));
        made.tcoords.push_back(static_cast<float>(own.tcoords[i].y()));
      } else {
        take(mesh.tcoords, 2, made.tcoords);
      }
      made.indices.push_back(static_cast<std::uint32_t>(i));
    }
    mesh = std::move(made);
  }

  // What the header's TextureFile names.
  void ReadTexture() {
    if (this->Header_.texture.empty()) {
      return;
    }
    try {
      this->Texture_ = ReadImage(ResolveReference(this->Path_, this->Header_.texture));
    } catch (const Error& e) {
      this->Warn("its texture is left out: " + std::string(e.what()));
    }
  }

  std::string Path_;
  ImportOptions Options_;
  std::string Bytes_;
  PlyHeader Header_;
  PlyValues Values_;
  Vertices Vertices_;
  bool HasVertices_ = false;
  Primitives Primitives_;
  std::shared_ptr<const Image> Texture_;
  std::vector<std::string> Warnings_;
  std::vector<double> Unused_;
};

} // namespace

Model ReadPly(const std::string& path, const ImportOptions& options) {
  return Reader(path, options).Run();
}

} // namespace dspace
