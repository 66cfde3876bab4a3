// Geodesics, grid references and geoid heights.
#include <optional>

#include <dspace/Checks.h>
#include <dspace/commands/terrain/TerrainTools.h>
#include <dspace/crs/Geodesics.h>
#include <dspace/crs/GeoidModel.h>
#include <dspace/crs/GridReferences.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

std::string LabelOf(const v1::Ellipsoid& ellipsoid) {
  return ellipsoid.kind_case() == v1::Ellipsoid::kTerrain ? "terrain '" + ellipsoid.terrain() + "'"
                                                          : std::string("ellipsoid");
}

BodyEllipsoid EllipsoidOf(const Context& context, const v1::Ellipsoid& ellipsoid) {
  if (ellipsoid.kind_case() == v1::Ellipsoid::kTerrain) {
    const Crs& crs = FindTerrain(context, ellipsoid.terrain()).Surface().GetCrs();
    if (!crs.HasGeographic()) {
      throw Error(Error::Kind::Unsupported, LabelOf(ellipsoid),
                  "its CRS " +
                      (crs.GetName().empty() ? "is not known" : "'" + crs.GetName() + "'") +
                      ", so that it has no ellipsoid; accepted: a geographic or a projected CRS");
    }
    return {crs.GetAxes().semiMajor, crs.GetAxes().semiMinor};
  }
  if (ellipsoid.kind_case() == v1::Ellipsoid::kAxes) {
    const double radius = ellipsoid.axes().equatorial_radius();
    const double flattening = ellipsoid.axes().flattening();
    Require(radius > 0.0 && radius <= 1e12, "ellipsoid", "its equatorial radius", radius,
            "above 0 to 1e12 m");
    Require(flattening >= 0.0 && flattening <= 0.5, "ellipsoid", "its flattening", flattening,
            "0 (a sphere) to 0.5");
    return {radius, radius * (1.0 - flattening)};
  }
  return Wgs84();
}

// Grid references and geoids exist for the Earth.
void RequireWgs84(const Context& context, const v1::Ellipsoid& given, const char* what) {
  const BodyEllipsoid ellipsoid = EllipsoidOf(context, given);
  if (!IsWgs84(ellipsoid)) {
    throw Error(Error::Kind::Unsupported, LabelOf(given),
                std::string(what) + " are of WGS 84, and its ellipsoid has radii of " +
                    NumberText(ellipsoid.Equatorial()) + " m and " + NumberText(ellipsoid.Polar()) +
                    " m; accepted: 6378137 m and 6356752.3142 m");
  }
}

// Checks all places before any is used.
std::vector<Eigen::Vector2d> PlacesOf(const Numbers& values, const std::string& label,
                                      const char* what) {
  const std::size_t count = RowsOf(values.size(), 2, label, what);
  std::vector<Eigen::Vector2d> places;
  places.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    places.emplace_back(values.data() + 2 * i);
    try {
      RequirePlace(places.back());
    } catch (const Error& error) {
      Reject(label, std::string(what) + " " + std::to_string(i) + ": " + error.what());
    }
  }
  return places;
}

void RequireCount(int count, std::size_t places, const std::string& label, const char* what) {
  if (std::size_t(count) != places) {
    Reject(label, std::to_string(count) + " values of " + what + " are given for " +
                      std::to_string(places) + " places; accepted: one per place");
  }
}

void MeasureGeodesics(const Context& context, v1::MeasureGeodesics& command) {
  const Geodesics body(EllipsoidOf(context, command.ellipsoid()));
  const std::string label = LabelOf(command.ellipsoid());
  const std::vector<Eigen::Vector2d> from = PlacesOf(command.start(), label, "start");
  const std::vector<Eigen::Vector2d> to = PlacesOf(command.end(), label, "end");
  if (from.size() != to.size()) {
    Reject(label, std::to_string(from.size()) + " starts and " + std::to_string(to.size()) +
                      " ends of geodesics are given; accepted: as many");
  }
  v1::GeodesicReply* reply = context.reply.mutable_geodesics();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Geodesic line = body.Between(from[i], to[i]);
    reply->add_distance(line.distance);
    reply->add_azimuth_deg(line.azimuth_deg);
    reply->add_end_azimuth_deg(line.endAzimuth_deg);
  }
}

