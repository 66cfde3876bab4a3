#include <dspace/scene/bodies/SunSeen.h>

#include <vector>

#include <dspace/scene/Scene.h>
#include <dspace/scene/Stretch.h>
#include <dspace/scene/bodies/CelestialBody.h>
#include <dspace/scene/bodies/SunDisc.h>

namespace dspace {

std::optional<SunSeen> SunSeenFrom(const Scene& scene, const Eigen::Vector3d& p_R) {
  std::optional<Eigen::Vector3d> sun;
  double radius = 0.0;
  std::vector<SunBlocker> blockers;
  for (const auto& [id, object] : scene.Objects()) {
    const auto* body = dynamic_cast<const CelestialBody*>(object.custom.get());
    if (!body || !object.visible) {
      continue;
    }
    const BodyShape& shape = body->Shape();
    Eigen::Affine3d X_RO;
    X_RO.matrix() = scene.Frames().RelativePose(RootFrame, object.frame).Matrix();
    X_RO = X_RO * object.X_FO;
    const Eigen::Vector3d center = X_RO.translation() - p_R;
    if (shape.sun) {
      sun = center;
      radius = shape.radii.maxCoeff() * LargestStretch(X_RO);
    } else if (shape.eclipses) {
      blockers.push_back({center, (X_RO.linear() * shape.radii.asDiagonal()).inverse()});
    }
  }
  if (!sun || sun->norm() <= radius) {
    return std::nullopt;
  }
  SunSeen seen{sun->normalized(), 1.0};
  for (const SunBlocker& blocker : blockers) {
    seen.left *= SunLeft(blocker, *sun, radius);
  }
  return seen;
}

} // namespace dspace
