// Source views and their resampling, with drawn pixels computed apart.
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/camera/sampling/LensTile.h>

namespace dspace {
namespace {

CameraModel Model(const std::string& type, const LensValues& values, int width, int height) {
  CameraModel model;
  model.width = width;
  model.height = height;
  model.lens = MakeLens(type, values, "lens");
  return model;
}

const LensValues Wide = {{"focal", {60.0, 60.0}}, {"center", {99.5, 79.5}}};

std::vector<CameraModel> Models() {
  return {Model("pinhole", {{"focal", {200.0, 200.0}}, {"center", {99.5, 79.5}}}, 200, 160),
          Model("brown",
                {{"focal", {200.0, 190.0}}, {"center", {90.5, 79.5}}, {"radial", {-0.2, 0.05}}},
                200, 160),
          Model("equidistant", Wide, 200, 160),
          Model("cahvore",
                {{"A", {0, 0, 1}},
                 {"H", {80, 0, 99.5}},
                 {"V", {0, 80, 79.5}},
                 {"O", {0, 0, 1}},
                 {"R", {0, -0.02, 0}},
                 {"E", {4e-3, 2e-3, 0}},
                 {"linearity", {0.0}}},
                200, 160)};
}

// What a scene shows in a direction from a point: radiance (red), and distance [m].
struct Hit {
  double light;
  double distance;
};
using Shown = std::function<Hit(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction)>;

// Draws a block by the scene itself, a ray through each pixel's centre.
LensPlanes Draw(const SourceViews& views, const SourceViews::Block& block, const Shown& scene) {
  const SourceViews::View view = views.ViewOf(block);
  const SourceViews::Face& face = views.Faces()[std::size_t(block.face)];
  LensPlanes planes;
  planes.width = view.width;
  planes.height = view.height;
  for (int j = 0; j < view.height; ++j) {
    for (int i = 0; i < view.width; ++i) {
      const Eigen::Vector3d F(view.left + (i + 0.5) * (view.right - view.left) / view.width,
                              view.top + (j + 0.5) * (view.bottom - view.top) / view.height, 1.0);
      const Hit seen = scene(views.Eye(), face.R_CF * F.normalized());
      planes.radiance.insert(planes.radiance.end(), {float(seen.light), 0.0f, 1.0f});
      planes.depth.push_back(float(seen.distance / F.norm()));
      planes.label.push_back(std::uint32_t(100.0 * seen.light));
    }
  }
  return planes;
}

LensPlanes Picture(const CameraModel& model, const Shown& scene, int block, int x, int y, int width,
                   int height, double* pupil = nullptr) {
  const SourceViews views(model, block);
  LensWishes wishes;
  wishes.radiance = wishes.depth = wishes.range = wishes.label = true;
  const auto map = std::make_shared<LensMap>(views, *model.lens, x, y, width, height);
  LensTile tile(views, map, wishes);
  for (const auto& [each, pixels] : map->Blocks()) {
    tile.Take(each, Draw(views, each, scene));
  }
  if (pupil) {
    *pupil = tile.PupilPixels();
  }
  EXPECT_EQ(tile.Beyond(), 0u);
  return tile.Planes();
}

// A smooth pattern on a sphere of 2 m around the origin.
Hit Sphere(const Eigen::Vector3d& eye, const Eigen::Vector3d& d) {
  const double b = eye.dot(d);
  const double t = -b + std::sqrt(b * b + 4.0 - eye.squaredNorm());
  const Eigen::Vector3d p = eye + t * d;
  return {2.0 + std::sin(4.0 * p.x()) + std::cos(3.0 * p.y() + p.z()), t};
}

TEST(SourceViews, ShowWhatThePixelsOwnRayMeets) {
  for (const CameraModel& model : Models()) {
    double pupil = 0.0;
    const LensPlanes planes = Picture(model, Sphere, 64, 0, 0, model.width, model.height, &pupil);
    const std::string type = model.lens->Type();
    EXPECT_EQ(pupil > 0.0, type == "cahvore");
    double light = 0.0, range = 0.0, depth = 0.0;
    for (int y = 0; y < model.height; ++y) {
      for (int x = 0; x < model.width; ++x) {
        LensRay ray;
        ASSERT_TRUE(model.lens->Unproject({double(x), double(y)}, ray)) << type;
        const Hit seen = Sphere(ray.origin, ray.direction);
        const std::size_t at = std::size_t(y * model.width + x);
        light = std::max(light, std::abs(double(planes.radiance[3 * at]) - seen.light));
        range = std::max(range, std::abs(double(planes.range[at]) - seen.distance));
        depth = std::max(depth, std::abs(double(planes.depth[at]) -
                                         (ray.origin + seen.distance * ray.direction).z()));
        EXPECT_EQ(planes.radiance[3 * at + 2], 1.0f); // no wedge, in any corner
      }
    }
    // A pixel of the pattern changes the light by up to 0.1; a slip of a twentieth of one would
    // show.
    EXPECT_LT(light, 0.01) << type;
    EXPECT_LT(range, 0.02) << type; // the nearest pixel's depth, on a curved surface
    EXPECT_LT(depth, 0.02) << type;
  }
}

TEST(SourceViews, TilesEqualTheWhole) {
  for (const CameraModel& model : Models()) {
    const LensPlanes whole = Picture(model, Sphere, 48, 0, 0, model.width, model.height);
    for (const auto& [x, y, width, height] :
         {std::tuple(0, 0, 70, 50), std::tuple(130, 110, 70, 50), std::tuple(61, 40, 1, 1)}) {
      const LensPlanes tile = Picture(model, Sphere, 48, x, y, width, height);
      for (int j = 0; j < height; ++j) {
        for (int i = 0; i < width; ++i) {
          const std::size_t a = std::size_t(j * width + i);
          const std::size_t b = std::size_t((y + j) * model.width + x + i);
          ASSERT_EQ(tile.radiance[3 * a], whole.radiance[3 * b]);
          ASSERT_EQ(tile.range[a], whole.range[b]);
          ASSERT_EQ(tile.label[a], whole.label[b]);
        }
      }
    }
  }
}

TEST(SourceViews, LabelsAreNeverBlended) {
  const Shown halves = [](const Eigen::Vector3d&, const Eigen::Vector3d& d) {
    return Hit{d.x() < 0.1 * d.y() ? 1.0 : 3.0, 5.0};
  };
  for (const CameraModel& model : Models()) {
    const LensPlanes planes = Picture(model, halves, 64, 0, 0, model.width, model.height);
    int blended = 0;
    for (std::size_t i = 0; i < planes.label.size(); ++i) {
      ASSERT_TRUE(planes.label[i] == 100u || planes.label[i] == 300u);
      blended += planes.radiance[3 * i] > 1.01f && planes.radiance[3 * i] < 2.99f;
    }
    EXPECT_GT(blended, 0); // light is
  }
}

TEST(SourceViews, AMovingPupilSeesThingsBeforeTheSky) {
  const CameraModel model = Model("cahvore", // its pupil moves by 2 cm
                                  {{"A", {0, 0, 1}},
                                   {"H", {80, 0, 99.5}},
                                   {"V", {0, 80, 79.5}},
                                   {"O", {0, 0, 1}},
                                   {"R", {0, 0, 0}},
                                   {"E", {0.04, 0.02, 0}},
                                   {"linearity", {0.0}}},
                                  200, 160);
  const auto meets = [](const Eigen::Vector3d& eye, const Eigen::Vector3d& d) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 12; ++k) { // balls of 10 cm all around
      const double t = 0.14 * k, a = 2.4 * k;
      const Eigen::Vector3d c(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t));
      const double b = (c - eye).dot(d);
      const double root = 0.01 - (c - eye).squaredNorm() + b * b;
      if (root > 0.0 && b > 0.0) {
        nearest = std::min(nearest, b - std::sqrt(root));
      }
    }
    return Hit{std::isfinite(nearest) ? 1.0 : 0.0, nearest};
  };
  double pupil = 0.0;
  const LensPlanes planes = Picture(model, meets, 64, 0, 0, model.width, model.height, &pupil);
  EXPECT_GT(pupil, 1.0);
  int wrong = 0, shown = 0, still = 0;
  for (int y = 0; y < model.height; ++y) {
    for (int x = 0; x < model.width; ++x) {
      LensRay ray;
      ASSERT_TRUE(model.lens->Unproject({double(x), double(y)}, ray));
      const bool hit = meets(ray.origin, ray.direction).light > 0.0;
      shown += hit;
      wrong += (planes.label[std::size_t(y * model.width + x)] != 0) != hit;
      still += (meets(Eigen::Vector3d(0, 0, 0), ray.direction).light > 0.0) != hit;
    }
  }
  EXPECT_GT(shown, 1000);
  EXPECT_LT(wrong, shown / 10); // borders, to the nearest source pixel
  EXPECT_GT(still, wrong);      // a pupil that stood still would be wrong more often
}

