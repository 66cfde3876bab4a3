#include <dspace/raster/RasterBody.h>

#include <cmath>
#include <string>

#include <dspace/Checks.h>
#include <dspace/Error.h>

namespace dspace {
namespace {

[[noreturn]] void Reject(const ElevationInfo& info, Error::Kind kind, const std::string& message) {
  throw Error(kind, "raster '" + info.path + "'", message);
}

} // namespace

BodyEllipsoid BodyOfRaster(const ElevationInfo& info) {
  const BodyAxes& axes = info.crs.GetAxes();
  const VerticalDatum& datum = info.verticalDatum;
  const bool stated =
      (datum.kind == VerticalDatum::Kind::Sphere || datum.kind == VerticalDatum::Kind::Radius) &&
      datum.radius > 0.0;
  const bool sphere = std::abs(axes.semiMajor - axes.semiMinor) <= 1e-9 * axes.semiMajor;
  if (sphere) {
    const double radius = stated ? datum.radius : axes.semiMajor;
    return {radius, radius};
  }
  const std::string ellipsoid = "its CRS '" + info.crs.GetName() + "' stands on an ellipsoid of " +
                                NumberText(axes.semiMajor) + " by " + NumberText(axes.semiMinor) +
                                " m";
  if (datum.kind == VerticalDatum::Kind::Sphere || datum.kind == VerticalDatum::Kind::Radius) {
    Reject(info, Error::Kind::Unsupported,
           ellipsoid + ", but its heights count from a sphere (vertical datum '" + datum.Text() +
               "'); accepted on an ellipsoid are heights above it (vertical_datum='ellipsoid')");
  }
  if (info.crs.GetKind() != Crs::Kind::Geographic) {
    Reject(info, Error::Kind::Unsupported, ellipsoid + " and is a projection; " + AcceptedOnBody);
  }
  if (!(axes.semiMinor < axes.semiMajor && axes.semiMinor >= 0.5 * axes.semiMajor)) {
    Reject(info, Error::Kind::Unsupported,
           ellipsoid + "; accepted is a polar radius of half the equatorial one or more, and not "
                       "over it");
  }
  return {axes.semiMajor, axes.semiMinor};
}

} // namespace dspace
