// Where the Sun stands, seen from a terrain.
#ifndef DSPACE_SESSION_SUN_PLACE_H
#define DSPACE_SESSION_SUN_PLACE_H

#include <optional>

#include <Eigen/Core>

#include <dspace/proto/common.pb.h>
#include <dspace/raster/RasterPlace.h>
#include <dspace/scene/Scene.h>
#include <dspace/surface/TerrainSurface.h>

namespace dspace::session {

class TerrainObject;

// The light of the Sun's name, also one that is not directional; null: there is none.
const Light* FindSunLight(const Scene& scene);

// The light "sun" (a new one where there is none) as a change makes it. Throws as ChangeSun, and
// Error(InvalidArgument) where the light is not directional.
Light MovedSun(const Scene& scene, const v1::SunState& sun);

// Towards the Sun, unit, in `frame`.
Eigen::Vector3d TowardsSun(const Scene& scene, const Light& sun, FrameId frame);

// East, north and up as columns, in the terrain's frame, at a map point (absent: the middle of its
// raster). Throws Error(InvalidArgument) that names the terrain and the point where the point is
// off its data.
Eigen::Matrix3d HorizontalAxes(const TerrainObject& terrain,
                               const std::optional<Eigen::Vector2d>& map);
// At the middle of the surface's raster.
Eigen::Matrix3d HorizontalAxes(const TerrainSurface& surface, const RasterPlace& place);

// A direction in axes X east, Y north, Z up, unit; the azimuth is clockwise from north. And back:
// azimuth (0 to 360) and elevation [deg].
Eigen::Vector3d ToDirection(double azimuth_deg, double elevation_deg);
Eigen::Vector2d ToHorizontal(const Eigen::Vector3d& direction);

} // namespace dspace::session

#endif
