#include <dspace/messages/SunMessages.h>

#include <cmath>

#include <dspace/Checks.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/Light.h>

namespace dspace::session {
namespace {

constexpr double GreatestIrradiance = 1e12 * SolarConstant; // the greatest intensity of a light

void RequireSunDirection(const v1::Vector3& direction) {
  const Eigen::Vector3d v = ToVector(direction);
  const double length = v.norm();
  if (!(length >= 1e-12 && length <= 1e18)) {
    Reject(SunLabel, "the direction towards the Sun is " + VectorText(v) +
                         "; accepted: finite numbers, of length 1e-12 to 1e18");
  }
}

// The intensity that the message gives.
double SunIntensity(const v1::SunState& sun) {
  if (sun.has_irradiance() && sun.has_distance_au()) {
    Reject(SunLabel, "an irradiance of " + NumberText(sun.irradiance()) +
                         " W/m^2 and a distance of " + NumberText(sun.distance_au()) +
                         " au are given; accepted: one of them");
  }
  if (sun.has_irradiance()) {
    Require(sun.irradiance() >= 0.0 && sun.irradiance() <= GreatestIrradiance, SunLabel,
            "its irradiance", sun.irradiance(), "0 to 1.361e15 W/m^2");
    return sun.irradiance() / SolarConstant;
  }
  Require(sun.distance_au() >= 1e-6 && sun.distance_au() <= 1e12, SunLabel, "its distance",
          sun.distance_au(), "1e-6 to 1e12 au");
  return 1.0 / (sun.distance_au() * sun.distance_au());
}

} // namespace

v1::SetLight DefaultSun() {
  v1::SetLight light;
  light.set_name(SunName);
  light.set_kind(v1::SetLight::DIRECTIONAL);
  Put(Eigen::Vector3d(0.5, -0.5, -std::sqrt(0.5)), light.mutable_direction());
  return light;
}

void ChangeSun(const v1::SunState& sun, v1::SetLight& light) {
  if (sun.has_direction()) {
    RequireSunDirection(sun.direction());
  }
  if (sun.has_radius_deg()) {
    Require(sun.radius_deg() >= 0.0 && sun.radius_deg() <= 90.0, SunLabel, "the radius of its disc",
            sun.radius_deg(), "0 to 90 degrees");
  }
  const bool bright = sun.has_irradiance() || sun.has_distance_au();
  const double intensity = bright ? SunIntensity(sun) : 0.0;
  if (sun.has_direction()) {
    light.set_frame(sun.frame());
    Put(-ToVector(sun.direction()), light.mutable_direction());
  }
  if (sun.has_radius_deg()) {
    light.set_radius_deg(sun.radius_deg());
  }
  if (bright) {
    light.set_intensity(intensity);
    light.clear_color(); // white
  }
}

void DescribeSun(const v1::SetLight& light, v1::SunInfo& info) {
  const Light sun = ToLight(light);
  info.set_radius_deg(sun.radius_deg);
  info.set_irradiance(sun.intensity * SolarConstant);
  info.set_distance_au(1.0 / std::sqrt(sun.intensity));
  info.set_disabled(!sun.enabled);
  info.set_frame(sun.frame);
}

} // namespace dspace::session
