#include <dspace/layers/raster/RasterPlacing.h>

#include <cmath>
#include <limits>
#include <optional>

#include <dspace/Error.h>
#include <dspace/layers/raster/ImageLayer.h>

#include <dspace/crs/CrsTransform.h>
#include <dspace/crs/MapTurn.h>

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;
constexpr double OneBody = 0.01; // of an axis: what spheres of one body differ by at most
constexpr int Places = 33;       // a side, at which an overlap is looked for

std::string NameOf(const Crs& crs) {
  return "'" + crs.GetName() + "' (semi-major axis " +
         std::to_string(std::llround(crs.GetAxes().semiMajor)) + " m)";
}

void RejectAnotherBody(const std::string& object, const Crs& raster, const RasterPlace& terrain) {
  const double a = raster.GetAxes().semiMajor;
  const double b = terrain.crs.GetAxes().semiMajor;
  if (a > 0.0 && b > 0.0 && std::abs(a - b) > OneBody * b) {
    throw Error(Error::Kind::Unsupported, object,
                "it is of another body: its CRS is " + NameOf(raster) + ", that of " +
                    terrain.name + " is " + NameOf(terrain.crs) +
                    "; accepted is one of the same body");
  }
}

Eigen::Affine2d PixelToMap(RasterLevels& levels, const RasterPlace& terrain,
                           const RasterLayerOptions& options, Crs& crs) {
  const std::string& object = levels.Object();
  const RasterContent::Georeference& own = levels.Place();
  crs = options.crs ? Crs::FromText(*options.crs) : own.crs;
  Eigen::Affine2d map = own.pixelToMap;
  const Eigen::Vector2d size(levels.Width(), levels.Height());
  if (options.extent) {
    const auto [left, top, right, bottom] = *options.extent;
    if (!std::isfinite(left + top + right + bottom) || left == right || top == bottom) {
      throw Error(Error::Kind::InvalidArgument, object,
                  "its extent must be finite and span an area");
    }
    map.linear() << (right - left) / size.x(), 0.0, 0.0, (bottom - top) / size.y();
    map.translation() << left, top;
  } else if (!own.placed) {
    levels.Warnings().push_back(object +
                                " has no georeference: it is stretched over the terrain; give its "
                                "extent");
    map = terrain.pixelToMap;
    map.linear() = map.linear() *
                   Eigen::Vector2d(terrain.columns, terrain.rows).cwiseQuotient(size).asDiagonal();
    crs = terrain.crs;
    return map;
  }
  const double det = std::abs(map.linear().determinant());
  if (!map.matrix().allFinite() ||
      !(det > 1e-6 * map.linear().col(0).norm() * map.linear().col(1).norm())) {
    throw Error(Error::Kind::InvalidArgument, object,
                "its geotransform is degenerate; give its extent");
  }
  if (crs.GetKind() == Crs::Kind::None && terrain.crs.GetKind() != Crs::Kind::None) {
    levels.Warnings().push_back(object + " has no CRS: the terrain's is used; give its CRS");
    crs = terrain.crs;
  } else if (crs.GetKind() != Crs::Kind::None && terrain.crs.GetKind() == Crs::Kind::None) {
    levels.Warnings().push_back(terrain.name + " has no CRS: that of " + object +
                                " is used for both; give the terrain's CRS");
  }
  return map;
}

// Columns that go once around, to a hundredth of a pixel, go around exactly.
void CloseAround(RasterPosition& position, Eigen::Affine2d& pixelToMap) {
  if (pixelToMap.linear()(1, 0) != 0.0 || pixelToMap.linear()(0, 1) != 0.0) {
    return;
  }
  position.turn = MapTurn(position.crs) / std::abs(pixelToMap.linear()(0, 0));
  const double off = position.turn - position.width; // a gap, or less than 0 an overlap
  position.periodic = position.turn > 0.0 && off > -0.5 && off < 1.01;
  if (position.periodic && std::abs(off) < 0.01) {
    const double step = pixelToMap.linear()(0, 0);
    const double exact = step * position.turn / position.width;
    pixelToMap.translation().x() += 0.5 * position.width * (step - exact);
    pixelToMap.linear()(0, 0) = exact;
    position.turn = position.width;
  }
}