TEST(SourceViews, AreAsFineAsTheLens) {
  for (const CameraModel& model : Models()) {
    const SourceViews views(model, 64);
    const bool wide = views.HalfAngle_deg() > 50.0;
    EXPECT_EQ(views.Faces().size() > 1, wide) << model.lens->Type();
    double least = 1e9;
    for (int y = 0; y < model.height; y += 7) {
      for (int x = 1; x < model.width; x += 7) {
        LensRay a, b;
        ASSERT_TRUE(model.lens->Unproject({x - 0.5, double(y)}, a) &&
                    model.lens->Unproject({x + 0.5, double(y)}, b));
        const SourceViews::Place one = views.Find(a), two = views.Find(b);
        ASSERT_GE(one.face, 0);
        if (one.face == two.face) {
          least = std::min(least, std::hypot(one.x - two.x, one.y - two.y));
        }
      }
    }
    EXPECT_GT(least, 0.98) << model.lens->Type(); // source pixels per pixel
    EXPECT_LT(least, 1.5) << model.lens->Type();
    // The footprint is the root of the area between neighbours.
    const LensMap map(views, *model.lens, 0, 0, model.width, model.height);
    for (int y = 5; y < model.height - 1; y += 31) {
      for (int x = 5; x < model.width - 1; x += 31) {
        const auto at = [&](int u, int v) -> const LensMap::Pixel& {
          return map.Pixels()[std::size_t(v * model.width + u)];
        };
        const SourceViews::Place &left = at(x - 1, y).place, &right = at(x + 1, y).place,
                                 &up = at(x, y - 1).place, &down = at(x, y + 1).place;
        if (left.face == right.face && up.face == down.face && left.face == up.face) {
          const double area = std::abs((right.x - left.x) * (down.y - up.y) -
                                       (right.y - left.y) * (down.x - up.x)) /
                              4.0;
          EXPECT_NEAR(double(at(x, y).footprint) / std::sqrt(area), 1.0, 0.01)
              << model.lens->Type() << " " << x << " " << y;
        }
      }
    }
  }
}

