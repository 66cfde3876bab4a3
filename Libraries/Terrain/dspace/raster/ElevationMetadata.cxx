#include <dspace/raster/ElevationMetadata.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include <gdal_priv.h>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

#include <dspace/crs/MapTurn.h>
#include <dspace/raster/DegreeGrid.h>

namespace dspace {

namespace {

std::string Object(const ElevationInfo& info) {
  return "raster '" + info.path + "'";
}

[[noreturn]] void Reject(const ElevationInfo& info, const std::string& message) {
  throw Error(Error::Kind::InvalidArgument, Object(info), message);
}

RasterWindow CheckedWindow(const ElevationOptions& options, int width, int height,
                           const ElevationInfo& info) {
  if (!options.window)
    return {0, 0, width, height};
  const RasterWindow& w = *options.window;
  if (w.column < 0 || w.row < 0 || w.width < 1 || w.height < 1 || w.width > width - w.column ||
      w.height > height - w.row)
    Reject(info, "window " + std::to_string(w.width) + " x " + std::to_string(w.height) + " at (" +
                     std::to_string(w.column) + ", " + std::to_string(w.row) +
                     ") does not lie within its " + std::to_string(width) + " x " +
                     std::to_string(height) + " pixels");
  return w;
}

Crs ReadCrs(GDALDataset& dataset, const ElevationOptions& options) {
  if (options.crs)
    return Crs::FromText(*options.crs);
  const OGRSpatialReference* srs = dataset.GetSpatialRef();
  return srs ? Crs::FromOgr(*srs) : Crs();
}

// A CRS given by hand goes before the file's, which may be wrong or no CRS of a map at all.
void WarnOfAnotherBody(const OGRSpatialReference* own, ElevationInfo& info) {
  Crs stated;
  try {
    if (own)
      stated = Crs::FromOgr(*own);
  } catch (const Error&) {
    return;
  }
  const double a = stated.GetAxes().semiMajor, b = info.crs.GetAxes().semiMajor;
  if (a > 0.0 && b > 0.0 && std::abs(a - b) > 0.005 * a)
    info.warnings.push_back("the CRS given, '" + info.crs.GetName() + "', is of a body of radius " +
                            std::to_string(b) + " m; the file's own, '" + stated.GetName() +
                            "', of one of " + std::to_string(a) + " m");
}

std::string Corners(const std::array<double, 4>& window) {
  std::ostringstream text;
  text.precision(12);
  text << "(" << window[0] << ", " << window[1] << ", " << window[2] << ", " << window[3] << ")";
  return text.str();
}

// The pixels that meet a part of the map; `toMap` is of the whole raster.
RasterWindow PixelsOf(std::array<double, 4> map, const Eigen::Affine2d& toMap, int width,
                      int height, ElevationInfo& info) {
  constexpr double Tiny = 1e-6; // of a pixel: what lies on an edge does not reach beyond it
  if (!std::isfinite(map[0] + map[1] + map[2] + map[3]) || map[0] == map[2] || map[1] == map[3])
    Reject(info, "window " + Corners(map) +
                     " given; accepted is left, top, right, bottom in map "
                     "coordinates, finite, with an area");
  const double turn = MapTurn(info.crs);
  const Eigen::Vector2d middle = toMap * Eigen::Vector2d(0.5 * width, 0.5 * height);
  const double shift =
      turn > 0.0 ? -turn * std::round((0.5 * (map[0] + map[2]) - middle.x()) / turn) : 0.0;
  map[0] += shift;
  map[2] += shift;
  const Eigen::Affine2d toPixel = toMap.inverse();
  Eigen::AlignedBox2d box;
  for (const double x : {map[0], map[2]})
    for (const double y : {map[1], map[3]})
      box.extend(Eigen::Vector2d(toPixel * Eigen::Vector2d(x, y)));
  const Eigen::Vector2d first = (box.min().array() + Tiny).floor();
  const Eigen::Vector2d last = (box.max().array() - Tiny).ceil();
  const Eigen::Vector2d all(width, height);
  const Eigen::Vector2d from = first.cwiseMax(0.0);
  const Eigen::Vector2d to = last.cwiseMin(all);
  const Eigen::Vector2d topLeft = toMap * from, bottomRight = toMap * to;
  if (!(from.array() < to.array()).all()) {
    const Eigen::Vector2d start = toMap * Eigen::Vector2d::Zero(), end = toMap * all;
    Reject(info, "window " + Corners(map) + " does not meet it; accepted is a part of " +
                     Corners({start.x(), start.y(), end.x(), end.y()}));
  }
  const RasterWindow window{int(from.x()), int(from.y()), int(to.x() - from.x()),
                            int(to.y() - from.y())};
  const bool cut = from != first || to != last;
  const bool moved = (box.min() - from).cwiseAbs().maxCoeff() > Tiny ||
                     (box.max() - to).cwiseAbs().maxCoeff() > Tiny;
  if (moved)
    info.warnings.push_back("window " + Corners(map) + " is " +
                            (cut ? "cut at the raster's edge" : "widened to whole pixels") + ": " +
                            std::to_string(window.width) + " x " + std::to_string(window.height) +
                            " pixels from (" + std::to_string(window.column) + ", " +
                            std::to_string(window.row) + ") on, " +
                            Corners({topLeft.x(), topLeft.y(), bottomRight.x(), bottomRight.y()}));
  return window;
}

// Latitudes beyond the poles mean a wrong geotransform, and would be drawn at a wrong place.
void CheckLatitudes(const ElevationInfo& info) {
  if (info.crs.GetKind() != Crs::Kind::Geographic)
    return;
  for (double c : {0.5, info.window.width - 0.5})
    for (double r : {0.5, info.window.height - 0.5}) {
      const double latitude = (info.pixelToMap * Eigen::Vector2d(c, r)).y() * info.crs.GetUnit();
      if (std::abs(latitude) > 90.0 + 1e-6)
        Reject(info, "its georeference puts a pixel at latitude " + std::to_string(latitude) +
                         "; accepted is -90 to 90");
    }
}

} // namespace

double MetresOfUnit(const std::string& unit) {
  std::string u;
  for (char c : unit)
    if (c != ' ' && c != '_' && c != '-' && c != '.')
      u += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), u) != names.end();
  };
  if (is({"", "m", "metre", "metres", "meter", "meters"}))
    return 1.0;
  if (is({"km", "kilometre", "kilometres", "kilometer", "kilometers"}))
    return 1000.0;
  if (is({"dm", "decimetre", "decimetres", "decimeter", "decimeters"}))
    return 0.1;
  if (is({"cm", "centimetre", "centimetres", "centimeter", "centimeters"}))
    return 0.01;
  if (is({"ft", "foot", "feet", "internationalfoot", "internationalfeet"}))
    return 0.3048;
  if (is({"usft", "ftus", "footus", "ussurveyfoot", "ussurveyfeet"}))
    return 1200.0 / 3937.0;
  return 0.0;
}

