#include <dspace/export/ExportLights.h>

#include <cmath>

#include <dspace/Checks.h>
#include <dspace/scene/LinearLight.h>

namespace dspace {
namespace {

constexpr double HardEdge = 0.999; // the inner cone is smaller than the outer one

std::string WordOf(Light::Kind kind) {
  return kind == Light::Kind::Directional ? "directional"
         : kind == Light::Kind::Point     ? "point"
                                          : "spot";
}

// Lights of glTF shine along -Z of their node.
void Turn(const Eigen::Vector3d& direction, tinygltf::Node& node) {
  const Eigen::Quaterniond q =
      Eigen::Quaterniond::FromTwoVectors(-Eigen::Vector3d::UnitZ(), direction);
  node.rotation = {q.x(), q.y(), q.z(), q.w()};
}

// The candela of a light; `warning` is set where they hold at one distance only.
double Candela(const Scene& scene, const Light& light, const Eigen::Vector3d& middle,
               std::string& warning) {
  const auto& [a, b, c] = light.attenuation;
  if (a == 0.0 && b == 0.0) {
    return M_PI * light.intensity / c; // Scene rejects three zeros
  }
  const Eigen::Vector3d p = scene.Frames().WorldPose(light.frame).Apply(light.position);
  double d = (p - middle).norm();
  d = d > 0.0 ? d : 1.0;
  warning = "light '" + light.name + "' falls off by 1 / (" + NumberText(a) + " + " +
            NumberText(b) + " d + " + NumberText(c) +
            " d^2), and lights of glTF by 1 / d^2: it is as bright as in the scene at " +
            NumberText(d) + " m, the middle of the objects";
  return M_PI * light.intensity * d * d / (a + b * d + c * d * d);
}

} // namespace

std::vector<ExportedLight> ExportLights(const Scene& scene, const Eigen::Vector3d& middle,
                                        const std::string& object,
                                        std::vector<std::string>& warnings) {
  std::vector<ExportedLight> lights;
  for (const Light& from : scene.Fragments().Lights()) {
    if (!from.enabled || from.kind == Light::Kind::Ambient) {
      continue;
    }
    if (from.kind == Light::Kind::Head) {
      warnings.push_back(object + ": light '" + from.name +
                         "' is left out: it is at the camera, and lights of glTF are not");
      continue;
    }
    ExportedLight to;
    to.frame = from.frame;
    to.node.name = from.name;
    to.light.name = from.name;
    to.light.type = WordOf(from.kind);
    const auto color = LinearColor(from.color);
    to.light.color = {color[0], color[1], color[2]};
    if (from.kind == Light::Kind::Directional) {
      to.light.intensity = M_PI * from.intensity;
    } else {
      std::string warning;
      to.light.intensity = Candela(scene, from, middle, warning);
      if (!warning.empty()) {
        warnings.push_back(object + ": " + warning);
      }
      to.node.translation = {from.position.x(), from.position.y(), from.position.z()};
    }
    if (from.kind != Light::Kind::Point) {
      Turn(from.direction, to.node);
    }
    if (from.kind == Light::Kind::Spot) {
      to.light.spot.outerConeAngle = from.cone_deg * M_PI / 180.0;
      to.light.spot.innerConeAngle = HardEdge * to.light.spot.outerConeAngle;
    }
    lights.push_back(std::move(to));
  }
  return lights;
}

Eigen::Vector3d AmbientOf(const Scene& scene) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Light& light : scene.Fragments().Lights()) {
    if (light.enabled && light.kind == Light::Kind::Ambient) {
      const auto color = LinearColor(light.color);
      sum += light.intensity * Eigen::Vector3d(color[0], color[1], color[2]);
    }
  }
  return sum;
}

} // namespace dspace
