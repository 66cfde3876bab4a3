#include <dspace/render/CustomDrawer.h>

#include <dspace/scene/GraphicsObject.h>
#include <dspace/scene/Stretch.h>

namespace dspace {

std::vector<LightHull> CustomDrawer::Hulls(const CustomDrawing& drawing) {
  const Eigen::Affine3d& X_VO = drawing.object.X_VO;
  const BoundingSphere sphere = drawing.object.object->custom->Bounds();
  LightHull hull;
  hull.points = {X_VO * sphere.center};
  hull.radius = sphere.radius * LargestStretch(X_VO);
  return {hull};
}

} // namespace dspace