void ReadGeoreference(GDALDataset& dataset, const ElevationOptions& options, ElevationInfo& info) {
  const int width = dataset.GetRasterXSize(), height = dataset.GetRasterYSize();
  if (options.window && options.mapWindow)
    Reject(info, "a window in pixels and one on the map are given; accepted is one of them");
  if (options.pixelSize && (!(*options.pixelSize > 0.0) || !std::isfinite(*options.pixelSize)))
    Reject(info, "pixel size " + std::to_string(*options.pixelSize) +
                     " given; accepted is a positive number");
  info.crs = ReadCrs(dataset, options);
  if (options.crs)
    WarnOfAnotherBody(dataset.GetSpatialRef(), info);

  double g[6] = {0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.georeferenced = dataset.GetGeoTransform(g) == CE_None;
  if (!info.georeferenced) {
    const double size = options.pixelSize.value_or(1.0);
    const double north[6] = {0.0, size, 0.0, size * height, 0.0, -size};
    std::copy(north, north + 6, g);
    if (dataset.GetGCPCount() > 0)
      info.warnings.push_back(
          "its ground control points are not used: warp it first (gdalwarp), or "
          "it has no place on the map");
    if (!options.pixelSize)
      info.warnings.push_back(
          "no georeference: pixels are assumed to be 1 m squares, the top row to "
          "the north; give a pixel size");
    if (info.crs.GetKind() != Crs::Kind::None && !options.crs) {
      info.warnings.push_back("its CRS '" + info.crs.GetName() +
                              "' is not used, since it has no geotransform");
      info.crs = Crs();
    }
    if (info.crs.GetKind() == Crs::Kind::Geographic)
      Reject(info, "a geographic CRS was given for a raster without georeference; give a "
                   "projected one, or georeference the file");
  } else if (info.crs.GetKind() == Crs::Kind::None) {
    info.warnings.push_back("no CRS: map coordinates are assumed to be metres in a plane, without "
                            "longitude and latitude; give a CRS");
  }
  for (double v : g)
    if (!std::isfinite(v))
      Reject(info, "its geotransform has a value that is not finite");
  const double det = g[1] * g[5] - g[2] * g[4];
  const double size = std::hypot(g[1], g[4]) * std::hypot(g[2], g[5]);
  if (!(std::abs(det) > 1e-6 * size) || size == 0.0)
    Reject(info, "its geotransform is degenerate (pixel vectors " + std::to_string(g[1]) + ", " +
                     std::to_string(g[4]) + " and " + std::to_string(g[2]) + ", " +
                     std::to_string(g[5]) + " span no area)");
  info.pixelToMap.linear() << g[1], g[2], g[4], g[5];
  info.pixelToMap.translation() << g[0], g[3];
  info.window = options.mapWindow
                    ? PixelsOf(*options.mapWindow, info.pixelToMap, width, height, info)
                    : CheckedWindow(options, width, height, info);
  info.pixelToMap.translation() =
      info.pixelToMap * Eigen::Vector2d(info.window.column, info.window.row);
  if (options.closesAround)
    CloseAround(info);
  CheckLatitudes(info);
}

void ReadVertical(GDALRasterBand& band, const ElevationOptions& options, ElevationInfo& info) {
  const char* unit = band.GetUnitType();
  info.unit = ToUtf8(unit ? unit : "");
  if (options.verticalScale || options.verticalOffset) {
    info.verticalScale = options.verticalScale.value_or(1.0);
    info.verticalOffset = options.verticalOffset.value_or(0.0);
    if (!std::isfinite(info.verticalScale) || info.verticalScale == 0.0)
      Reject(info, "vertical scale " + std::to_string(info.verticalScale) +
                       " given; accepted is a finite number other than 0");
    if (!std::isfinite(info.verticalOffset))
      Reject(info, "the vertical offset given is not finite");
  } else {
    const double metres = MetresOfUnit(info.unit);
    if (metres == 0.0)
      throw Error(Error::Kind::Unsupported, Object(info),
                  "heights in unit '" + info.unit +
                      "'; known are m, km, dm, cm, ft and US survey feet; else give the vertical "
                      "scale by hand");
    int hasScale = 0, hasOffset = 0;
    const double scale = band.GetScale(&hasScale), offset = band.GetOffset(&hasOffset);
    info.verticalScale = (hasScale ? scale : 1.0) * metres;
    info.verticalOffset = (hasOffset ? offset : 0.0) * metres;
    if (!std::isfinite(info.verticalScale) || info.verticalScale == 0.0 ||
        !std::isfinite(info.verticalOffset))
      Reject(info, "its scale " + std::to_string(scale) + " or offset " + std::to_string(offset) +
                       " is not usable; give them by hand");
    const double radius = info.crs.GetAxes().semiMajor; // an offset of which is in metres
    if (info.unit.empty() &&
        !(radius > 0.0 && std::abs(info.verticalOffset - radius) < 0.1 * radius))
      info.warnings.push_back(
          "the unit of height is not stated: metres are assumed; if that is not "
          "so, give the vertical scale");
  }

  const double a = info.crs.GetAxes().semiMajor;
  GDALDataset* dataset = band.GetDataset();
  const char* item = dataset ? dataset->GetMetadataItem("VERTICAL_DATUM") : nullptr;
  const std::string stated = ToUtf8(item ? item : "");
  if (options.verticalDatum) {
    info.verticalDatum = *options.verticalDatum;
  } else if (item) {
    // Our own item, written as VerticalDatum::Text(). Others' words there are no such text.
    try {
      info.verticalDatum = VerticalDatum::FromText(stated);
    } catch (const Error&) {
      info.verticalDatum.name = stated;
      info.warnings.push_back("its metadata item VERTICAL_DATUM says '" + stated +
                              "', which is not understood; give the vertical datum by hand");
    }
  } else if (!info.crs.GetVerticalName().empty()) {
    // A compound CRS names its vertical part; all registered ones but ellipsoidal heights are
    // tied to a geoid or areoid.
    info.verticalDatum.kind = VerticalDatum::Kind::Geoid;
    info.verticalDatum.name = info.crs.GetVerticalName();
  } else if (a > 0.0 && std::abs(info.verticalOffset - a) < 0.1 * a) {
    // ISIS: radius = multiplier * DN + base. An offset of a body's radius is the file's statement
    // that its values are radii.
    info.verticalDatum.kind = VerticalDatum::Kind::Radius;
  }
  VerticalDatum& datum = info.verticalDatum;
  if ((datum.kind == VerticalDatum::Kind::Radius || datum.kind == VerticalDatum::Kind::Sphere) &&
      datum.radius == 0.0) {
    if (a == 0.0)
      Reject(info, "vertical datum '" + datum.Text() + "' needs a radius (" + datum.Text() +
                       ":R), since there is no CRS that "
                       "has one");
    datum.radius = a;
  }
}

} // namespace dspace
