#include <dspace/crs/Geodesics.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/GeodesicExact.hpp>
#include <GeographicLib/PolygonArea.hpp>

#include <dspace/Checks.h>

namespace dspace {
namespace {

// The series are exact to 15 nm up to a flattening of 1/50 (Karney 2013).
constexpr double MostFlattened = 0.01;

double FromNorth(double azimuth_deg) {
  return azimuth_deg < 0.0 ? azimuth_deg + 360.0 : azimuth_deg;
}

} // namespace

std::string PlaceText(const Eigen::Vector2d& place) {
  return "longitude " + NumberText(place.x()) + ", latitude " + NumberText(place.y());
}

void RequirePlace(const Eigen::Vector2d& place) {
  if (!place.allFinite() || std::abs(place.y()) > 90.0) {
    Reject("place", PlaceText(place) +
                        " is given; accepted: finite longitudes, and latitudes from -90 to 90 deg");
  }
}

struct Geodesics::Solver {
  std::variant<GeographicLib::Geodesic, GeographicLib::GeodesicExact> of;

  static Solver For(double radius, double flattening) {
    if (flattening <= MostFlattened) {
      return {GeographicLib::Geodesic(radius, flattening)};
    }
    return {GeographicLib::GeodesicExact(radius, flattening)};
  }
};

Geodesics::Geodesics(const BodyEllipsoid& ellipsoid)
    : Solver_(std::make_unique<const Solver>(
          Solver::For(ellipsoid.Equatorial(),
                      (ellipsoid.Equatorial() - ellipsoid.Polar()) / ellipsoid.Equatorial()))) {}

Geodesics::~Geodesics() = default;

Geodesic Geodesics::Between(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  RequirePlace(from);
  RequirePlace(to);
  Geodesic line;
  std::visit(
      [&](const auto& solver) {
        solver.Inverse(from.y(), from.x(), to.y(), to.x(), line.distance, line.azimuth_deg,
                       line.endAzimuth_deg);
      },
      this->Solver_->of);
  line.azimuth_deg = FromNorth(line.azimuth_deg);
  line.endAzimuth_deg = FromNorth(line.endAzimuth_deg);
  return line;
}

GeodesicEnd Geodesics::EndOf(const Eigen::Vector2d& from, double azimuth_deg,
                             double distance) const {
  RequirePlace(from);
  RequireFinite("geodesic", "its azimuth", azimuth_deg);
  RequireFinite("geodesic", "its length", distance);
  GeodesicEnd end;
  std::visit(
      [&](const auto& solver) {
        solver.Direct(from.y(), from.x(), azimuth_deg, distance, end.place.y(), end.place.x(),
                      end.azimuth_deg);
      },
      this->Solver_->of);
  end.azimuth_deg = FromNorth(end.azimuth_deg);
  return end;
}

GeodesicPolygon Geodesics::Around(const std::vector<Eigen::Vector2d>& corners) const {
  if (corners.size() < 3) {
    Reject("polygon", std::to_string(corners.size()) + " corners are given; accepted: 3 or more");
  }
  for (const Eigen::Vector2d& corner : corners) {
    RequirePlace(corner);
  }
  GeodesicPolygon polygon;
  std::visit(
      [&](const auto& solver) {
        GeographicLib::PolygonAreaT<std::decay_t<decltype(solver)>> sum(solver);
        for (const Eigen::Vector2d& corner : corners) {
          sum.AddPoint(corner.y(), corner.x());
        }
        sum.Compute(false, false, polygon.perimeter, polygon.area);
        polygon.area = std::min(polygon.area, solver.EllipsoidArea() - polygon.area);
      },
      this->Solver_->of);
  return polygon;
}

} // namespace dspace
