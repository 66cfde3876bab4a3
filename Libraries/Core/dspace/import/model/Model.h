// The result of an importer: meshes, materials and a node tree, free of VTK and OpenGL.
#ifndef DSPACE_IMPORT_MODEL_H
#define DSPACE_IMPORT_MODEL_H

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/import/model/Reflectance.h>

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
  // Tangent space: 0.5 + 0.5 n, X along u, Y along v. With four channels in the mesh's own axes,
  // for what replaces its normals: opacity times n (128 is 0, 255 is 1), opacity.
  std::shared_ptr<const Image> normalTexture;
  double normalScale = 1.0;  // multiplies X and Y of normals in tangent space
  bool repeatTexture = true; // else clamped to the edge
  bool lit = true;
  Reflectance reflectance; // no file has another than metallic-roughness
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

// A part is drawn while the distance from the camera to `center` is in [from, to).
struct DistanceRange {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double from = 0.0;
  double to = std::numeric_limits<double>::infinity();
};

// A node of the file's own hierarchy. A mesh may be named by several nodes (instances).
struct ModelNode {
  std::string name;
  int parent = -1;                                     // index of an earlier node, or -1 for a root
  Eigen::Affine3d local = Eigen::Affine3d::Identity(); // node to parent; any affine map
  std::vector<int> meshes;                             // indices into Model::meshes
  // Of the node and its descendants, in the node's coordinates; absent: drawn at all distances.
  std::optional<DistanceRange> range;
};

// A light of the file (glTF: KHR_lights_punctual).
struct ModelLight {
  enum class Kind { Directional, Point, Spot };
  std::string name;
  Kind kind = Kind::Directional;
  int node = -1; // it shines along the node's -Z, from the node's origin
  std::array<double, 3> color = {1.0, 1.0, 1.0}; // linear light
  double intensity = 1.0;                        // lux, or candela
  double cone_deg = 45.0;                        // half angle, Spot
};

// Key frames of one property of one node.
struct ModelChannel {
  enum class Property { Translation, Rotation, Scale };
  enum class Interpolation { Step, Linear, CubicSpline };
  int node = -1;
  Property property = Property::Translation;
  Interpolation interpolation = Interpolation::Linear;
  std::vector<double> time_s; // ascending
  // 3 numbers a key (Rotation: 4, x y z w); CubicSpline: in-tangent, value, out-tangent of each.
  std::vector<double> value;
};

struct ModelAnimation {
  std::string name;
  std::vector<ModelChannel> channels;
};

// One imported file, unscaled and unrotated, in its own units and axes.
struct Model {
  std::string path;
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<ModelNode> nodes; // parents come before children
  std::vector<ModelLight> lights;
  std::vector<ModelAnimation> animations;
  std::vector<std::string> warnings; // each names an omission or a repair and its place
  // What the file has and Model cannot hold: "2 cameras", "Background", "morph targets of 3
  // meshes".
  std::vector<std::string> leftOut;

  // Triangles over all nodes, instances counted each time.
  std::size_t TriangleCount() const;
  // Axis-aligned bounds over all nodes in file coordinates; empty when there are no vertices.
  Eigen::AlignedBox3d Bounds() const;
  // Node to file coordinates.
  Eigen::Affine3d NodeToModel(int node) const;
};

// One sentence that lists Model::leftOut, and the lights and animations unless they are used; empty
// where nothing is left out.
std::string LeftOutWarning(const Model& model, bool usesLights, bool usesAnimations);

// The local transforms of all nodes at a time of an animation: ModelNode::local where it has no
// channel. Before the first key of a channel and after its last, that key holds; rotations are
// interpolated on the sphere (glTF 2.0, section 3.11 and appendix C).
std::vector<Eigen::Affine3d> PoseModel(const Model& model, const ModelAnimation& animation,
                                       double time_s);
// The time of its last key [s].
double DurationOf(const ModelAnimation& animation);

// Throws Error(Corrupt) naming `path` and the mesh when an index, vertex, node or material of the
// model is out of range or not finite. Every importer calls it before it returns.
void CheckModel(const Model& model);

} // namespace dspace

#endif
