#include <dspace/surface/TerrainSurface.h>

#include <cmath>

#include <dspace/Error.h>
#include <dspace/crs/CrsTransform.h>

namespace dspace {

namespace {

[[noreturn]] void Reject(const std::string& object, const std::string& message) {
  throw Error(Error::Kind::InvalidArgument, object, message);
}

template<typename Vector>
void CheckFinite(const std::string& object, const char* what, const Vector& v) {
  if (v.allFinite())
    return;
  std::string values;
  for (Eigen::Index i = 0; i < v.size(); ++i)
    values += (i ? ", " : "") + std::to_string(v[i]);
  Reject(object, std::string(what) + " (" + values + ") is not finite");
}

template<typename Rows>
void CheckRows(const std::string& object, const char* what, const Rows& rows,
               Eigen::Index results) {
  if (rows.rows() != results)
    Reject(object,
           std::to_string(results) + " results for " + std::to_string(rows.rows()) + " " + what);
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    if (!rows.row(i).allFinite())
      Reject(object, std::string(what) + ": row " + std::to_string(i) + " is not finite");
}

double Wrapped(double longitude_deg) {
  double wrapped = std::fmod(longitude_deg + 180.0, 360.0);
  if (wrapped < 0.0)
    wrapped += 360.0;
  return wrapped >= 360.0 ? -180.0 : wrapped - 180.0;
}

} // namespace

TerrainSurface::TerrainSurface(std::string name, Crs crs, VerticalDatum datum,
                               std::vector<std::string> warnings)
    : Name_(std::move(name)), Crs_(std::move(crs)), VerticalDatum_(std::move(datum)),
      Warnings_(std::move(warnings)) {
  if (!this->Crs_.HasGeographic())
    return;
  const Crs geographic = this->Crs_.Geographic();
  this->GeographicSigns_ = geographic.GetAxisSigns();
  this->GeographicUnit_ = geographic.GetUnit();
  if (this->Crs_.GetKind() == Crs::Kind::Projected)
    this->Geographic_ = std::make_unique<CrsTransform>(this->Crs_, geographic);
}

TerrainSurface::~TerrainSurface() = default;

TerrainBounds TerrainSurface::GetBounds() const {
  return this->DoGetBounds();
}

SurfaceSample TerrainSurface::Sample(const Eigen::Vector3d& p_S) const {
  CheckFinite(this->Name_, "point", p_S);
  return this->DoSample(p_S);
}

SurfaceSample TerrainSurface::SampleMap(const Eigen::Vector2d& map) const {
  CheckFinite(this->Name_, "map point", map);
  return this->DoSampleMap(map);
}

// A Ref is a view that is written through, and is passed by value.
// NOLINTBEGIN(performance-unnecessary-value-param)
void TerrainSurface::Heights(const Eigen::Ref<const Rows3>& points_S,
                             Eigen::Ref<Eigen::VectorXd> heights) const {
  CheckRows(this->Name_, "points", points_S, heights.size());
  this->DoHeights(points_S, heights);
}

void TerrainSurface::HeightsMap(const Eigen::Ref<const Rows2>& map,
                                Eigen::Ref<Eigen::VectorXd> heights) const {
  CheckRows(this->Name_, "map points", map, heights.size());
  this->DoHeightsMap(map, heights);
}
// NOLINTEND(performance-unnecessary-value-param)

void TerrainSurface::Normals(const Eigen::Ref<const Rows3>& points_S,
                             Eigen::Ref<Rows3> normals_S) const {
  CheckRows(this->Name_, "points", points_S, normals_S.rows());
  for (Eigen::Index i = 0; i < points_S.rows(); ++i)
    normals_S.row(i) = this->DoSample(points_S.row(i)).normal_S;
}

void TerrainSurface::Slopes(const Eigen::Ref<const Rows3>& points_S,
                            Eigen::Ref<Eigen::VectorXd> slopes_deg) const {
  CheckRows(this->Name_, "points", points_S, slopes_deg.size());
  for (Eigen::Index i = 0; i < points_S.rows(); ++i)
    slopes_deg[i] = this->DoSample(points_S.row(i)).slope_deg;
}

void TerrainSurface::Aspects(const Eigen::Ref<const Rows3>& points_S,
                             Eigen::Ref<Eigen::VectorXd> aspects_deg) const {
  CheckRows(this->Name_, "points", points_S, aspects_deg.size());
  for (Eigen::Index i = 0; i < points_S.rows(); ++i) {
    const Eigen::Vector3d p_S = points_S.row(i);
    const Eigen::Vector3d north = this->DoNorth(p_S);
    const Eigen::Vector3d normal = this->DoSample(p_S).normal_S;
    const double toNorth = normal.dot(north);
    const double toEast = normal.dot(north.cross(this->DoUp(p_S)));
    // Written so that NaN is level; what is left of a level normal is rounding.
    const bool slopes = std::hypot(toNorth, toEast) > 1e-12;
    const double azimuth_deg = std::atan2(toEast, toNorth) * 180.0 / M_PI;
    aspects_deg[i] = !slopes             ? std::numeric_limits<double>::quiet_NaN()
                     : azimuth_deg < 0.0 ? std::fmod(azimuth_deg + 360.0, 360.0)
                                         : azimuth_deg;
  }
}

RayHit TerrainSurface::Intersect(const Eigen::Vector3d& origin_S,
                                 const Eigen::Vector3d& direction_S, double maximumDistance) const {
  CheckFinite(this->Name_, "ray origin", origin_S);
  CheckFinite(this->Name_, "ray direction", direction_S);
  const double length = direction_S.stableNorm();
  if (!(length > 0.0))
    Reject(this->Name_, "ray direction is zero");
  if (!(maximumDistance >= 0.0))
    Reject(this->Name_,
           "maximum distance " + std::to_string(maximumDistance) + " given; accepted is 0 or more");
  return this->DoIntersect(origin_S, direction_S.stableNormalized(), maximumDistance);
}

void TerrainSurface::Intersect(const Eigen::Ref<const Rows3>& origins_S,
                               const Eigen::Ref<const Rows3>& directions_S, double maximumDistance,
                               Eigen::Ref<Eigen::VectorXd> distances) const {
  CheckRows(this->Name_, "ray origins", origins_S, distances.size());
  CheckRows(this->Name_, "ray directions", directions_S, distances.size());
  if (!(maximumDistance >= 0.0))
    Reject(this->Name_,
           "maximum distance " + std::to_string(maximumDistance) + " given; accepted is 0 or more");
  for (Eigen::Index i = 0; i < directions_S.rows(); ++i)
    if (directions_S.row(i).isZero(0.0))
      Reject(this->Name_, "ray directions: row " + std::to_string(i) + " is zero");
  for (Eigen::Index i = 0; i < distances.size(); ++i)
    distances[i] =
        this->DoIntersect(origins_S.row(i), directions_S.row(i).stableNormalized(), maximumDistance)
            .distance;
}

Eigen::Vector3d TerrainSurface::MapToScene(const Eigen::Vector3d& map) const {
  CheckFinite(this->Name_, "map point", map);
  return this->DoMapToScene(map);
}

Eigen::Vector3d TerrainSurface::SceneToMap(const Eigen::Vector3d& p_S) const {
  CheckFinite(this->Name_, "point", p_S);
  return this->DoSceneToMap(p_S);
}

Eigen::Vector3d TerrainSurface::MapToGeographic(const Eigen::Vector3d& map) const {
  CheckFinite(this->Name_, "map point", map);
  if (!this->Crs_.HasGeographic())
    this->Crs_.Geographic(); // throws, naming the CRS
  Eigen::Vector2d p = map.head<2>();
  if (this->Geographic_)
    p = this->Geographic_->Apply(p);
  p = p.cwiseProduct(this->GeographicSigns_) * this->GeographicUnit_;
  return {Wrapped(p.x()), p.y(), map.z()};
}

Eigen::Vector3d TerrainSurface::GeographicToMap(const Eigen::Vector3d& lonLatHeight) const {
  CheckFinite(this->Name_, "longitude, latitude, height", lonLatHeight);
  if (!this->Crs_.HasGeographic())
    this->Crs_.Geographic(); // throws, naming the CRS
  if (std::abs(lonLatHeight.y()) > 90.0)
    Reject(this->Name_,
           "latitude " + std::to_string(lonLatHeight.y()) + " given; accepted is -90 to 90");
  Eigen::Vector2d p =
      lonLatHeight.head<2>().cwiseProduct(this->GeographicSigns_) / this->GeographicUnit_;
  p = this->TowardsData(this->Geographic_ ? this->Geographic_->ApplyInverse(p) : p);
  return {p.x(), p.y(), lonLatHeight.z()};
}

Eigen::Vector3d TerrainSurface::MapToCrs(const Eigen::Vector3d& map, const Crs& crs) const {
  CheckFinite(this->Name_, "map point", map);
  const Eigen::Vector2d p = CrsTransform(this->Crs_, crs).Apply(map.head<2>());
  return {p.x(), p.y(), map.z()};
}

Eigen::Vector3d TerrainSurface::CrsToMap(const Eigen::Vector3d& p, const Crs& crs) const {
  CheckFinite(this->Name_, "point", p);
  const Eigen::Vector2d map = this->TowardsData(CrsTransform(crs, this->Crs_).Apply(p.head<2>()));
  return {map.x(), map.y(), p.z()};
}

std::vector<BodyCoordinates> TerrainSurface::Locate(const Eigen::Ref<const Rows3>& map) const {
  CheckRows(this->Name_, "map points", map, map.rows());
  std::vector<BodyCoordinates> places(std::size_t(map.rows()));
  if (!this->Crs_.HasGeographic())
    return places;
  Eigen::Matrix2Xd points = map.leftCols<2>().transpose();
  if (this->Geographic_)
    this->Geographic_->TryApply(points);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Eigen::Vector2d p =
        points.col(Eigen::Index(i)).cwiseProduct(this->GeographicSigns_) * this->GeographicUnit_;
    if (p.allFinite())
      places[i] = BodyCoordinatesOf(this->Crs_.GetAxes(), this->VerticalDatum_, Wrapped(p.x()),
                                    p.y(), map(Eigen::Index(i), 2));
  }
  return places;
}

