// The horizon around a place.
#ifndef DSPACE_MEASURE_HORIZON_SCAN_H
#define DSPACE_MEASURE_HORIZON_SCAN_H

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <dspace/measure/Obstacles.h>

namespace dspace {

// Unit axes of the local horizontal system at a place, in the root.
struct LevelAxes {
  Eigen::Vector3d east = Eigen::Vector3d::UnitX();
  Eigen::Vector3d north = Eigen::Vector3d::UnitY();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
};

// In one azimuth: the greatest elevation at which a ray meets an obstacle. -90 without one.
struct HorizonPoint {
  double elevation_deg = -90.0;
  double distance = std::numeric_limits<double>::infinity(); // [m] along the ray
  Eigen::Vector3d point = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  std::uint32_t object = 0; // 0: terrain
};

// `count` azimuths, evenly spaced, clockwise from north.
//
// Ground: elevations are bisected with exact rays to 1e-6 degrees: in a vertical plane, a ray from
// a place above the ground that is lower than one that meets the ground meets it too. Where the
// place is not over the data of a terrain this does not hold, and the elevations are first searched
// from the zenith down in steps of 0.25 degrees. Triangles: in closed form, from where the vertical
// half-plane of the azimuth cuts them.
//
// `progress` is called at each azimuth of a ground and at each solid, with the part that is done,
// 0 to 1.
//
// Throws what Obstacles::Stand throws for a place below the ground.
std::vector<HorizonPoint> ScanHorizon(const Obstacles& obstacles, const Eigen::Vector3d& place_R,
                                      const LevelAxes& axes, std::size_t count,
                                      const std::string& label,
                                      const std::function<void(double)>& progress = {});

} // namespace dspace

#endif
