// ReadObj: Wavefront OBJ, parsed by tinyobjloader after ObjText has checked it.
#include <dspace/import/files/Importers.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <unordered_map>

#include <tiny_obj_loader.h>

#include <dspace/Error.h>

#include <dspace/import/files/ImportFile.h>
#include <dspace/import/model/Polygon.h>
#include <dspace/import/obj/ObjMaterials.h>
#include <dspace/import/obj/ObjText.h>

namespace dspace {

namespace {

// Polygons with many corners take quadratic time to triangulate well; beyond this sum of squares
// over a file the rest become fans.
constexpr std::size_t TriangulationBudget = 400000000;

struct CornerHash {
  std::size_t operator()(const std::array<int, 3>& c) const {
    std::size_t h = 0;
    for (const int i : c) {
      h = (h ^ static_cast<std::size_t>(static_cast<unsigned>(i))) * 0x9e3779b97f4a7c15ull;
      h ^= h >> 32;
    }
    return h;
  }
};

// One mesh in the making: all sections of a group with one material and one kind of primitive.
struct Part {
  Mesh mesh;
  bool hasNormals = true; // every corner so far names one
  bool hasTcoords = false;
  std::unordered_map<std::array<int, 3>, std::uint32_t, CornerHash> vertices;
};

class ObjBuilder {
public:
  ObjBuilder(const ObjText& text, const ObjMaterials& materials, const tinyobj::attrib_t& attrib,
             std::vector<std::string>& warnings)
      : Text_(text), Materials_(materials), Attrib_(attrib), Warnings_(warnings) {}

  void Add(const tinyobj::shape_t& shape) {
    const ObjText::Section& section = this->Text_.sections.at(std::stoul(shape.name));
    std::size_t first = 0;
    for (const std::uint32_t corners : section.faceCorners) {
      if (first + corners > shape.mesh.indices.size()) {
        throw Error(Error::Kind::Internal, "OBJ section '" + section.name + "'",
                    "faces were lost in parsing");
      }
      this->AddFace(section, &shape.mesh.indices[first], corners);
      first += corners;
    }
    first = 0;
    for (const int corners : shape.lines.num_line_vertices) {
      Part& part = this->PartFor(section, Mesh::Primitive::Lines);
      for (std::size_t k = 1; k < static_cast<std::size_t>(corners); ++k) {
        this->AddCorner(part, shape.lines.indices[first + k - 1]);
        this->AddCorner(part, shape.lines.indices[first + k]);
      }
      first += static_cast<std::size_t>(corners);
    }
    for (const tinyobj::index_t& index : shape.points.indices) {
      this->AddCorner(this->PartFor(section, Mesh::Primitive::Points), index);
    }
  }

  // Every vertex as a point.
  void AddAllPoints() {
    Part& part = this->PartFor({}, Mesh::Primitive::Points);
    for (std::size_t i = 0; 3 * i < this->Attrib_.vertices.size(); ++i) {
      this->AddCorner(part, {static_cast<int>(i), -1, -1});
    }
  }

  // The meshes in the order in which their first faces stand in the file.
  std::vector<Mesh> Finish() {
    std::vector<Mesh> meshes;
    for (const auto& part : this->Parts_) {
      if (!part->hasNormals) {
        part->mesh.normals.clear();
      }
      if (!part->hasTcoords) {
        part->mesh.tcoords.clear();
      }
      meshes.push_back(std::move(part->mesh));
    }
    return meshes;
  }

private:
  int MaterialFor(const std::string& name) {
    const auto found = this->Materials_.byName.find(name);
    if (found != this->Materials_.byName.end()) {
      return found->second;
    }
    // Where a library is missing, that is the warning.
    if (!name.empty() && this->Materials_.complete && this->Unknown_.insert(name).second) {
      this->Warnings_.push_back("material '" + name + "' is in none of the material libraries");
    }
    return -1;
  }

  Part& PartFor(const ObjText::Section& section, Mesh::Primitive primitive) {
    auto& part = this->PartOf_[{section.name, section.material, primitive}];
    if (!part) {
      this->Parts_.push_back(std::make_unique<Part>());
      part = this->Parts_.back().get();
      part->mesh.name = section.name;
      part->mesh.primitive = primitive;
      part->mesh.material = this->MaterialFor(section.material);
    }
    return *part;
  }

  void AddFace(const ObjText::Section& section, const tinyobj::index_t* corners,
               std::size_t count) {
    Part& part = this->PartFor(section, Mesh::Primitive::Triangles);
    this->Polygon_.clear();
    for (std::size_t k = 0; k < count; ++k) {
      const float* p = &this->Attrib_.vertices[3 * std::size_t(corners[k].vertex_index)];
      this->Polygon_.emplace_back(p[0], p[1], p[2]);
    }
    this->Work_ += count > 4 ? count * count : 0;
    this->Triangles_.clear();
    TriangulatePolygon(this->Polygon_, count == 3 || this->Work_ > TriangulationBudget,
                       this->Triangles_);
    for (const std::array<int, 3>& triangle : this->Triangles_) {
      for (const int k : triangle) {
        this->AddCorner(part, corners[k]);
      }
    }
  }

