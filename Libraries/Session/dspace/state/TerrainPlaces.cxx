#include <dspace/state/TerrainPlaces.h>

#include <dspace/messages/Convert.h>

namespace dspace::session {

void PutCoordinates(const TerrainObject& terrain, const Pose& X_RootS, const Rows3& points_S,
                    const Rows3& map, v1::CoordinatesReply& reply) {
  const std::vector<BodyCoordinates> places = terrain.Surface().Locate(map);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto row = Eigen::Index(i);
    v1::Coordinates* point = reply.add_point();
    point->set_longitude_deg(places[i].longitude_deg);
    point->set_latitude_deg(places[i].latitude_deg);
    point->set_height(places[i].height);
    Put(places[i].bodyFixed, point->mutable_body_fixed());
    Put(map.row(row).transpose(), point->mutable_map());
    Put(X_RootS.Apply(points_S.row(row).transpose()), point->mutable_root());
  }
}

} // namespace dspace::session