TEST(SourceViews, AnAllRoundLensNeedsFewPixels) {
  // The image's corners are beyond 180 degrees, where the lens draws one point out into a circle.
  const CameraModel model =
      Model("equidistant", {{"focal", {30.0, 30.0}}, {"center", {99.5, 99.5}}}, 200, 200);
  const SourceViews views(model, 64);
  EXPECT_EQ(views.Faces().size(), 6u);
  double pixels = 0.0;
  for (const SourceViews::Face& face : views.Faces()) {
    pixels += double(face.width) * face.height;
  }
  EXPECT_LT(pixels, 16.0 * 200 * 200);
  const LensMap map(views, *model.lens, 0, 0, 200, 200);
  // No ray beyond the circle of 180 degrees.
  EXPECT_NEAR(double(map.WithoutRay()), 200.0 * 200.0 - M_PI * std::pow(30.0 * M_PI, 2), 60.0);
}

TEST(SourceViews, PixelsWithoutARayAreEmpty) {
  // Folds at 702.7 / 1000 of the focal length, well within the corners.
  const CameraModel model = Model(
      "brown", {{"focal", {100.0, 100.0}}, {"center", {99.5, 79.5}}, {"radial", {-0.3}}}, 200, 160);
  const LensPlanes planes = Picture(model, Sphere, 64, 0, 0, 200, 160);
  EXPECT_EQ(planes.radiance[2], 0.0f);
  EXPECT_EQ(planes.label[0], 0u);
  EXPECT_TRUE(std::isinf(planes.range[0]));
  EXPECT_EQ(planes.radiance[3 * (80 * 200 + 100) + 2], 1.0f);
  int seen = 0;
  for (int i = 0; i < 200 * 160; ++i) {
    seen += planes.radiance[std::size_t(3 * i + 2)] > 0.5f;
  }
  EXPECT_NEAR(seen, M_PI * 70.27 * 70.27, 60.0);
}

// Rays that are parallel have one view, whose pixels are the picture's where both scales are one.
TEST(SourceViews, ParallelRaysHaveOneView) {
  const CameraModel model =
      Model("orthographic", {{"scale", {10, 10}}, {"center", {40.25, 29.5}}}, 80, 60);
  const SourceViews views(model, 64);
  EXPECT_TRUE(views.Parallel());
  ASSERT_EQ(views.Faces().size(), 1u);
  EXPECT_EQ(views.Eye(), Eigen::Vector3d::Zero());
  EXPECT_EQ(views.PupilShift(), 0.0);
  const LensMap map(views, *model.lens, 0, 0, 80, 60);
  EXPECT_EQ(map.WithoutRay(), 0u);
  EXPECT_FALSE(map.MovesPupil());
  for (const LensMap::Pixel& pixel : map.Pixels()) {
    EXPECT_NEAR(pixel.place.x, std::round(pixel.place.x), 1e-9);
    EXPECT_NEAR(pixel.place.y, std::round(pixel.place.y), 1e-9);
    EXPECT_FLOAT_EQ(pixel.footprint, 1.0f);
    // The view's pixel is seen at the ray's own place [m].
    const SourceViews::View view = views.ViewOf(views.BlockOf(pixel.place));
    EXPECT_NEAR(view.left + (pixel.place.x - view.x + 0.5) / views.Faces()[0].scale,
                pixel.ray.origin.x(), 1e-12);
    EXPECT_NEAR(view.top + (pixel.place.y - view.y + 0.5) / views.Faces()[0].scale,
                pixel.ray.origin.y(), 1e-12);
  }
  // The finer scale holds for both axes.
  const CameraModel wide =
      Model("orthographic", {{"scale", {10, 25}}, {"center", {39.5, 29.5}}}, 80, 60);
  EXPECT_DOUBLE_EQ(SourceViews(wide, 64).Faces()[0].scale, 25.0);
}

} // namespace
} // namespace dspace
