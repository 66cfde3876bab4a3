// Zoomed and parallel views of clipmaps, against the formula under each pixel.
#include <algorithm>
#include <cmath>
#include <vector>

#include <dspace/clipmap/ClipmapFocus.h>

#include "ClipmapTestSupport.h"

namespace dspace::testing {
namespace {

// Without what is shorter than some pixels of the tests.
double Swell(double c, double r) {
  return 40.0 * std::sin(0.013 * c) * std::cos(0.017 * r) + 9.0 * std::sin(0.11 * c + 0.07 * r);
}

// A formula's height on the stated triangles between posts.
double OnTriangles(double (*formula)(double, double), const Eigen::Vector2d& post) {
  const double c = std::floor(post.x());
  const double r = std::floor(post.y());
  const double u = post.x() - c;
  const double v = post.y() - r;
  const double a = float(formula(c, r));
  const double d = float(formula(c + 1, r + 1));
  const double down = float(formula(c, r + 1));
  const double right = float(formula(c + 1, r));
  return v > u ? a + v * (down - a) + u * (d - down) : a + u * (right - a) + v * (d - right);
}

// Seen from far above through a lens of some degrees, or with a map's camera of 72 m: its posts
// are those of the finest level, whatever the camera's height.
TEST_F(ClipmapFixture, AMapOfFewMetresHasTheFinestPosts) {
  AddPlane(8193, Hills, {-51, 51}, false);
  const Eigen::Affine2d toPosts = terrain->Placement().PostToScene().inverse();
  auto view = View(240, 240);
  for (const Eigen::Vector3d& eye :
       std::vector<Eigen::Vector3d>{{300, 500, 4000}, {-2000, 700, 60000}, {-1200, 0, 4000}}) {
    Camera camera;
    camera.name = "camera";
    camera.projection.kind = Projection::Kind::Orthographic;
    camera.projection.height = 72.0;
    camera.projection.nearDistance = 1.0;
    const Eigen::Vector3d target(300, 500, 0);
    const double range = (target - eye).norm();
    camera.projection.farDistance = 2.0 * range;
    camera.mount.X_FC = LookAt("camera", eye, target, {0.1, 1, 0});
    scene->SetCamera("main", camera);
    const Capture capture = Shoot(view);
    const double down = std::abs((target - eye).normalized().z());
    int pixels = 0;
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 240; ++x) {
        const Hit hit = HitAt(*scene, capture, x, y);
        if (!hit.hit || (hit.p - target).cwiseAbs().head<2>().maxCoeff() > 60.0) {
          continue;
        }
        const Eigen::Vector2d post = toPosts * Eigen::Vector2d(hit.p.head<2>());
        // Places and depths are floats of the way from the camera, seen at an angle; pixels are
        // drawn as if moved by half of 1/256, here of 0.3 m, on slopes of up to 2.
        const double floats = 4.0 * std::ldexp(range, -23) / down;
        ASSERT_NEAR(hit.p.z(), OnTriangles(Hills, post),
                    1e-3 + floats + std::sqrt(2.0) / 512.0 * 0.3 * 2.0 / down)
            << "from " << eye.transpose() << ", pixel " << x << ", " << y;
        ++pixels;
      }
    }
    EXPECT_GT(pixels, 5000) << eye.transpose();
  }
}

// Of a lens of 5 degrees: how far from where it should be ground is drawn, in pixels. Chosen from
// where the camera stands, levels would be 20 and more pixels off in the first two views.
TEST_F(ClipmapFixture, ALongLensSeesGroundWithinPixels) {
  AddPlane(8193, Swell, {-51, 51}, false);
  const Eigen::Affine2d toPosts = terrain->Placement().PostToScene().inverse();
  constexpr int Height = 360;
  auto view = View(640, Height);
  struct Case {
    Eigen::Vector3d eye, target;
    double pixels; // 99 of 100 are closer
  };
  for (const Case& c : {Case{{0, 0, 300}, {2500, 400, 0}, 8.0}, // along the ground
                        {{-700, 100, 1500}, {1500, 400, 0}, 2.5},
                        {{500, -800, 6000}, {400, 300, 0}, 0.8}}) {
    LookFrom(c.eye, c.target, 5.0);
    const Capture capture = Shoot(view);
    const double angle = 2.0 * std::tan(2.5 * M_PI / 180.0) / Height; // of a pixel [rad]
    std::vector<double> errors;
    for (int y = 0; y < Height; y += 2) {
      for (int x = 0; x < 640; x += 2) {
        const Hit hit = HitAt(*scene, capture, x, y);
        if (!hit.hit) {
          continue;
        }
        const Eigen::Vector2d post = toPosts * Eigen::Vector2d(hit.p.head<2>());
        const Eigen::Vector3d ray = hit.p - c.eye;
        const double across = ray.head<2>().norm() / ray.norm(); // of a height on the picture
        errors.push_back(std::abs(hit.p.z() - OnTriangles(Swell, post)) * across /
                         (ray.norm() * angle));
      }
    }
    ASSERT_GT(errors.size(), 30000u);
    const auto most = errors.begin() + std::ptrdiff_t(0.99 * double(errors.size()));
    std::nth_element(errors.begin(), most, errors.end());
    EXPECT_LT(*most, c.pixels) << "from " << c.eye.transpose();
  }
}

TEST(ClipmapFocus, StandsWhereAWideViewWouldSeeTheSame) {
  const PostPlacement plane = PostPlacement::OnPlane(Eigen::Affine2d::Identity());
  const auto level = [](const Eigen::Vector2d&) { return 0.0; };
  FocusView view;
  view.camera = {10, 20, 1000};
  view.forward = {0, 0, -1};
  view.rim = {Eigen::Vector3d(0.05, 0, -1).normalized()};
  view.half = 0.1 * FocusTangent;
  // A tenth of the tangent: nine tenths of the way.
  EXPECT_NEAR(FocusOf(view, plane, level).z(), 100.0, 1e-6);
  EXPECT_NEAR(FocusOf(view, plane, level).x(), 10.0, 1e-9);
  view.half = FocusTangent;
  EXPECT_EQ(FocusOf(view, plane, level), view.camera);
  view.half = 0.1;
  view.forward = {1, 0, 0.2}; // to the sky
  view.rim.clear();
  EXPECT_EQ(FocusOf(view, plane, level), view.camera);
  // No further than twice the nearest ground that is seen: that gets no coarser.
  view.forward = Eigen::Vector3d(1, 0, -0.01).normalized();
  view.rim = {Eigen::Vector3d(1, 0, -0.5).normalized()};
  const double nearest = 1000.0 / std::sin(std::atan(0.5));
  EXPECT_LT((FocusOf(view, plane, level) - view.camera).norm(), 2.0 * nearest + 1e-6);
  EXPECT_GT((FocusOf(view, plane, level) - view.camera).norm(), 1.9 * nearest);
  view.parallel = true;
  view.half = 100.0;
  view.forward = {0, 0, -1};
  EXPECT_NEAR(FocusOf(view, plane, level).z(), 100.0 / FocusTangent, 0.1);
}

} // namespace
} // namespace dspace::testing
