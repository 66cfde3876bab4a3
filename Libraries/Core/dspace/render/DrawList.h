// A scene as one camera sees it: which meshes, where, in which colours. No OpenGL.
#ifndef DSPACE_RENDER_DRAW_LIST_H
#define DSPACE_RENDER_DRAW_LIST_H

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include <dspace/render/shadows/CasterTiles.h>
#include <dspace/scene/LinearLight.h>
#include <dspace/scene/Scene.h>
#include <dspace/scene/ViewLook.h>

namespace dspace {

class CelestialBody;

// One instance of a mesh, as the vertex shader reads it (GpuStore declares the layout to OpenGL).
// Floats are relative to the camera: rounded after the subtraction in double precision.
struct DrawInstance {
  std::array<float, 12> viewFromMesh; // three rows of four; OpenGL's view axes
  std::array<float, 4> color;         // linear light, and opacity
  float metallic;
  float roughness;
  std::uint32_t label;
  float mirrored;                // -1 where viewFromMesh mirrors, else 1
  std::array<float, 3> emissive; // linear light
  float unused;
};
static_assert(sizeof(DrawInstance) == 96, "tightly packed");

// Instances that one call draws: consecutive ones of the same mesh and state.
struct DrawBatch {
  std::shared_ptr<const Mesh> mesh;
  std::shared_ptr<const Image> texture;
  std::shared_ptr<const Image> normalTexture;
  double normalScale = 1.0;
  std::shared_ptr<const ShaderCode> shader;
  bool repeatTexture = true;
  bool lit = true;
  bool emissive = false;
  bool specular = true;    // false: no metal and of roughness 1, hence Lambertian
  Reflectance reflectance; // of what is lit
  bool wireframe = false;
  bool billboard = false;
  bool translucent = false;
  bool solid = false;    // only front faces are seen: opaque solids, the camera outside them
  bool mirrored = false; // of solid ones: their front faces are wound clockwise
  float lineWidth = 1.0f;
  float pointSize = 1.0f;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

struct DrawLight {
  Light::Kind kind;
  std::array<float, 3> color;     // linear light, times intensity
  std::array<float, 3> direction; // view axes, unit, the way the light travels
  std::array<float, 3> position;  // view axes [m]
  std::array<float, 3> attenuation;
  float cosCone;
  bool sun;     // IsSun(); it stands first
  float radius; // of its disc [rad]
};

// One object that draws itself (CustomDrawer.h).
struct DrawCustom {
  const GraphicsObject* object = nullptr; // of the scene, as it was when the list was built
  Eigen::Affine3d X_VO = Eigen::Affine3d::Identity(); // OpenGL's view axes from the object's frame
  const GraphicsObject* body = nullptr; // of terrain: the body whose ground it is (BodyShape)
  bool covered = false;                 // of a body: its ground is drawn in place of its surface
};

// A body of the scene (scene/bodies) as the camera sees it, whether it is drawn or not.
struct DrawBody {
  const GraphicsObject* object = nullptr;
  const CelestialBody* body = nullptr;
  Eigen::Vector3d center = Eigen::Vector3d::Zero(); // view axes [m]
  // From view axes to axes in which it is a unit sphere about the origin [1/m].
  Eigen::Matrix3d unit = Eigen::Matrix3d::Identity();
  double radius = 0.0; // the largest [m]
};

// Selects the part of a scene that is drawn.
struct DrawFilter {
  bool physicalOnly = false;
  bool pickableOnly = false;
  std::set<std::string> hiddenFragments;
  // Labels are the numbers of this object's parts, from 1 on through all its levels; other meshes
  // are labelled 0 and hide what is behind them. 0: labels are objects.
  ObjectId partsOf = 0;
  // What throws shadows: neither ornaments, nor billboards, lines, points and what is translucent.
  bool castersOnly = false;

