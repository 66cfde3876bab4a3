#include <dspace/commands/measure/MeasuredScene.h>

#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

constexpr double MostHeight = 1e12; // [m] of a site

double LinearOf(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

// Of the part's material with what the object overrides.
double AlbedoOf(const GraphicsObject& object, const Part& part) {
  const std::array<double, 3>* color = part.material ? &part.material->color : nullptr;
  if (object.material.color) {
    color = &*object.material.color;
  }
  const auto over = object.parts.find(part.name);
  if (over != object.parts.end() && over->second.material.color) {
    color = &*over->second.material.color;
  }
  static const Material standard;
  const auto& [r, g, b] = color ? *color : standard.color;
  return (LinearOf(r) + LinearOf(g) + LinearOf(b)) / 3.0;
}

} // namespace

Methods MethodsOf(const v1::Measuring& measuring, const std::string& command) {
  switch (measuring.method()) {
  case v1::Measuring::EXACT:
    return {true, false};
  case v1::Measuring::IMAGE:
    return {false, true};
  case v1::Measuring::BOTH:
    return {true, true};
  default:
    Reject(command, "the method is " + std::to_string(int(measuring.method())) +
                        "; accepted: EXACT (0), IMAGE (1), BOTH (2)");
  }
}

MeasuredScene::MeasuredScene(const Context& context, const v1::Measuring& measuring,
                             const google::protobuf::RepeatedField<std::uint32_t>& without,
                             const std::string& command, RayTrees* trees)
    : Context_(context),
      Deadline_(measuring.has_deadline_s() ? std::optional<double>(measuring.deadline_s())
                                           : std::nullopt,
                command, "fewer lines or azimuths"),
      Wait_(measuring.has_wait_s() ? std::optional<double>(measuring.wait_s()) : std::nullopt) {
  Scene& scene = context.GetScene();
  std::set<std::string> hidden;
  for (const std::string& name : measuring.hidden_fragment()) {
    hidden.insert(scene.Fragments().Get(name).name);
  }
  std::set<ObjectId> left;
  for (const ObjectId id : without) {
    left.insert(scene.Object(id).id);
  }
  if (measuring.has_deadline_s()) {
    this->Obstacles_.SetCheck([deadline = this->Deadline_] { deadline.Check(); });
  }
  if (trees) {
    trees->Begin();
  }
  for (const auto& [id, object] : scene.Objects()) {
    const bool counts = object.nature == Nature::Physical && object.visible &&
                        scene.Fragments().Get(object.fragment).visible &&
                        hidden.count(object.fragment) == 0 && left.count(id) == 0;
    if (!counts) {
      continue;
    }
    if (const TerrainObject* terrain = context.scene->TerrainOf(id)) {
      if (!measuring.no_terrain()) {
        this->Ids_.insert(id);
        this->Obstacles_.Add(Obstacles::Ground{terrain->Name(), terrain->HeldSurface(),
                                               context.Frames().WorldPose(object.frame), id});
      }
    } else if (!measuring.no_objects()) {
      this->AddObject(context, object, trees);
    }
  }
}

void MeasuredScene::Measure(Measurement measure) const {
  this->Context_.state.works->Run(this->Context_.reply,
                                  {this->Wait_, this->Deadline_, this->Context_.scene->sky.kernels},
                                  [obstacles = this->Obstacles_, measure = std::move(measure)](
                                      v1::Reply& reply, const Works::Proceed& proceed) {
                                    Obstacles own = obstacles;
                                    own.SetCheck([&] { proceed(0.0); });
                                    measure(own, reply, proceed);
                                  });
}

std::vector<MeasuredScene::ShownPart>
MeasuredScene::PartsOf(const Context& context, const GraphicsObject& object, bool* any) {
  const Pose& X_RF = context.Frames().WorldPose(object.frame);
  Eigen::Affine3d X_RO = Eigen::Affine3d::Identity();
  X_RO.matrix() = X_RF.Matrix();
  X_RO = X_RO * object.X_FO;
  std::vector<ShownPart> parts;
  static const std::vector<Part> none;
  for (const Part& part : object.levels.empty() ? none : object.levels.front().parts) {
    const auto over = object.parts.find(part.name);
    const bool shown = over == object.parts.end() || over->second.visible;
    const bool finest = !part.range || part.range->from <= 0.0;
    if (!part.mesh || part.mesh->primitive != Mesh::Primitive::Triangles ||
        part.mesh->indices.empty()) {
      continue;
    }
    if (any) {
      *any = true;
    }
    if (shown && finest && !object.billboard) {
      parts.push_back({part.name, part.mesh, X_RO * part.X_OP, AlbedoOf(object, part)});
    }
  }
  return parts;
}

void MeasuredScene::AddObject(const Context& context, const GraphicsObject& object,
                              RayTrees* trees) {
  bool any = false;
  for (const ShownPart& part : PartsOf(context, object, &any)) {
    this->Ids_.insert(object.id);
    this->Obstacles_.Add(object.id,
                         trees ? trees->Of(part.mesh) : std::make_shared<const MeshRays>(part.mesh),
                         part.X_RM, part.albedo);
  }
  if (!any && !(object.custom && object.custom->IsBackdrop())) {
    context.reply.add_warning("object '" + object.name +
                              "': it has no triangles, so it is no obstacle");
  }
}

