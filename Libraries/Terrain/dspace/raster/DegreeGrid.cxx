#include <dspace/raster/DegreeGrid.h>

#include <cmath>
#include <cstdio>

#include <ogr_spatialref.h>

#include <dspace/Error.h>
#include <dspace/crs/CrsTransform.h>
#include <dspace/raster/PolarGrid.h>
#include <dspace/raster/RasterBody.h>

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;
constexpr double Near = 0.01; // of a pixel

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
  BodyOfRaster(info); // rejects projections of an ellipsoid
  const OGRSpatialReference& srs = *crs.Ogr();
  const char* projection = srs.GetAttrValue("PROJECTION");
  if (!projection || std::string(projection) != SRS_PT_EQUIRECTANGULAR) {
    Reject(info, Error::Kind::Unsupported,
           "its CRS '" + crs.GetName() + "' is a projection of another kind; " + AcceptedOnBody);
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
           "its CRS '" + crs.GetName() + "' is not understood as a grid of degrees; " +
               AcceptedOnBody);
  }
  return map;
}

// Stretches columns (axis 0) or rows about the middle of `size` pixels, so that one is `exact` map
// units.
void Stretch(ElevationInfo& info, int axis, int size, double exact) {
  Eigen::Affine2d& map = info.pixelToMap;
  map.translation()[axis] += 0.5 * size * (map.linear()(axis, axis) - exact);
  map.linear()(axis, axis) = exact;
}

bool Rotated(const ElevationInfo& info) {
  const Eigen::Matrix2d m = info.pixelToMap.linear();
  return std::abs(m(0, 1)) * info.window.height > Near * std::abs(m(0, 0)) ||
         std::abs(m(1, 0)) * info.window.width > Near * std::abs(m(1, 1));
}

} // namespace

DegreeGrid DegreeGridOf(const ElevationInfo& info) {
  const Crs& crs = info.crs;
  if (!crs.HasGeographic()) {
    Reject(info, Error::Kind::Unsupported,
           std::string("it has no longitude and latitude; ") + AcceptedOnBody);
  }
  if (!info.georeferenced) {
    Reject(info, Error::Kind::Unsupported,
           "it does not state where its pixels lie on the map; accepted on a body is a raster that "
           "does (gdal_translate -a_srs CRS -a_ullr LEFT TOP RIGHT BOTTOM writes one)");
  }
  const BodyEllipsoid body = BodyOfRaster(info);
  const Eigen::Matrix2d m = info.pixelToMap.linear();
  const int width = info.window.width;
  const int height = info.window.height;
  const MapToDegrees toDegrees = ToDegrees(info);
  DegreeGrid grid;
  grid.body = body;
  grid.step_deg = m.diagonal().cwiseProduct(toDegrees.factor);
  grid.first_deg = (info.pixelToMap * Eigen::Vector2d(0.5, 0.5)).cwiseProduct(toDegrees.factor) +
                   toDegrees.shift;
  const bool rotated = Rotated(info);
  if (rotated || !(grid.step_deg.y() < 0.0)) {
    Reject(
        info, Error::Kind::Unsupported,
        std::string(rotated ? "its pixels are rotated or sheared" : "its rows run to the north") +
            " against longitude and latitude (gdalwarp writes a north-up copy); " + AcceptedOnBody);
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

void CloseAround(ElevationInfo& info) {
  if (!info.crs.HasGeographic() || !info.georeferenced || Rotated(info) || PolarGridOf(info)) {
    return;
  }
  const MapToDegrees toDegrees = ToDegrees(info);
  const Eigen::Vector2d factor = toDegrees.factor;
  const int width = info.window.width;
  const int height = info.window.height;
  const double column = std::abs(info.pixelToMap.linear()(0, 0) * factor.x());
  const double overlap = width - 360.0 / column;
  const int around = overlap > 0.5 ? width - 1 : width; // without a column that is there twice
  if (around > 1 && overlap > -1.0 - Near && overlap < 1.0 + Near) {
    const double off = overlap - (width - around);
    info.overlapColumns = off;
    const double exact = std::copysign(360.0 / around / factor.x(), info.pixelToMap.linear()(0, 0));
    Stretch(info, 0, around, exact);
    if (std::abs(off) > Near) {
      info.warnings.push_back("its " + std::to_string(around) + " columns of " + Number(column) +
                              " degrees go around the body with " +
                              (off > 0.0 ? "an overlap" : "a gap") + " of " +
                              Number(std::abs(off)) +
                              " of a column: they are taken to go around exactly, which moves a "
                              "column by up to " +
                              Number(0.5 * std::abs(off)) + " of its width");
    }
  }
  // Rows whose edges are at the poles, or past them.
  const double row = std::abs(info.pixelToMap.linear()(1, 1) * factor.y());
  const double middle = (info.pixelToMap * Eigen::Vector2d(0.5 * width, 0.5 * height)).y();
  const double centre = middle * factor.y() + toDegrees.shift.y();
  const double beyond = height - 180.0 / row;
  const double top = centre + 0.5 * height * row - 90.0;
  const double bottom = -90.0 - (centre - 0.5 * height * row);
  const auto there = [&](double degrees) { return std::abs(degrees) < row; };
  const auto onPole = [&](double degrees) {
    return std::abs(degrees - 0.5 * row) < Near * row; // a row's centre
  };
  if (std::abs(beyond) < 1.0 - Near && there(top) && there(bottom) &&
      !(onPole(top) && onPole(bottom))) {
    const double exact = std::copysign(180.0 / height / factor.y(), info.pixelToMap.linear()(1, 1));
    Stretch(info, 1, height, exact);
    info.pixelToMap.translation().y() -=
        (info.pixelToMap * Eigen::Vector2d(0.0, 0.5 * height)).y() +
        toDegrees.shift.y() / factor.y();
    const double moved = std::max(std::abs(top), std::abs(bottom)) / row;
    if (moved > Near) {
      info.warnings.push_back("its " + std::to_string(height) + " rows of " + Number(row) +
                              " degrees end " + Number(top / row) +
                              " of a row beyond the north "
                              "pole and " +
                              Number(bottom / row) +
                              " beyond the south pole: they are taken to go from pole to pole");
    }
  }
}

} // namespace dspace
