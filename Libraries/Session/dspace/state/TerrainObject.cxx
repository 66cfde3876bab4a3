#include <dspace/state/TerrainObject.h>

namespace dspace::session {

void TerrainObject::Describe(v1::TerrainReply& reply) const {
  const TerrainSurface& surface = this->Surface();
  reply.set_crs(surface.GetCrs().GetWkt());
  reply.set_vertical_datum(surface.GetVerticalDatum().Text());
  const Eigen::AlignedBox3d bounds = surface.GetBounds().scene;
  reply.set_west(bounds.min().x());
  reply.set_east(bounds.max().x());
  reply.set_south(bounds.min().y());
  reply.set_north(bounds.max().y());
}

} // namespace dspace::session