  void AddCorner(Part& part, const tinyobj::index_t& corner) {
    Mesh& mesh = part.mesh;
    const auto [found, isNew] = part.vertices.emplace(
        std::array<int, 3>{corner.vertex_index, corner.texcoord_index, corner.normal_index},
        static_cast<std::uint32_t>(mesh.VertexCount()));
    mesh.indices.push_back(found->second);
    if (!isNew) {
      return;
    }
    const std::size_t v = static_cast<std::size_t>(corner.vertex_index);
    const auto append = [](std::vector<float>& to, const std::vector<float>& from, std::size_t n,
                           int index) {
      for (std::size_t k = 0; k < n; ++k) {
        to.push_back(index < 0 ? 0.0f : from[n * std::size_t(index) + k]);
      }
    };
    append(mesh.positions, this->Attrib_.vertices, 3, corner.vertex_index);
    append(mesh.normals, this->Attrib_.normals, 3, corner.normal_index);
    append(mesh.tcoords, this->Attrib_.texcoords, 2, corner.texcoord_index);
    part.hasNormals = part.hasNormals && corner.normal_index >= 0;
    part.hasTcoords = part.hasTcoords || corner.texcoord_index >= 0;
    if (mesh.material >= 0) {
      const ObjMaterials::Placement& place =
          this->Materials_.placements[std::size_t(mesh.material)];
      for (std::size_t k = 0; k < 2; ++k) {
        float& t = mesh.tcoords[mesh.tcoords.size() - 2 + k];
        t = static_cast<float>(t * place.scale[k] + place.offset[k]);
      }
    }
    for (std::size_t k = 0; !this->Attrib_.colors.empty() && k < 4; ++k) {
      const float c = k < 3 ? this->Attrib_.colors[3 * v + k] : 1.0f;
      mesh.colors.push_back(
          static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(c, 0.0f, 1.0f))));
    }
  }

  const ObjText& Text_;
  const ObjMaterials& Materials_;
  const tinyobj::attrib_t& Attrib_;
  std::vector<std::string>& Warnings_;
  std::vector<std::unique_ptr<Part>> Parts_;
  std::map<std::tuple<std::string, std::string, Mesh::Primitive>, Part*> PartOf_;
  std::set<std::string> Unknown_;
  std::vector<Eigen::Vector3d> Polygon_;
  std::vector<std::array<int, 3>> Triangles_;
  std::size_t Work_ = 0;
};

// Puts back, for RepairMesh to find, what tinyobjloader does not read.
void MarkBad(const std::vector<std::size_t>& bad, std::size_t width, std::vector<float>& values) {
  for (const std::size_t i : bad) {
    if ((i + 1) * width <= values.size()) {
      values[i * width] = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

} // namespace

Model ReadObj(const std::string& path, const ImportOptions& options) {
  Model model;
  model.path = path;
  ObjText text = CheckObjText(path, ReadFileText(path), options.maximumTriangles);
  if (text.sections.empty() && text.vertices == 0) {
    throw Error(Error::Kind::Corrupt, FileObject(path), "has no vertices and no faces");
  }
  model.warnings = text.warnings;
  const ObjMaterials materials = ReadObjMaterials(path, text.libraries, model.warnings);

  tinyobj::attrib_t attrib;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> unused;
  std::string warning, error;
  std::istringstream in(text.text);
  text.text = std::string();
  if (!tinyobj::LoadObj(&attrib, &shapes, &unused, &warning, &error, &in, nullptr, false, false)) {
    throw Error(Error::Kind::Corrupt, FileObject(path), "cannot be parsed: " + error);
  }
  MarkBad(text.badVertices, 3, attrib.vertices);
  MarkBad(text.badTcoords, 2, attrib.texcoords);
  MarkBad(text.badNormals, 3, attrib.normals);
  ObjBuilder builder(text, materials, attrib, model.warnings);
  for (const tinyobj::shape_t& shape : shapes) {
    builder.Add(shape);
  }
  if (text.sections.empty()) { // ReadModel rejects them unless a point cloud is asked for
    builder.AddAllPoints();
  }
  model.meshes = builder.Finish();
  model.materials = materials.materials;
  ModelNode node;
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    node.meshes.push_back(static_cast<int>(i));
  }
  model.nodes.push_back(std::move(node));
  return model;
}

} // namespace dspace
