// Interface of all terrains: height, normal, slope, rays, map and scene coordinates.
#ifndef DSPACE_TERRAIN_TERRAINSURFACE_H
#define DSPACE_TERRAIN_TERRAINSURFACE_H

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/crs/BodyCoordinates.h>
#include <dspace/crs/Crs.h>
#include <dspace/crs/CrsTransform.h>
#include <dspace/crs/VerticalDatum.h>

namespace dspace {

// Points or vectors, one a row, as a C-ordered numpy array of shape (n, 3) or (n, 2) holds them.
using Rows3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Rows2 = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

// The surface above or below a point. Outside the data, and in holes, `valid` is false, `level` is
// -1 and every number is NaN.
struct SurfaceSample {
  bool valid = false;
  int level = -1; // resolution that answered: 0 is the source's own, each further one half of it
  double height = std::numeric_limits<double>::quiet_NaN();    // [m] above the vertical datum
  double slope_deg = std::numeric_limits<double>::quiet_NaN(); // normal against the local up, 0..90
  Eigen::Vector3d position_S =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()); // on the surface
  Eigen::Vector3d normal_S =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()); // unit, upward
};

// The first place where a ray meets the surface, from above or from below. Where it meets nothing,
// `hit` is false, `distance` +infinity and the vectors NaN.
struct RayHit {
  bool hit = false;
  bool fromBelow = false;                                    // the surface's under side
  double distance = std::numeric_limits<double>::infinity(); // [m] along the ray from its origin
  Eigen::Vector3d position_S = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Vector3d normal_S = // unit, upward also when met from below
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
};

// Axis-aligned cut of the map that has data, and of the scene; empty boxes where nothing is loaded.
struct TerrainBounds {
  Eigen::AlignedBox2d map;   // map units; from first to last post
  Eigen::AlignedBox3d scene; // [m]
};

// Abstract. Scene coordinates (S) are metres, right-handed; what is "up" at a point is the
// surface's matter (Z for a local grid, radial for a whole body), hence queries take a point of
// space and look along its local vertical: its height does not matter. Map coordinates (x, y) are
// those of GetCrs(), easting or longitude first; a third component is the height above the vertical
// datum in metres. All numbers are doubles, metres and degrees.
//
// One surface between the posts, for drawing, queries and analyses: triangles.
//
// Each public call checks its arguments (Error(InvalidArgument) naming what is not finite or out of
// range) and hands them to a protected virtual. Const calls may run on several threads at once.
class TerrainSurface {
public:
  virtual ~TerrainSurface();
  TerrainSurface(const TerrainSurface&) = delete;
  TerrainSurface& operator=(const TerrainSurface&) = delete;

  // The name for messages: "terrain 'gale.tif'".
  const std::string& GetName() const { return this->Name_; }
  const Crs& GetCrs() const { return this->Crs_; }
  const VerticalDatum& GetVerticalDatum() const { return this->VerticalDatum_; }
  // Assumptions and doubts about place and height, as shown to the user.
  const std::vector<std::string>& GetWarnings() const { return this->Warnings_; }
  TerrainBounds GetBounds() const;
  // Changes with every change of query results or of the drawn surface (including loaded tiles).
  virtual std::uint64_t GetVersion() const { return 0; }

  // One point, in scene or in map coordinates.
  SurfaceSample Sample(const Eigen::Vector3d& p_S) const;
  SurfaceSample SampleMap(const Eigen::Vector2d& map) const;

  // Arrays: one value a row; NaN where a single query is not valid. Results have the rows of
  // `points`, or Error(InvalidArgument).
  void Heights(const Eigen::Ref<const Rows3>& points_S, Eigen::Ref<Eigen::VectorXd> heights) const;
  void HeightsMap(const Eigen::Ref<const Rows2>& map, Eigen::Ref<Eigen::VectorXd> heights) const;
  void Normals(const Eigen::Ref<const Rows3>& points_S, Eigen::Ref<Rows3> normals_S) const;
  void Slopes(const Eigen::Ref<const Rows3>& points_S,
              Eigen::Ref<Eigen::VectorXd> slopes_deg) const;
  // Azimuth of steepest descent [deg], clockwise from north, 0 to 360; NaN on level ground too.
  void Aspects(const Eigen::Ref<const Rows3>& points_S,
               Eigen::Ref<Eigen::VectorXd> aspects_deg) const;

