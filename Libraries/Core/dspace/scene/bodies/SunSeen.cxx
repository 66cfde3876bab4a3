#include <dspace/scene/bodies/SunSeen.h>

#include <cmath>

#include <dspace/AstronomicalUnit.h>
#include <dspace/scene/Scene.h>
#include <dspace/scene/Stretch.h>
#include <dspace/scene/bodies/CelestialBody.h>
#include <dspace/scene/bodies/SunDisc.h>

namespace dspace {

const GraphicsObject* FindSunBody(const Scene& scene) {
  for (const auto& [id, object] : scene.Objects()) {
    const auto* body = dynamic_cast<const CelestialBody*>(object.custom.get());
    if (body && body->Shape().sun) {
      return &object;
    }
  }
  return nullptr;
}

SunlitBodies::SunlitBodies(const Scene& scene) {
  for (const auto& [id, object] : scene.Objects()) {
    const auto* body = dynamic_cast<const CelestialBody*>(object.custom.get());
    if (!body || !object.visible) {
      continue;
    }
    const BodyShape& shape = body->Shape();
    Eigen::Affine3d X_RO;
    X_RO.matrix() = scene.Frames().RelativePose(RootFrame, object.frame).Matrix();
    X_RO = X_RO * object.X_FO;
    if (shape.sun) {
      this->Sun_ = X_RO.translation();
      this->Radius_ = shape.radii.maxCoeff() * LargestStretch(X_RO);
    } else if (shape.eclipses) {
      this->Blockers_.push_back(
          {X_RO.translation(), (X_RO.linear() * shape.radii.asDiagonal()).inverse()});
    }
  }
}

std::optional<SunSeen> SunlitBodies::From(const Eigen::Vector3d& p_R) const {
  if (!this->Sun_) {
    return std::nullopt;
  }
  const Eigen::Vector3d sun = *this->Sun_ - p_R;
  const double distance = sun.norm();
  if (distance <= this->Radius_) {
    return std::nullopt;
  }
  SunSeen seen;
  seen.towards_R = sun / distance;
  seen.radius = std::asin(this->Radius_ / distance);
  seen.square = std::pow(AstronomicalUnit / distance, 2);
  for (const Blocker& blocker : this->Blockers_) {
    seen.left *= SunLeft({blocker.center_R - p_R, blocker.unit}, sun, this->Radius_);
  }
  return seen;
}

} // namespace dspace