void FollowGeodesics(const Context& context, v1::FollowGeodesics& command) {
  const Geodesics body(EllipsoidOf(context, command.ellipsoid()));
  const std::string label = LabelOf(command.ellipsoid());
  const std::vector<Eigen::Vector2d> from = PlacesOf(command.start(), label, "start");
  RequireCount(command.azimuth_deg_size(), from.size(), label, "azimuth_deg");
  RequireCount(command.distance_size(), from.size(), label, "distance");
  v1::GeodesicReply reply;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const GeodesicEnd end =
        body.EndOf(from[i], command.azimuth_deg(int(i)), command.distance(int(i)));
    reply.add_end(end.place.x());
    reply.add_end(end.place.y());
    reply.add_end_azimuth_deg(end.azimuth_deg);
  }
  context.reply.mutable_geodesics()->Swap(&reply);
}

void MeasurePolygon(const Context& context, v1::MeasurePolygon& command) {
  const Geodesics body(EllipsoidOf(context, command.ellipsoid()));
  const std::string label = LabelOf(command.ellipsoid());
  const std::vector<Eigen::Vector2d> corners = PlacesOf(command.place(), label, "corner");
  if (corners.size() < 3) {
    Reject(label,
           std::to_string(corners.size()) + " corners of a polygon are given; accepted: 3 or more");
  }
  const GeodesicPolygon polygon = body.Around(corners);
  v1::PolygonReply* reply = context.reply.mutable_polygon();
  reply->set_area(polygon.area);
  reply->set_perimeter(polygon.perimeter);
}

void GetGridReferences(const Context& context, v1::GetGridReferences& command) {
  RequireWgs84(context, command.ellipsoid(), "grid references");
  const std::string label = LabelOf(command.ellipsoid());
  const std::vector<Eigen::Vector2d> places = PlacesOf(command.place(), label, "place");
  std::optional<int> zone;
  if (command.has_zone()) {
    zone = ToInt(command.zone());
  }
  v1::GridReferenceReply reply;
  for (const Eigen::Vector2d& place : places) {
    if (command.has_mgrs_precision()) {
      reply.add_mgrs(MgrsOf(place, ToInt(command.mgrs_precision()), zone));
      continue;
    }
    const UtmPlace utm = UtmOf(place, zone);
    reply.add_zone(std::uint32_t(utm.zone));
    reply.add_north(utm.north);
    reply.add_easting(utm.easting);
    reply.add_northing(utm.northing);
  }
  context.reply.mutable_grid_references()->Swap(&reply);
}

void FindGridReferences(const Context& context, v1::FindGridReferences& command) {
  RequireWgs84(context, command.ellipsoid(), "grid references");
  const std::string label = LabelOf(command.ellipsoid());
  const auto count = std::size_t(command.zone_size());
  RequireCount(command.north_size(), count, label, "north");
  RequireCount(command.easting_size(), count, label, "easting");
  RequireCount(command.northing_size(), count, label, "northing");
  if (count != 0 && command.mgrs_size() != 0) {
    Reject(label, "UTM coordinates and MGRS references are both given; accepted: one of them");
  }
  v1::GeodeticPlaces reply;
  const auto put = [&reply](const Eigen::Vector2d& place) {
    reply.add_place(place.x());
    reply.add_place(place.y());
  };
  for (int i = 0; i < int(count); ++i) {
    put(PlaceOfUtm(
        {ToInt(command.zone(i)), command.north(i), command.easting(i), command.northing(i)}));
  }
  for (const std::string& reference : command.mgrs()) {
    const MgrsSquare square = SquareOfMgrs(reference);
    put(square.center);
    reply.add_side(square.side);
  }
  context.reply.mutable_geodetic_places()->Swap(&reply);
}

void GetGeoidHeights(const Context& context, v1::GetGeoidHeights& command) {
  RequireWgs84(context, command.ellipsoid(), "geoid heights");
  const std::vector<Eigen::Vector2d> places =
      PlacesOf(command.place(), LabelOf(command.ellipsoid()), "place");
  GeoidModel geoid(command.geoid().empty() ? GeoidModel::Standard : command.geoid());
  v1::GeoidHeightReply reply;
  for (const Eigen::Vector2d& place : places) {
    reply.add_height(geoid.Height(place));
  }
  context.reply.mutable_geoid_heights()->Swap(&reply);
}

} // namespace

void AddGeodesyRequests(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kMeasureGeodesics, &C::mutable_measure_geodesics, MeasureGeodesics);
  registry.Add(C::kFollowGeodesics, &C::mutable_follow_geodesics, FollowGeodesics);
  registry.Add(C::kMeasurePolygon, &C::mutable_measure_polygon, MeasurePolygon);
  registry.Add(C::kGetGridReferences, &C::mutable_get_grid_references, GetGridReferences);
  registry.Add(C::kFindGridReferences, &C::mutable_find_grid_references, FindGridReferences);
  registry.Add(C::kGetGeoidHeights, &C::mutable_get_geoid_heights, GetGeoidHeights);
}

} // namespace dspace::session
