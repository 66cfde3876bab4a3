// The local metric frame in which a terrain in map coordinates is drawn and queried.
#ifndef DSPACE_TERRAIN_SCENEFRAME_H
#define DSPACE_TERRAIN_SCENEFRAME_H

#include <Eigen/Geometry>

#include <dspace/crs/Crs.h>

namespace dspace {

// Right-handed, metres: X to the east, Y to the north of the map, Z up; z is the height above the
// vertical datum less `originHeight`. Scene and map differ by a shift and a factor an axis, so that
// straight lines and the triangles of a grid stay what they are.
//
// Projected, local or no CRS: scene = (map - origin) * metres a unit. Lengths and north are the
// map's: they differ from the ground's by the projection's scale and convergence.
//
// Geographic CRS: the plane of an equidistant cylindrical map true at the origin's latitude p0,
//   X = N cos(p0) (lon - lon0),  Y = M (lat - lat0),
// N and M the ellipsoid's radii of curvature at p0 (both R on a sphere, where this is PROJ's
// +proj=eqc +lat_ts=p0). Y is exact along the meridian; X is too long by cos(p0)/cos(p) at latitude
// p, which is 1 + tan(p0) Y/R nearby (Gale crater, 100 km north of 5.4 S: 0.27 %). The body's
// curvature is not drawn: d^2/2R at a distance d (1 km on Mars: 0.15 m). A window of some degrees
// is drawn well, a whole body only as a flat map.
class SceneFrame {
public:
  // `origin` is in map coordinates. Throws Error(InvalidArgument) when a value is not finite or
  // the origin is within a degree of a pole of a geographic CRS, where east has no direction.
  SceneFrame(const Crs& crs, const Eigen::Vector2d& origin, double originHeight = 0.0);

  const Eigen::Vector2d& GetOrigin() const { return this->Origin_; } // map coordinates
  double GetOriginHeight() const { return this->OriginHeight_; }     // [m]
  // Metres of scene a unit of map along x and y; negative where the map's axis runs west or south.
  const Eigen::Vector2d& GetMetres() const { return this->Metres_; }

  // (map x, map y, height above the datum) to scene, and back.
  Eigen::Vector3d MapToScene(const Eigen::Vector3d& p) const {
    return {(p.x() - this->Origin_.x()) * this->Metres_.x(),
            (p.y() - this->Origin_.y()) * this->Metres_.y(), p.z() - this->OriginHeight_};
  }
  Eigen::Vector3d SceneToMap(const Eigen::Vector3d& p_S) const {
    return {p_S.x() / this->Metres_.x() + this->Origin_.x(),
            p_S.y() / this->Metres_.y() + this->Origin_.y(), p_S.z() + this->OriginHeight_};
  }

  // Where the posts of a raster stand: post (c, r) at pixel coordinates (c + 0.5, r + 0.5).
  Eigen::Affine2d PostToScene(const Eigen::Affine2d& pixelToMap) const;

private:
  Eigen::Vector2d Origin_;
  double OriginHeight_;
  Eigen::Vector2d Metres_;
};

} // namespace dspace

#endif
