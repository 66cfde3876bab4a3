#include <dspace/state/TerrainObject.h>

namespace dspace::session {

void TerrainObject::Describe(v1::TerrainReply& reply) const {
  const TerrainSurface& surface = this->Surface();
  reply.set_crs(surface.GetCrs().GetWkt());
  reply.set_vertical_datum(surface.GetVerticalDatum().Text());
  const RasterPlace place = this->Place();
  const Eigen::Vector2d first = place.pixelToMap.translation();
  const Eigen::Vector2d last = place.pixelToMap * Eigen::Vector2d(place.columns, place.rows);
  for (const double value : {first.x(), first.y(), last.x(), last.y()}) {
    reply.add_map_extent(value);
  }
  const Eigen::AlignedBox3d bounds = surface.GetBounds().scene;
  reply.set_west(bounds.min().x());
  reply.set_east(bounds.max().x());
  reply.set_south(bounds.min().y());
  reply.set_north(bounds.max().y());
}

} // namespace dspace::session
