#include <dspace/raster/DegreeGrid.h>

#include <cmath>
#include <cstdio>

#include <ogr_spatialref.h>

#include <dspace/Error.h>
#include <dspace/crs/CrsTransform.h>

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;
constexpr double Near = 0.01; // of a pixel
constexpr const char* Accepted =
    "accepted on a body is a north-up grid in longitude and latitude, or in an equidistant "
    "cylindrical projection, on a sphere; or draw it on a plane";

[[noreturn]] void Reject(const ElevationInfo& info, Error::Kind kind, const std::string& message) {
  throw Error(kind, "raster '" + info.path + "'", message);
}

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

// Map coordinates to degrees east and north, one factor and one shift an axis.
struct MapToDegrees {
  Eigen::Vector2d factor;
  Eigen::Vector2d shift;
};

MapToDegrees ToDegrees(const ElevationInfo& info) {
  const Crs& crs = info.crs;
  const Eigen::Vector2d unit = crs.GetUnit() * crs.GetAxisSigns();
  if (crs.GetKind() == Crs::Kind::Geographic) {
    return {unit, Eigen::Vector2d::Zero()};
  }
  const OGRSpatialReference& srs = *crs.Ogr();
  const char* projection = srs.GetAttrValue("PROJECTION");
  if (!projection || std::string(projection) != SRS_PT_EQUIRECTANGULAR) {
    Reject(info, Error::Kind::Unsupported,
           "its CRS '" + crs.GetName() + "' is a projection of another kind; " + Accepted);
  }
  const double metre = crs.GetAxes().semiMajor * Degree; // of a degree
  const double parallel = srs.GetNormProjParm(SRS_PP_STANDARD_PARALLEL_1, 0.0);
  const Eigen::Vector2d origin(srs.GetNormProjParm(SRS_PP_CENTRAL_MERIDIAN, 0.0),
                               srs.GetNormProjParm(SRS_PP_LATITUDE_OF_ORIGIN, 0.0));
  const Eigen::Vector2d falseOrigin(srs.GetNormProjParm(SRS_PP_FALSE_EASTING, 0.0),
                                    srs.GetNormProjParm(SRS_PP_FALSE_NORTHING, 0.0));
  MapToDegrees map;
  const Eigen::Vector2d scale(1.0 / (metre * std::cos(parallel * Degree)), 1.0 / metre);
  map.factor = unit.cwiseProduct(scale);
  map.shift = origin - falseOrigin.cwiseProduct(scale);
  // PROJ's word on the raster's middle.
  const Eigen::Vector2d middle =
      info.pixelToMap * Eigen::Vector2d(0.5 * info.window.width, 0.5 * info.window.height);
  const Crs geographic = crs.Geographic();
  const Eigen::Vector2d place =
      CrsTransform(crs, geographic).Apply(middle).cwiseProduct(geographic.GetAxisSigns()) *
      geographic.GetUnit();
  const Eigen::Vector2d off = map.factor.cwiseProduct(middle) + map.shift - place;
  if (!(std::abs(std::remainder(off.x(), 360.0)) < 1e-6 && std::abs(off.y()) < 1e-6)) {
    Reject(info, Error::Kind::Unsupported,
           "its CRS '" + crs.GetName() + "' is not understood as a grid of degrees; " + Accepted);
  }
  return map;
}

double RadiusOf(const ElevationInfo& info) {
  const VerticalDatum& datum = info.verticalDatum;
  const bool stated =
      datum.kind == VerticalDatum::Kind::Sphere || datum.kind == VerticalDatum::Kind::Radius;
  return stated && datum.radius > 0.0 ? datum.radius : info.crs.GetAxes().semiMajor;
}

} // namespace

DegreeGrid DegreeGridOf(const ElevationInfo& info) {
  const Crs& crs = info.crs;
  if (!crs.HasGeographic() || !info.georeferenced) {
    Reject(info, Error::Kind::Unsupported,
           std::string("it has no longitude and latitude; ") + Accepted);
  }
  const BodyAxes& axes = crs.GetAxes();
  if (!(std::abs(axes.semiMajor - axes.semiMinor) <= 1e-9 * axes.semiMajor)) {
    Reject(info, Error::Kind::Unsupported,
           "its CRS '" + crs.GetName() + "' stands on an ellipsoid of " + Number(axes.semiMajor) +
               " by " + Number(axes.semiMinor) + " m; " + Accepted);
  }
  const Eigen::Matrix2d m = info.pixelToMap.linear();
  const int width = info.window.width;
  const int height = info.window.height;
  const MapToDegrees toDegrees = ToDegrees(info);
  DegreeGrid grid;
  grid.radius = RadiusOf(info);
  grid.step_deg = m.diagonal().cwiseProduct(toDegrees.factor);
  grid.first_deg = (info.pixelToMap * Eigen::Vector2d(0.5, 0.5)).cwiseProduct(toDegrees.factor) +
                   toDegrees.shift;
  const bool rotated = std::abs(m(0, 1)) * height > Near * std::abs(m(0, 0)) ||
                       std::abs(m(1, 0)) * width > Near * std::abs(m(1, 1));
  if (rotated || !(grid.step_deg.y() < 0.0)) {
    Reject(
        info, Error::Kind::Unsupported,
        std::string(rotated ? "its pixels are rotated or sheared" : "its rows run to the north") +
            " against longitude and latitude; " + Accepted);
  }

  const double step = std::abs(grid.step_deg.x());
  const auto turn = [&](int steps) { return std::abs(steps * step - 360.0) < Near * step; };
  grid.periodic = turn(width);
  grid.repeats = turn(width - 1);
  if (!grid.periodic && !grid.repeats && width * step > 360.0) {
    Reject(info, Error::Kind::InvalidArgument,
           std::to_string(width) + " columns " + Number(step) +
               " degrees apart go around the body more than once; give a window of it");
  }
  if (grid.periodic || grid.repeats) { // from its middle
    const int steps = grid.periodic ? width : width - 1;
    const double exact = std::copysign(360.0 / steps, grid.step_deg.x());
    grid.first_deg.x() += 0.5 * (width - 1) * (grid.step_deg.x() - exact);
    grid.step_deg.x() = exact;
  }

  const double row = -grid.step_deg.y();
  const double last = grid.first_deg.y() - (height - 1) * row;
  const auto near = [&](double latitude, double pole) {
    return std::abs(latitude - pole) < Near * row;
  };
  const bool edges = near(grid.first_deg.y() + 0.5 * row, 90.0) && near(last - 0.5 * row, -90.0);
  if (edges || (near(grid.first_deg.y(), 90.0) && near(last, -90.0))) {
    grid.step_deg.y() = -180.0 / (edges ? height : height - 1);
    grid.first_deg.y() = 90.0 + (edges ? 0.5 * grid.step_deg.y() : 0.0);
  }
  grid.poles = edges && (grid.periodic || grid.repeats);
  if (grid.first_deg.y() > 90.0 + Near * row || last < -90.0 - Near * row) {
    Reject(info, Error::Kind::InvalidArgument,
           "its rows run from latitude " + Number(grid.first_deg.y()) + " to " + Number(last) +
               "; accepted is 90 to -90");
  }
  return grid;
}

} // namespace dspace