// A grid may run from 0 to 360 or from -180 to 180, or past the edge of a cylindrical map: whole
// turns are added until the point is within half a turn of its middle.
Eigen::Vector2d TerrainSurface::TowardsData(const Eigen::Vector2d& map) const {
  const Eigen::AlignedBox2d box = this->DoGetBounds().map;
  if (box.isEmpty() || box.contains(map) || !this->Crs_.HasGeographic())
    return map;
  double turn = 360.0 / this->Crs_.GetUnit();
  if (this->Geographic_) {
    // How far the map runs a degree of longitude, here; a whole turn is 360 times that if the map
    // is cylindrical, which is seen by coming back to the same place.
    const Eigen::Vector2d place = this->Geographic_->Apply(map);
    const Eigen::Vector2d aside =
        this->Geographic_->ApplyInverse(place + Eigen::Vector2d(1e-3, 0.0));
    turn = std::abs((aside - map).x()) * 360e3 / this->GeographicUnit_;
    const double turns = std::round((map.x() - box.center().x()) / turn);
    const Eigen::Vector2d there(map.x() - turn * turns, map.y());
    if (turns == 0.0 || !std::isfinite(there.x()))
      return map;
    const Eigen::Vector2d again = this->Geographic_->Apply(there);
    const bool same =
        std::abs(again.y() - place.y()) < 1e-9 &&
        std::abs(std::remainder(again.x() - place.x(), 360.0 / this->GeographicUnit_)) < 1e-6;
    if (!same)
      return map;
    // The turn by differences is good to some 1e-7 of itself; what is left is a small step.
    const double rest = std::remainder(place.x() - again.x(), 360.0 / this->GeographicUnit_);
    return {there.x() + rest * (aside - map).x() / 1e-3, there.y()};
  }
  return {map.x() - turn * std::round((map.x() - box.center().x()) / turn), map.y()};
}

