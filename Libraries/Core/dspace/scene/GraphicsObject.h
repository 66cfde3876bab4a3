// Geometry attached to a frame.
#ifndef DSPACE_SCENE_GRAPHICS_OBJECT_H
#define DSPACE_SCENE_GRAPHICS_OBJECT_H

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <dspace/FrameTree.h>
#include <dspace/import/model/Model.h>
#include <dspace/scene/CustomGeometry.h>
#include <dspace/scene/Membership.h>
#include <dspace/scene/ShaderCode.h>

namespace dspace {

using ObjectId = std::uint32_t; // 0 means none; never reused within a scene

// One mesh with its material, placed in the object's frame O. The mesh is shared: all parts
// with the same Mesh use the same GPU buffers. A mesh must not change after a scene has it.
struct Part {
  std::shared_ptr<const Mesh> mesh;
  std::shared_ptr<const Material> material; // null: Material's defaults (the scene fills them in)
  Eigen::Affine3d X_OP = Eigen::Affine3d::Identity();
  std::string name = {}; // as in the file; several parts may share one; may be empty
  std::optional<DistanceRange> range = {}; // in O
};

// Sphere about the centre of the axis-aligned bounds of a level's vertices, in O; radius 0 at the
// origin when it has none. What culling and levels use.
struct BoundingSphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

struct DetailLevel {
  std::vector<Part> parts;
  double minimumPixels = 0.0; // drawn while the object's projected diameter is at least this
  // Computed by the scene when the level is added, in O.
  BoundingSphere sphere = {};
  Eigen::AlignedBox3d box = {};
};

// Overrides the material of every part. Fields that are not set keep the imported value.
struct MaterialOverride {
  std::optional<std::array<double, 3>> color;          // sRGB, 0 to 1
  std::optional<double> opacity;                       // 0 to 1
  std::optional<double> metallic;                      // 0 to 1
  std::optional<double> roughness;                     // 0 to 1
  std::optional<std::shared_ptr<const Image>> texture; // set to null: no texture
  std::optional<bool> lit;
  std::optional<bool> wireframe;
  std::optional<std::array<double, 3>> emissive; // sRGB, 0 to 1
  std::optional<Reflectance> reflectance;        // whole

  bool operator==(const MaterialOverride& o) const {
    return this->color == o.color && this->opacity == o.opacity && this->metallic == o.metallic &&
           this->roughness == o.roughness && this->texture == o.texture && this->lit == o.lit &&
           this->wireframe == o.wireframe && this->emissive == o.emissive &&
           this->reflectance == o.reflectance;
  }
  bool operator!=(const MaterialOverride& o) const { return !(*this == o); }

  // Throws Error(InvalidArgument) naming `object` and the value.
  void Check(const std::string& object) const;
};

// Overrides of the parts of one name. The material overrides that of the object.
struct PartOverride {
  MaterialOverride material;
  bool visible = true;
};

struct GraphicsObject {
  ObjectId id = 0;
  std::string name; // unique in the scene
  FrameId frame = 1;
  Nature nature = Nature::Physical;
  std::string fragment; // of the same nature
  Eigen::Affine3d X_FO =
      Eigen::Affine3d::Identity();              // within 1e18 m; axes stretched by 1e-12 to 1e12
  std::vector<DetailLevel> levels;              // finest first, minimumPixels descending
  std::shared_ptr<const CustomGeometry> custom; // drawn instead of levels, of which there are none
  MaterialOverride material;
  std::map<std::string, PartOverride> parts; // by the name of a part of some level
  std::shared_ptr<const ShaderCode> shader;  // null: the surface shader as it is
  bool visible = true;
  bool pickable = true;
  // Mesh coordinates are pixels in the image plane (X right, Y up) about the object's origin:
  // text and markers of constant size that face the camera.
  bool billboard = false;
  double lineWidth = 1.0; // pixels, lines
  double pointSize = 3.0; // pixels, points
};

// From the vertices of its parts, in O.
BoundingSphere BoundsOf(const DetailLevel& level);
Eigen::AlignedBox3d BoxOf(const DetailLevel& level); // empty without vertices

// Index of the level to draw at a projected diameter of `pixels`: the finest whose minimumPixels is
// no more than that; -1 when there is none.
int LevelFor(const std::vector<DetailLevel>& levels, double pixels);

// The parts of an imported model, sharing its meshes: `model` is kept alive by them.
// `scale` multiplies coordinates; `rotation` turns the file's axes into the frame's.
// Throws Error(InvalidArgument) naming the file: no model, a scale not of 1e-12 to 1e12 (or the
// negative of it), rotation not unit within 1e-6.
std::vector<Part> PartsOf(const std::shared_ptr<const Model>& model, double scale = 1.0,
                          const Eigen::Quaterniond& rotation = Eigen::Quaterniond::Identity());

// Check that nothing that is drawn can be out of range. Throw Error(InvalidArgument) naming
// `object` and the value. A mesh may be empty (a trail before its first line).
void CheckMesh(const Mesh& mesh, const std::string& object);
void CheckMaterial(const Material& material, const std::string& object);

} // namespace dspace

#endif
