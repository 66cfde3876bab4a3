// The result of an importer: meshes, materials and a node tree, free of VTK and OpenGL.
#ifndef DSPACE_IMPORT_MODEL_H
#define DSPACE_IMPORT_MODEL_H

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace dspace {

// 8-bit image; row 0 is the top row, rows tightly packed, 1 to 4 channels (Y, YA, RGB, RGBA).
struct Image {
  std::string name; // file or "file#index" it came from, for messages and sharing
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<std::uint8_t> pixels;
};

// Metallic-roughness material (glTF 2.0, section 3.9); other formats are mapped to it.
// Colours are sRGB-encoded display values in [0, 1], as they are in VRML, OBJ and VTK; the glTF
// importer converts from linear.
struct Material {
  std::string name;
  std::array<double, 3> color = {0.8, 0.8, 0.8};
  double opacity = 1.0;
  double metallic = 0.0;
  double roughness = 0.8;
  std::array<double, 3> emissive = {0.0, 0.0, 0.0};
  std::shared_ptr<const Image> texture; // modulates colour (and opacity, with an alpha channel)
  bool repeatTexture = true;            // else clamped to the edge
  bool lit = true;
  bool doubleSided = true;
};

// Triangles, lines or points in the coordinates of the node that holds the mesh.
struct Mesh {
  enum class Primitive { Triangles, Lines, Points };
  std::string name;
  Primitive primitive = Primitive::Triangles;
  std::vector<float> positions;       // x y z a vertex [source units]; finite
  std::vector<float> normals;         // empty, or x y z a vertex, unit length
  std::vector<float> tcoords;         // empty, or u v a vertex; v = 0 is the image's BOTTOM row
  std::vector<std::uint8_t> colors;   // empty, or r g b a a vertex, sRGB; multiplies the material
  std::vector<std::uint32_t> indices; // 3, 2 or 1 a primitive; each < number of vertices
  int material = -1;                  // index into Model::materials, or -1 for the default
  bool solid = false; // bounds solids (IsSolid): back faces are drawn only from inside

  std::size_t VertexCount() const { return this->positions.size() / 3; }
  std::size_t PrimitiveCount() const {
    const std::size_t n = this->primitive == Primitive::Triangles ? 3
                          : this->primitive == Primitive::Lines   ? 2
                                                                  : 1;
    return this->indices.size() / n;
  }
};

// A node of the file's own hierarchy. A mesh may be named by several nodes (instances).
struct ModelNode {
  std::string name;
  int parent = -1;                                     // index of an earlier node, or -1 for a root
  Eigen::Affine3d local = Eigen::Affine3d::Identity(); // node to parent; any affine map
  std::vector<int> meshes;                             // indices into Model::meshes
};

// One imported file, unscaled and unrotated, in its own units and axes.
struct Model {
  std::string path;
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<ModelNode> nodes;      // parents come before children
  std::vector<std::string> warnings; // each names an omission or a repair and its place

  // Triangles over all nodes, instances counted each time.
  std::size_t TriangleCount() const;
  // Axis-aligned bounds over all nodes in file coordinates; empty when there are no vertices.
  Eigen::AlignedBox3d Bounds() const;
  // Node to file coordinates.
  Eigen::Affine3d NodeToModel(int node) const;
};

// Throws Error(Corrupt) naming `path` and the mesh when an index, vertex, node or material of the
// model is out of range or not finite. Every importer calls it before it returns.
void CheckModel(const Model& model);

} // namespace dspace

#endif
