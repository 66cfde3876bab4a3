// Lights of a scene.
#ifndef DSPACE_SCENE_LIGHT_H
#define DSPACE_SCENE_LIGHT_H

#include <array>
#include <string>

#include <Eigen/Core>

#include <dspace/FrameTree.h>

namespace dspace {

struct Light {
  enum class Kind {
    Directional, // from infinitely far: `direction` only
    Point,       // from `position`, in all directions
    Spot,        // from `position` along `direction` within the cone
    Head,        // from the camera that draws
    Ambient      // from all directions equally: shadowed sides are not black
  };
  std::string name;
  Kind kind = Kind::Directional;
  FrameId frame = 1;                                     // position and direction are in it
  Eigen::Vector3d direction = Eigen::Vector3d(0, 0, -1); // the way the light travels
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    // [m]
  double cone_deg = 30.0;                                // Spot: half angle, in (0, 90)
  std::array<double, 3> color = {1, 1, 1};               // 0 to 1
  double intensity = 1.0;                                // 0 to 1e12, multiplies the colour
  std::array<double, 3> attenuation = {1, 0, 0}; // 1 / (a + b d + c d²), d in metres; 0 to 1e12
  bool enabled = true;
  // Directional: angular radius of its disc, 0 (a point) to 90 (the sky of a hemisphere). A disc of
  // even radiance whose irradiance on a surface that faces its centre is the intensity.
  double radius_deg = 0.2666;
};

// The light of this name is the Sun, if it is directional: it alone casts shadows. Intensity 1 is
// an irradiance of SolarConstant.
inline constexpr const char* SunName = "sun";
inline constexpr double SolarConstant = 1361.0; // [W/m^2] at 1 au (Kopp and Lean 2011)

inline bool IsSun(const Light& light) {
  return light.kind == Light::Kind::Directional && light.name == SunName;
}

} // namespace dspace

#endif
