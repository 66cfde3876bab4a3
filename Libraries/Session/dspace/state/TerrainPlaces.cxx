#include <dspace/state/TerrainPlaces.h>

#include <optional>

#include <dspace/crs/Crs.h>
#include <dspace/messages/Convert.h>
#include <dspace/state/TerrainBody.h>

namespace dspace::session {

void PutCoordinates(const TerrainObject& terrain, const Pose& X_RootS, const Rows3& points_S,
                    const Rows3& map, const KernelSet& kernels, double tdb,
                    v1::CoordinatesReply& reply) {
  const std::vector<BodyCoordinates> places = terrain.Surface().Locate(map);
  const Crs& crs = terrain.Surface().GetCrs();
  const std::optional<Eigen::Matrix3d> turn =
      crs.HasGeographic() ? InertialFromFixed(kernels, crs, tdb) : std::nullopt;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto row = Eigen::Index(i);
    v1::Coordinates* point = reply.add_point();
    point->set_longitude_deg(places[i].longitude_deg);
    point->set_latitude_deg(places[i].latitude_deg);
    point->set_height(places[i].height);
    Put(places[i].bodyFixed, point->mutable_body_fixed());
    Put(map.row(row).transpose(), point->mutable_map());
    Put(X_RootS.Apply(points_S.row(row).transpose()), point->mutable_root());
    if (turn) {
      Put(*turn * places[i].bodyFixed, point->mutable_inertial());
    }
  }
}

} // namespace dspace::session
