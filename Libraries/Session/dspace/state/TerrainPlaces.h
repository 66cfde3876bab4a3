// The coordinates of places on a terrain, and the values of its fields there, as messages.
#ifndef DSPACE_SESSION_TERRAIN_PLACES_H
#define DSPACE_SESSION_TERRAIN_PLACES_H

#include <dspace/Pose.h>
#include <dspace/proto/terrain.pb.h>
#include <dspace/state/TerrainObject.h>

namespace dspace {
class KernelSet;
} // namespace dspace

namespace dspace::session {

// `points_S` and `map` (x, y, height) are the same points; `X_RootS` is the pose of the terrain's
// frame in the scene's root. Longitude to body-fixed coordinates are NaN where the terrain's CRS
// has none; the inertial position is absent where its body is not known, or how it turns.
// `kernels` and `tdb` are those of the scene.
void PutCoordinates(const TerrainObject& terrain, const Pose& X_RootS, const Rows3& points_S,
                    const Rows3& map, const KernelSet& kernels, double tdb,
                    v1::CoordinatesReply& reply);

} // namespace dspace::session

#endif