  bool Shows(const Membership& member) const {
    return this->hiddenFragments.count(member.fragment) == 0 &&
           !(this->physicalOnly && member.nature == Nature::Ornamental);
  }
};

// Terrain that finds its own shadows without maps (CustomDrawer::ShadowsItself), whose shadows all
// else takes from one layer of maps of ground.
struct ShadowGround {
  static constexpr std::size_t Most = 3; // layers; further terrain is in the last one
  std::vector<ObjectId> objects;         // one, but in the last layer
  std::vector<CasterTiles> tiles;        // one a cascade
};

// The view of one camera, ready for OpenGL.
struct DrawView {
  CameraPose camera;
  Projection projection;
  int width = 0;
  int height = 0;
  int samples = 1;      // supersampling: `width` and `height` count samples, sizes in pixels do not
  std::string viewport; // its name: custom geometry may have settings for each viewport
  // True for a picture that is saved or measured: custom geometry waits for all of its data. False
  // for an interactive one, which shows what is loaded.
  bool complete = false;
  bool normals = false; // pictures of angles show normals in view coordinates in their place
  ViewLook look;
  // The factor on linear light, where it is known before the picture is drawn and the lights do not
  // have it (ExposedByLights).
  std::optional<double> exposure;
  // Clip from view coordinates in place of the projection's, for pictures that a light sees: levels
  // and poses remain those of the camera.
  std::optional<Eigen::Matrix4d> clip;
  // [m] with `clip`: a pixel of that picture, where ground may be as coarse; or 0.
  double texel = 0.0;
  // With `clip`: which parts of ground the picture needs; empty: all.
  std::function<bool(const LightHull&)> takes;
  std::optional<CascadeFit> shadows; // of the Sun's maps, where they are drawn
  std::shared_ptr<const std::vector<CasterTiles>> shadowTiles; // of all but ground, with `shadows`
  std::shared_ptr<const std::vector<ShadowGround>> shadowGrounds; // layer by layer, with `shadows`

  Eigen::Matrix4d ClipFromView() const {
    return this->clip ? *this->clip : this->projection.ClipFromView(this->width, this->height);
  }
};

// One instance per viewport, reused for each picture. Data that depends only on the content of the
// scene is computed once.
class DrawList {
public:
  // Rebuilds the list for `view`. Objects outside the view's frustum are omitted. Sets the near and
  // far distances that the view's projection leaves to what is drawn (Projection::Seeing).
  void Build(const Scene& scene, DrawView& view, const DrawFilter& filter);

  // Removes the instances that `kept` refuses, until the next Build().
  void Keep(const std::function<bool(const DrawBatch&, const DrawInstance&)>& kept);

