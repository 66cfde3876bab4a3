#include <dspace/commands/viewports/SceneGround.h>

#include <algorithm>

namespace dspace::session {
namespace {

constexpr double LevelReach = 0.25; // radii of the body above its ground

} // namespace

SceneGround::SceneGround(const SceneState& scene, FrameId F) {
  for (const auto& [name, terrain] : scene.terrains) {
    const GraphicsObject& object = scene.scene->Object(terrain->Object());
    if (object.visible) {
      this->Grounds_.push_back({&terrain->Surface(),
                                scene.scene->Frames().RelativePose(F, object.frame),
                                terrain->OnBody()});
    }
  }
}

std::optional<SceneGround::Found> SceneGround::Find(const Eigen::Vector3d& p_F) const {
  std::optional<Found> best;
  double least = 0.0;
  for (const Ground& ground : this->Grounds_) {
    const Eigen::Vector3d p_S = ground.X_FS.Inverse().Apply(p_F);
    const SurfaceSample sample = ground.surface->Sample(p_S);
    if (!sample.valid) {
      continue;
    }
    const Eigen::Vector3d up_F = ground.X_FS.rotation * ground.surface->Up(p_S);
    const Eigen::Vector3d position_F = ground.X_FS.Apply(sample.position_S);
    const double height = (p_F - position_F).dot(up_F);
    if (!best || height < least) {
      best = Found{&ground, position_F, up_F, sample.position_S.norm() * ground.X_FS.scale};
      least = height;
    }
  }
  return best;
}

// Where there are no data: the vertical of a terrain, rather of one on a body, whose radius is
// roughly that of the data.
std::optional<SceneGround::Found> SceneGround::Assume(const Eigen::Vector3d& p_F) const {
  const Ground* ground = nullptr;
  for (const Ground& each : this->Grounds_) {
    if (!ground || (each.onBody && !ground->onBody)) {
      ground = &each;
    }
  }
  if (!ground) {
    return std::nullopt;
  }
  const auto box = ground->surface->GetBounds().scene;
  const double radius =
      box.isEmpty() ? 0.0 : std::max(0.5 * box.sizes().maxCoeff(), box.center().norm());
  const Eigen::Vector3d up_S = ground->surface->Up(ground->X_FS.Inverse().Apply(p_F));
  return Found{ground, ground->X_FS.Apply(radius * up_S), ground->X_FS.rotation * up_S,
               radius * ground->X_FS.scale};
}

std::optional<Eigen::Vector3d> SceneGround::Up(const Eigen::Vector3d& p_F) const {
  std::optional<Found> found = this->Find(p_F);
  if (!found) {
    found = this->Assume(p_F);
  }
  if (!found) {
    return std::nullopt;
  }
  if (!found->ground->onBody || !(found->radius > 0.0)) {
    return found->up_F;
  }
  const double height = (p_F - found->position_F).dot(found->up_F) / found->radius;
  if (height >= 1.0) {
    return std::nullopt;
  }
  const double away = std::clamp((height - LevelReach) / (1.0 - LevelReach), 0.0, 1.0);
  const Eigen::Vector3d up = (1.0 - away) * found->up_F + away * Eigen::Vector3d::UnitZ();
  return up.norm() > 1e-3 ? std::optional<Eigen::Vector3d>(up.normalized()) : std::nullopt;
}

std::optional<Eigen::Vector3d> SceneGround::Below(const Eigen::Vector3d& p_F) const {
  const std::optional<Found> found = this->Find(p_F);
  return found ? std::optional<Eigen::Vector3d>(found->position_F) : std::nullopt;
}

} // namespace dspace::session