Eigen::Vector2d Applied(const CrsTransform* transform, const Eigen::Vector2d& p, bool inverse) {
  if (!transform) {
    return p;
  }
  try {
    return inverse ? transform->ApplyInverse(p) : transform->Apply(p);
  } catch (const Error&) {
    return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
}

// A pixel that lies on the terrain: of some places over both the nearest to the raster's middle.
std::optional<Eigen::Vector2d> PixelOnTerrain(const RasterPosition& raster,
                                              const Eigen::Affine2d& pixelToMap,
                                              const RasterPlace& terrain,
                                              const CrsTransform* toRaster) {
  const Eigen::Vector2d size(raster.width, raster.height);
  const Eigen::Vector2d ground(terrain.columns, terrain.rows);
  const Eigen::Affine2d mapToGround = terrain.pixelToMap.inverse();
  const double turn = std::abs(mapToGround.linear()(0, 0)) * MapTurn(terrain.crs);
  const auto inside = [](Eigen::Vector2d p, const Eigen::Vector2d& all, double around) {
    if (around > 0.0) {
      p.x() -= around * std::round((p.x() - 0.5 * all.x()) / around);
    }
    return p.allFinite() && (p.array() >= 0.0).all() && (p.array() <= all.array()).all();
  };
  std::optional<Eigen::Vector2d> best;
  const auto take = [&](const Eigen::Vector2d& pixel) {
    const auto off = [&](const Eigen::Vector2d& p) {
      return (p - 0.5 * size).cwiseQuotient(size).norm();
    };
    best = !best || off(pixel) < off(*best) ? pixel : *best;
  };
  for (int j = 0; j < Places; ++j) {
    for (int i = 0; i < Places; ++i) {
      const Eigen::Vector2d part((i + 0.5) / Places, (j + 0.5) / Places);
      const Eigen::Vector2d pixel = part.cwiseProduct(size);
      const Eigen::Vector2d map = Applied(toRaster, pixelToMap * pixel, true);
      if (inside(mapToGround * map, ground, turn)) {
        take(pixel);
      }
      const Eigen::Vector2d there =
          raster.mapToPixel *
          Applied(toRaster, terrain.pixelToMap * part.cwiseProduct(ground), false);
      if (inside(there, size, raster.turn)) {
        take(there);
      }
    }
  }
  return best;
}

// The lesser side of a pixel [m].
double PixelSize(const RasterPosition& raster, const Eigen::Affine2d& pixelToMap,
                 const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d sides(pixelToMap.linear().col(0).norm(), pixelToMap.linear().col(1).norm());
  const Crs& crs = raster.crs;
  double least = sides.minCoeff() * crs.GetUnit();
  if (!crs.HasGeographic()) {
    return least;
  }
  const Crs below = crs.Geographic();
  const CrsTransform geographic(crs, below);
  const auto direction = [&](const Eigen::Vector2d& at) {
    const Eigen::Vector2d p =
        Applied(&geographic, pixelToMap * at, false) * below.GetUnit() * Degree;
    return Eigen::Vector3d(std::cos(p.y()) * std::cos(p.x()), std::cos(p.y()) * std::sin(p.x()),
                           std::sin(p.y()));
  };
  if (crs.GetKind() == Crs::Kind::Geographic) {
    least *= Degree * crs.GetAxes().semiMajor;
  }
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d half = 0.5 * Eigen::Vector2d::Unit(axis);
    const double metres =
        crs.GetAxes().semiMajor * (direction(pixel + half) - direction(pixel - half)).norm();
    if (metres > 0.0) { // and finite
      least = std::min(axis == 0 ? std::numeric_limits<double>::infinity() : least, metres);
    }
  }
  return least;
}

} // namespace

PlacedRaster PlaceRaster(RasterLevels& levels, const RasterPlace& terrain,
                         const RasterLayerOptions& options) {
  Crs crs;
  const Eigen::Affine2d pixelToMap = PixelToMap(levels, terrain, options, crs);
  return PlaceRasterAt(levels, terrain, crs, pixelToMap);
}

PlacedRaster PlaceRasterAt(RasterLevels& levels, const RasterPlace& terrain, const Crs& crs,
                           Eigen::Affine2d pixelToMap) {
  PlacedRaster placed;
  RasterPosition& position = placed.position;
  position.width = levels.Width();
  position.height = levels.Height();
  position.crs = crs;
  RejectAnotherBody(levels.Object(), position.crs, terrain);
  CloseAround(position, pixelToMap);
  position.mapToPixel = pixelToMap.inverse();
  std::unique_ptr<CrsTransform> toRaster;
  if (position.crs.Ogr() && terrain.crs.Ogr() && position.crs.GetWkt() != terrain.crs.GetWkt()) {
    try {
      toRaster = std::make_unique<CrsTransform>(terrain.crs, position.crs);
    } catch (const Error& error) {
      throw Error(error.GetKind(), levels.Object(), error.what());
    }
  }
  const auto pixel = PixelOnTerrain(position, pixelToMap, terrain, toRaster.get());
  if (!pixel) {
    throw Error(Error::Kind::InvalidArgument, levels.Object(),
                "it does not overlap " + terrain.name);
  }
  placed.pixelSize = PixelSize(position, pixelToMap, *pixel);
  return placed;
}

} // namespace dspace
