#include <dspace/commands/viewports/SourceCamera.h>

namespace dspace::session {

SourceCamera SourceCameraOf(const SourceViews& views, int face, const SourceViews::View& view) {
  SourceCamera camera;
  camera.X_CF.position = views.Eye();
  camera.X_CF.rotation = Eigen::Quaterniond(views.Faces()[std::size_t(face)].R_CF);
  if (views.Parallel()) { // an orthographic camera looks at the middle of what it shows
    camera.X_CF.position +=
        Eigen::Vector3d(0.5 * (view.left + view.right), 0.5 * (view.top + view.bottom), 0.0);
    camera.projection.kind = Projection::Kind::Orthographic;
    camera.projection.height = view.bottom - view.top;
    return camera;
  }
  camera.projection.kind = Projection::Kind::Frustum;
  camera.projection.left = view.left;
  camera.projection.right = view.right;
  camera.projection.top = view.top;
  camera.projection.bottom = view.bottom;
  return camera;
}

} // namespace dspace::session
