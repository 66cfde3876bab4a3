#include <dspace/raster/PolarGrid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <dspace/Error.h>
#include <dspace/crs/CrsTransform.h>
#include <dspace/raster/RasterBody.h>

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;
constexpr double Farthest = 125.0 * Degree; // from the pole

// (Snyder 1987, p. 154) Map places are at `pole` + 2 scale tan(colatitude / 2), in the direction of
// `angle` plus (north) or less (south) the longitude.
struct PolarPlane {
  bool south = false;
  Eigen::Vector2d pole;
  double scale = 0.0; // map units a radius
  double angle = 0.0; // [rad] of longitude 0

  Eigen::Vector2d At(double longitude_deg, double colatitude_deg) const {
    const double turn = longitude_deg * Degree;
    const double a = this->angle + (this->south ? -turn : turn);
    return this->pole + 2.0 * this->scale * std::tan(0.5 * colatitude_deg * Degree) *
                            Eigen::Vector2d(std::cos(a), std::sin(a));
  }
};

std::optional<PolarPlane> PlaneOf(const Crs& crs, const CrsTransform& toMap, bool south) {
  constexpr int Count = 6;
  const double longitudes[Count] = {0.0, 0.0, 77.0, -160.0, 200.0, -90.0};
  const double colatitudes[Count] = {0.0, 10.0, 1.0, 35.0, 60.0, 89.0};
  const Crs geographic = crs.Geographic();
  Eigen::Matrix2Xd places(2, Count);
  for (int i = 0; i < Count; ++i) {
    const double latitude = 90.0 - colatitudes[i];
    places.col(i) = Eigen::Vector2d(longitudes[i], south ? -latitude : latitude)
                        .cwiseProduct(geographic.GetAxisSigns()) /
                    geographic.GetUnit();
  }
  toMap.TryApply(places);
  if (!places.allFinite()) {
    return std::nullopt;
  }
  PolarPlane plane;
  plane.south = south;
  plane.pole = places.col(0);
  const Eigen::Vector2d along = places.col(1) - plane.pole;
  plane.scale = along.norm() / (2.0 * std::tan(0.5 * colatitudes[1] * Degree));
  plane.angle = std::atan2(along.y(), along.x());
  for (int i = 2; i < Count; ++i) {
    if (!((places.col(i) - plane.At(longitudes[i], colatitudes[i])).norm() < 1e-8 * plane.scale)) {
      return std::nullopt;
    }
  }
  return plane;
}

[[noreturn]] void Reject(const ElevationInfo& info, const std::string& message) {
  throw Error(Error::Kind::Unsupported, "raster '" + info.path + "'",
              message + "; " + AcceptedOnBody);
}

} // namespace

std::optional<PolarGrid> PolarGridOf(const ElevationInfo& info) {
  const BodyAxes& axes = info.crs.GetAxes();
  if (info.crs.GetKind() != Crs::Kind::Projected || !info.georeferenced ||
      std::abs(axes.semiMajor - axes.semiMinor) > 1e-9 * axes.semiMajor) {
    return std::nullopt;
  }
  const CrsTransform toMap(info.crs.Geographic(), info.crs);
  std::optional<PolarPlane> plane = PlaneOf(info.crs, toMap, false);
  if (!plane) {
    plane = PlaneOf(info.crs, toMap, true);
  }
  if (!plane) {
    return std::nullopt;
  }
  const Eigen::Matrix2d linear = info.pixelToMap.linear();
  const double side = linear.col(0).norm();
  const Eigen::Vector2d below(linear(1, 0), -linear(0, 0)); // of square pixels, not mirrored
  const double off = (linear.col(1) - below).norm() / side;
  if (!(off * std::max(info.window.width, info.window.height) < 0.01)) {
    Reject(info, linear.determinant() > 0.0
                     ? "its pixels are mirrored: its rows run against the map's Y"
                     : "its pixels are no squares");
  }
  PolarGrid grid;
  grid.south = plane->south;
  grid.body = BodyOfRaster(info);
  grid.step = 0.5 * std::sqrt(std::abs(linear.determinant())) / plane->scale;
  grid.pole = info.pixelToMap.inverse() * plane->pole - Eigen::Vector2d(0.5, 0.5);
  const double column = std::atan2(linear(1, 0), linear(0, 0));
  grid.east_deg = (grid.south ? plane->angle - column : column - plane->angle) / Degree;
  // PROJ rounds what is a whole degree.
  if (std::abs(grid.east_deg - std::round(grid.east_deg)) < 1e-9) {
    grid.east_deg = std::round(grid.east_deg);
  }
  const Eigen::Vector2d last(info.window.width - 1, info.window.height - 1);
  for (const double x : {0.0, last.x()}) {
    for (const double y : {0.0, last.y()}) {
      const double away = 2.0 * std::atan(grid.step * (Eigen::Vector2d(x, y) - grid.pole).norm());
      if (away > Farthest) {
        Reject(info, "a corner of it is " + std::to_string(away / Degree) +
                         " degrees from the pole of its projection; accepted is up to 125; give a "
                         "window of it");
      }
    }
  }
  return grid;
}

} // namespace dspace
