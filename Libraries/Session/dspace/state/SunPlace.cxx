#include <dspace/state/SunPlace.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/messages/Convert.h>
#include <dspace/messages/SunMessages.h>
#include <dspace/state/TerrainObject.h>

namespace dspace::session {
namespace {

Eigen::Matrix3d AxesAt(const TerrainSurface& surface, const Eigen::Vector2d& map) {
  const Eigen::Vector3d p_S = surface.MapToScene({map.x(), map.y(), 0.0});
  Eigen::Matrix3d axes;
  axes.col(1) = surface.North(p_S);
  axes.col(2) = surface.Up(p_S);
  axes.col(0) = axes.col(1).cross(axes.col(2));
  return axes;
}

} // namespace

const Light* FindSunLight(const Scene& scene) {
  const std::vector<Light>& lights = scene.Fragments().Lights();
  const auto found = std::find_if(lights.begin(), lights.end(),
                                  [](const Light& light) { return light.name == SunName; });
  return found == lights.end() ? nullptr : &*found;
}

Light MovedSun(const Scene& scene, const v1::SunState& sun) {
  v1::SetLight light = DefaultSun();
  if (const Light* present = FindSunLight(scene)) {
    if (!IsSun(*present)) {
      Reject(SunLabel,
             "it is not directional, hence no Sun; accepted: remove it, or give it the kind "
             "directional, first");
    }
    Put(*present, &light);
  }
  ChangeSun(sun, light);
  return ToLight(light);
}

Eigen::Vector3d TowardsSun(const Scene& scene, const Light& sun, FrameId frame) {
  const Pose X = scene.Frames().RelativePose(frame, sun.frame);
  return (X.rotation * -sun.direction.normalized()).normalized();
}

Eigen::Matrix3d HorizontalAxes(const TerrainObject& terrain,
                               const std::optional<Eigen::Vector2d>& map) {
  const TerrainSurface& surface = terrain.Surface();
  if (!map) {
    return HorizontalAxes(surface, terrain.Place());
  }
  const std::string label = "terrain '" + terrain.Name() + "'";
  const auto text = [](const Eigen::Vector2d& p) {
    return NumberText(p.x()) + ", " + NumberText(p.y());
  };
  const Eigen::AlignedBox2d box = surface.GetBounds().map;
  // The box ends at posts, and a map may have a place twice (longitudes): the data decide there.
  if (!map->allFinite() || (!box.contains(*map) && !surface.SampleMap(*map).valid)) {
    Reject(label, "the place " + text(*map) + " is off its data; accepted: map x, y from " +
                      text(box.min()) + " to " + text(box.max()));
  }
  return AxesAt(surface, *map);
}

Eigen::Matrix3d HorizontalAxes(const TerrainSurface& surface, const RasterPlace& place) {
  return AxesAt(surface, place.pixelToMap * Eigen::Vector2d(0.5 * place.columns, 0.5 * place.rows));
}

Eigen::Vector3d ToDirection(double azimuth_deg, double elevation_deg) {
  const double azimuth = azimuth_deg * M_PI / 180.0;
  const double elevation = elevation_deg * M_PI / 180.0;
  return {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
          std::sin(elevation)};
}

Eigen::Vector2d ToHorizontal(const Eigen::Vector3d& direction) {
  const double azimuth_deg = std::atan2(direction.x(), direction.y()) * 180.0 / M_PI;
  return {azimuth_deg < 0.0 ? std::fmod(azimuth_deg + 360.0, 360.0) : azimuth_deg,
          std::atan2(direction.z(), direction.head<2>().norm()) * 180.0 / M_PI};
}

} // namespace dspace::session