Eigen::Vector3d TerrainSurface::Up(const Eigen::Vector3d& p_S) const {
  CheckFinite(this->Name_, "point", p_S);
  return this->DoUp(p_S);
}

Eigen::Vector3d TerrainSurface::North(const Eigen::Vector3d& p_S) const {
  CheckFinite(this->Name_, "point", p_S);
  return this->DoNorth(p_S);
}

Eigen::Vector3d TerrainSurface::DoNorth(const Eigen::Vector3d&) const {
  return Eigen::Vector3d::UnitY();
}

int TerrainSurface::ResidentLevel(const Eigen::Vector2d& map) const {
  CheckFinite(this->Name_, "map point", map);
  return this->DoResidentLevel(map);
}

void TerrainSurface::DoHeights(const Eigen::Ref<const Rows3>& points_S,
                               Eigen::Ref<Eigen::VectorXd> heights) const {
  for (Eigen::Index i = 0; i < points_S.rows(); ++i)
    heights[i] = this->DoSample(points_S.row(i)).height;
}

void TerrainSurface::DoHeightsMap(const Eigen::Ref<const Rows2>& map,
                                  Eigen::Ref<Eigen::VectorXd> heights) const {
  for (Eigen::Index i = 0; i < map.rows(); ++i)
    heights[i] = this->DoSampleMap(map.row(i)).height;
}

} // namespace dspace