  // First crossing of origin + t * direction / |direction| for 0 <= t <= maximumDistance [m]. The
  // direction need not be unit, but must not be zero. A ray that starts on the surface meets it at
  // distance 0 or not at all: lift the origin where that matters.
  RayHit Intersect(const Eigen::Vector3d& origin_S, const Eigen::Vector3d& direction_S,
                   double maximumDistance = std::numeric_limits<double>::infinity()) const;
  // Distances [m], +infinity where nothing is met.
  void Intersect(const Eigen::Ref<const Rows3>& origins_S,
                 const Eigen::Ref<const Rows3>& directions_S, double maximumDistance,
                 Eigen::Ref<Eigen::VectorXd> distances) const;

  // (map x, map y, height [m]) to scene, and back. Also outside the data.
  Eigen::Vector3d MapToScene(const Eigen::Vector3d& map) const;
  Eigen::Vector3d SceneToMap(const Eigen::Vector3d& p_S) const;

  // (longitude east-positive in [-180, 180), latitude [deg], height [m]) on the CRS's own
  // ellipsoid (geodetic latitude; on a sphere that is the planetocentric one). Longitudes are
  // taken modulo 360, towards the data. Error(Unsupported) when the CRS has no longitude and
  // latitude; Error(InvalidArgument) where the projection has no value.
  Eigen::Vector3d MapToGeographic(const Eigen::Vector3d& map) const;
  Eigen::Vector3d GeographicToMap(const Eigen::Vector3d& longitudeLatitudeHeight) const;
  // The same in another CRS of the same body. Builds a conversion each time: for arrays, hold a
  // CrsTransform.
  Eigen::Vector3d MapToCrs(const Eigen::Vector3d& map, const Crs& crs) const;
  Eigen::Vector3d CrsToMap(const Eigen::Vector3d& p, const Crs& crs) const;

  // Map points (x, y, height [m]) in the coordinates of their body, on the CRS's own ellipsoid; NaN
  // where the CRS has no longitude and latitude, and where the projection has no value.
  std::vector<BodyCoordinates> Locate(const Eigen::Ref<const Rows3>& map) const;

  // The local vertical, unit.
  Eigen::Vector3d Up(const Eigen::Vector3d& p_S) const;
  // Level, unit, to the north: Y on a plane, where it is the map's. At a body's poles along the
  // meridian of longitude 0.
  Eigen::Vector3d North(const Eigen::Vector3d& p_S) const;

  // Finest level that can answer at a map point now; -1 outside the data and where none is loaded.
  int ResidentLevel(const Eigen::Vector2d& map) const;

protected:
  TerrainSurface(std::string name, Crs crs, VerticalDatum datum, std::vector<std::string> warnings);

  // For warnings after the data is loaded. Only during construction.
  void AddWarning(std::string warning) { this->Warnings_.push_back(std::move(warning)); }

  virtual TerrainBounds DoGetBounds() const = 0;
  virtual SurfaceSample DoSample(const Eigen::Vector3d& p_S) const = 0;
  virtual SurfaceSample DoSampleMap(const Eigen::Vector2d& map) const = 0;
  virtual RayHit DoIntersect(const Eigen::Vector3d& origin_S, const Eigen::Vector3d& unit_S,
                             double maximumDistance) const = 0;
  virtual Eigen::Vector3d DoMapToScene(const Eigen::Vector3d& map) const = 0;
  virtual Eigen::Vector3d DoSceneToMap(const Eigen::Vector3d& p_S) const = 0;
  virtual Eigen::Vector3d DoUp(const Eigen::Vector3d& p_S) const = 0;
  virtual Eigen::Vector3d DoNorth(const Eigen::Vector3d& p_S) const; // Y by default
  virtual int DoResidentLevel(const Eigen::Vector2d& map) const = 0;
  // By default a loop over DoSample and DoSampleMap.
  virtual void DoHeights(const Eigen::Ref<const Rows3>& points_S,
                         Eigen::Ref<Eigen::VectorXd> heights) const;
  virtual void DoHeightsMap(const Eigen::Ref<const Rows2>& map,
                            Eigen::Ref<Eigen::VectorXd> heights) const;

private:
  Eigen::Vector2d TowardsData(const Eigen::Vector2d& map) const;

  std::string Name_;
  Crs Crs_;
  VerticalDatum VerticalDatum_;
  std::vector<std::string> Warnings_;
  std::unique_ptr<CrsTransform> Geographic_; // map to longitude, latitude; null without them
  Eigen::Vector2d GeographicSigns_ = Eigen::Vector2d::Ones();
  double GeographicUnit_ = 1.0;
};

} // namespace dspace

#endif
