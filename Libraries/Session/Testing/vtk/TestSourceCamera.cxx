// The camera that draws a source view sees each pixel along that pixel's line.
#include <gtest/gtest.h>

#include <dspace/camera/LensNumbers.h>
#include <dspace/commands/viewports/SourceCamera.h>

namespace dspace::testing {
namespace {

CameraModel ModelOf(const std::string& type, LensValues values, int width, int height) {
  CameraModel model;
  model.width = width;
  model.height = height;
  model.lens = MakeLens(type, std::move(values), "lens");
  return model;
}

// Of each pixel of every view: where its ray begins and goes, in the lens' axes, by SourceViews.
void ExpectRays(const CameraModel& model) {
  const SourceViews views(model, 64);
  for (int face = 0; face < int(views.Faces().size()); ++face) {
    const SourceViews::Face& of = views.Faces()[std::size_t(face)];
    for (const int column : {0, (of.width - 1) / 64}) {
      const SourceViews::View view = views.ViewOf({face, column, 0});
      const session::SourceCamera camera = session::SourceCameraOf(views, face, view);
      for (const Eigen::Vector2d& pixel :
           {Eigen::Vector2d(0, 0), Eigen::Vector2d(view.width - 1, 3), Eigen::Vector2d(5, 7.5)}) {
        const Projection::Ray ray =
            camera.projection.PixelRay(pixel.x(), pixel.y(), view.width, view.height);
        const Eigen::Vector3d from = camera.X_CF.Apply(ray.origin);
        const Eigen::Vector3d along = camera.X_CF.rotation * ray.direction;
        const double x = of.left + (view.x + pixel.x() + 0.5) / of.scale;
        const double y = of.top + (view.y + pixel.y() + 0.5) / of.scale;
        const Eigen::Vector3d expectedFrom =
            views.Parallel() ? Eigen::Vector3d(x, y, 0.0) : views.Eye();
        const Eigen::Vector3d expectedAlong =
            views.Parallel() ? Eigen::Vector3d(0.0, 0.0, 1.0)
                             : (of.R_CF * Eigen::Vector3d(x, y, 1.0)).normalized();
        EXPECT_LT((from - expectedFrom).norm(), 1e-9) << face << ": " << pixel.transpose();
        EXPECT_LT((along - expectedAlong).norm(), 1e-12) << face << ": " << pixel.transpose();
      }
    }
  }
}

TEST(SourceCamera, PinholesAreSeenFromTheEye) {
  ExpectRays(ModelOf("pinhole", {{"focal", {150, 150}}, {"center", {90.0, 60.0}}}, 200, 160));
}

TEST(SourceCamera, TheFacesOfAFishEyeAreTurned) {
  ExpectRays(ModelOf("equidistant", {{"focal", {40, 40}}, {"center", {79.5, 59.5}}}, 160, 120));
}

TEST(SourceCamera, ParallelRaysAreSeenByAnOrthographicCamera) {
  ExpectRays(ModelOf("orthographic", {{"scale", {30, 30}}, {"center", {100.0, 20.0}}}, 200, 160));
}

} // namespace
} // namespace dspace::testing