  const std::vector<DrawInstance>& Instances() const { return this->Instances_; }
  const std::vector<DrawBatch>& Batches() const { return this->Batches_; } // opaque ones first
  const std::vector<DrawCustom>& Customs() const { return this->Customs_; }
  const std::vector<DrawCustom>& Backdrops() const { return this->Backdrops_; }
  const std::vector<DrawLight>& Lights() const { return this->Lights_; }
  const std::optional<SunPlace>& Sun() const { return this->Sun_; }
  // The body that is the Sun: the light "sun" then comes from it, and its intensity is that at 1
  // au.
  const std::optional<DrawBody>& SunBody() const { return this->SunBody_; }
  // The visible bodies that hide the Sun from other things, those that look largest first; none
  // without SunBody(). Fragments that a view hides count.
  const std::vector<DrawBody>& Eclipsing() const { return this->Eclipsing_; }
  // Depths [m] along the view's axis of the seen meshes' bounding spheres. Spheres around the
  // camera begin at 0. Nothing is seen: nearest > farthest.
  double NearestDepth() const { return this->NearestDepth_; }
  double FarthestDepth() const { return this->FarthestDepth_; }
  // The highest point towards the Sun of all bounding spheres of the list, from the camera [m].
  double HighestToSun() const;
  // Of the last Build(); its hidden fragments are all that are not drawn, for whatever reason.
  const DrawFilter& Filter() const { return this->Filter_; }
  std::optional<Eigen::Vector3f> TowardsSun() const; // view axes, unit; none without a Sun
  std::array<float, 3> Ambient() const { return this->Ambient_; } // linear light
  std::size_t TriangleCount() const { return this->Triangles_; }
  std::size_t CulledObjects() const { return this->Culled_; }

private:
  struct FlatPart { // a part of a level of an object, with all that does not depend on the view
    std::uint32_t number; // of the object's parts, from 1 on through all levels
    std::uint32_t batch;
    std::uint32_t nearBatch; // where the near plane may open a solid: both sides are drawn
    Eigen::Affine3d X_FP;
    std::optional<DistanceRange> range; // in F
    DrawInstance instance;              // without viewFromMesh
  };
  struct FlatLevel {
    std::vector<FlatPart> parts;
    BoundingSphere bounds; // in the object's frame F
  };
  struct FlatObject {
    const GraphicsObject* object;
    std::vector<FlatLevel> levels;
    const CelestialBody* body = nullptr; // of its geometry
  };
  // An object of the filter whose bounds reach between the view's sides.
  struct SeenObject {
    const FlatObject* flat;
    Eigen::Affine3d X_VF;
    Eigen::Vector3d center; // of its bounds, in view axes [m]
    double radius;
  };
  void Flatten(const Scene& scene);
  void FindSeen(const Scene& scene, const DrawView& view, const DrawFilter& filter);
  void PlaceBodies(const Scene& scene, const Pose& X_CA);
  void FindGrounds(const DrawView& view);
  void FindDepths();
  void SetDepths(DrawView& view) const;
  // Finds what labels name: of each frame with a billboard, but the root, the seen objects on it
  // and on the frames below it.
  void FindNamed(const FrameTree& frames);
  // How far what a label names reaches from it [m]. Objects farther from the label than three times
  // their radius do not count.
  double OwnReach(const SeenObject& label) const;
  std::uint32_t BatchOf(const GraphicsObject& object, const Part& part, const Material& material,
                        const DrawInstance& look, bool near);
  // `fill`: ViewLook::fill.
  void PlaceLights(const Scene& scene, const Eigen::Quaterniond& q_VA, const Pose& X_CA,
                   double fill);
  void ExposeLights(float exposure); // multiplies all of them

  const Scene* Scene_ = nullptr;
  DrawFilter Filter_;
  std::uint64_t ContentRevision_ = 0;
  std::vector<FlatObject> Objects_;
  std::vector<DrawBatch> Templates_;
  std::unordered_map<std::string, std::uint32_t> BatchIndex_;
  std::vector<std::vector<DrawInstance>> Pending_; // instances of each template

  std::vector<Pose> X_AF_;
  std::vector<SeenObject> Seen_;
  std::unordered_map<ObjectId, const GraphicsObject*>
      Bodies_;                  // by the terrain that is their ground
  std::set<ObjectId> Covered_;  // seen bodies whose ground is drawn
  std::set<ObjectId> TooSmall_; // grounds whose body is drawn
  std::unordered_map<FrameId, std::vector<const SeenObject*>> Named_; // into Seen_
  std::vector<DrawInstance> Instances_;
  std::vector<DrawBatch> Batches_;
  std::vector<DrawCustom> Customs_;
  std::vector<DrawCustom> Backdrops_; // CustomGeometry::IsBackdrop()
  std::vector<DrawLight> Lights_;
  std::optional<SunPlace> Sun_;
  std::optional<DrawBody> SunBody_;
  std::vector<DrawBody> Eclipsing_;
  double NearestDepth_ = 0.0;
  double FarthestDepth_ = 0.0;
  std::array<float, 3> Ambient_ = {0, 0, 0};
  std::size_t Triangles_ = 0;
  std::size_t Culled_ = 0;
};

} // namespace dspace

#endif