MeasuredScene::Spot MeasuredScene::At(const v1::Place& place, const std::string& what) const {
  Spot spot;
  spot.frame = ToFrame(place.frame());
  const Pose& X_RF = this->Context_.Frames().WorldPose(spot.frame);
  const Eigen::Vector3d p_F = ToVector(place.position());
  spot.label =
      what + ", " + VectorText(p_F) + " in " +
      (spot.frame == RootFrame ? std::string("the root")
                               : "frame '" + this->Context_.Frames().Path(spot.frame) + "'");
  RequirePosition(spot.label, "its position", p_F);
  spot.p_R = X_RF.Apply(p_F);
  return spot;
}

MeasuredScene::Spot MeasuredScene::At(const v1::Site& site, const std::string& what) const {
  const auto found = this->Context_.scene->terrains.find(site.terrain());
  if (found == this->Context_.scene->terrains.end()) {
    throw Error(Error::Kind::NotFound, "terrain '" + site.terrain() + "'",
                "there is no such terrain in scene '" + this->Context_.sceneName + "'");
  }
  Spot spot;
  spot.terrain = found->second.get();
  spot.label = what + ", site (" + NumberText(site.map_x()) + ", " + NumberText(site.map_y()) +
               ") of terrain '" + site.terrain() + "'";
  const TerrainSurface& surface = spot.terrain->Surface();
  const Eigen::Vector2d map(site.map_x(), site.map_y());
  Require(site.height() >= 0.0 && site.height() <= MostHeight, spot.label,
          "its height above the ground", site.height(), "0 to 1e12 m");
  if (!map.allFinite()) {
    Reject(spot.label, "its map coordinates are not finite; accepted: numbers on the data");
  }
  const SurfaceSample sample = surface.SampleMap(map);
  if (!sample.valid) {
    const Eigen::AlignedBox2d& data = surface.GetBounds().map;
    const bool outside = !data.isEmpty() && !data.contains(map);
    Reject(spot.label,
           std::string(outside ? "it is off the terrain's data" : "the terrain has no data there") +
               "; accepted: map x " + NumberText(data.min().x()) + " to " +
               NumberText(data.max().x()) + ", y " + NumberText(data.min().y()) + " to " +
               NumberText(data.max().y()) + ", where there is data");
  }
  const FrameId frame = this->Context_.GetScene().Object(spot.terrain->Object()).frame;
  const Pose& X_RS = this->Context_.Frames().WorldPose(frame);
  spot.p_R =
      X_RS.Apply(sample.position_S + site.height() / X_RS.scale * surface.Up(sample.position_S));
  return spot;
}

std::pair<const TerrainSurface*, Pose> MeasuredScene::GroundOf(const Spot& spot) const {
  if (spot.terrain) {
    const FrameId frame = this->Context_.GetScene().Object(spot.terrain->Object()).frame;
    return {&spot.terrain->Surface(), this->Context_.Frames().WorldPose(frame)};
  }
  for (const Obstacles::Ground& ground : this->Obstacles_.Grounds()) {
    if (ground.surface->Sample(ground.X_RS.Inverse().Apply(spot.p_R)).valid) {
      return {ground.surface.get(), ground.X_RS};
    }
  }
  return {nullptr, Pose()};
}

LevelAxes MeasuredScene::AxesAt(const Spot& spot) const {
  const auto [surface, X_RS] = this->GroundOf(spot);
  if (!surface) {
    const Eigen::Quaterniond& q_RF = this->Context_.Frames().WorldPose(spot.frame).rotation;
    return {q_RF * Eigen::Vector3d::UnitX(), q_RF * Eigen::Vector3d::UnitY(),
            q_RF * Eigen::Vector3d::UnitZ()};
  }
  const Eigen::Vector3d p_S = X_RS.Inverse().Apply(spot.p_R);
  LevelAxes axes;
  axes.up = X_RS.rotation * surface->Up(p_S);
  axes.north = X_RS.rotation * surface->North(p_S);
  axes.north = (axes.north - axes.north.dot(axes.up) * axes.up).normalized();
  axes.east = axes.north.cross(axes.up);
  return axes;
}

std::optional<double> MeasuredScene::NorthAt(const Spot& spot) const {
  const auto [surface, X_RS] = this->GroundOf(spot);
  if (!surface) {
    return {};
  }
  const Eigen::Vector3d p_S = X_RS.Inverse().Apply(spot.p_R);
  const Eigen::Vector3d map = surface->SceneToMap(p_S);
  try {
    Eigen::Vector3d place = surface->MapToGeographic(map);
    // A step along the meridian, away from the nearer pole.
    constexpr double Step = 1e-4; // [deg]
    const double step = place.y() > 0.0 ? -Step : Step;
    place.y() += step;
    const Eigen::Vector3d moved_S = surface->MapToScene(surface->GeographicToMap(place));
    const Eigen::Vector3d north = surface->North(p_S);
    const Eigen::Vector3d east = north.cross(surface->Up(p_S));
    const Eigen::Vector3d meridian = (moved_S - p_S) / step;
    // The meridian's azimuth in the axes, with the other sign.
    return -std::atan2(meridian.dot(east), meridian.dot(north)) * 180.0 / M_PI;
  } catch (const Error& error) {
    if (error.GetKind() != Error::Kind::Unsupported &&
        error.GetKind() != Error::Kind::InvalidArgument) {
      throw;
    }
    return {}; // no longitudes and latitudes there
  }
}

} // namespace dspace::session
