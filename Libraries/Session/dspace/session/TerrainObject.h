#ifndef DSPACE_SESSION_TERRAIN_OBJECT_H
#define DSPACE_SESSION_TERRAIN_OBJECT_H
#include <dspace/scene/GraphicsObject.h>
namespace dspace::session {
class TerrainObject {
public:
  ObjectId Object() const { return 0; }
  Eigen::Vector3d SceneToMap(const Eigen::Vector3d& p) const { return p; }
};
} // namespace dspace::session
#endif
