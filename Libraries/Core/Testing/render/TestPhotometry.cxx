// Radiance and angles of pictures against the photometric models in double precision, pixel by
// pixel, and against closed forms.
#include "RenderingTestSupport.h"

#include <dspace/import/model/Reflectance.h>
#include <dspace/scene/LinearLight.h>

namespace dspace {
namespace {

using Law = Reflectance::Model;
constexpr double Unit = SolarConstant / M_PI; // W/m^2/sr of linear value 1

struct PhotometryTest : RenderingFixture {
  static constexpr int Size = 121;
  Eigen::Vector3d toSun = Eigen::Vector3d(-0.6, 0.7, 0.4).normalized();

  PhotometryTest() { Look({}); }

  void SetSun(double intensity = 1.0) {
    Light sun;
    sun.name = SunName;
    sun.direction = -toSun;
    sun.intensity = intensity;
    scene->SetLight(sun);
  }
  Capture Planes(vtkDspaceViewport* viewport) {
    CaptureRequest request;
    request.color = false;
    request.depth = request.radiance = true;
    request.incidence = request.emission = request.phase = true;
    return viewport->GetCapture(request);
  }
  // Of a pixel's ray. The root's X is the camera's Z, -Y its X, -Z its Y.
  static Eigen::Vector3d Direction(double x, double y) {
    const Eigen::Vector3d d = Projection().PixelRay(x, y, Size, Size).direction;
    return Eigen::Vector3d(d.z(), -d.x(), -d.y()).normalized();
  }
};

Reflectance ReflectanceBy(Law model) {
  Reflectance made;
  made.model = model;
  return made;
}

double Degrees(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / M_PI;
}

} // namespace

TEST_F(PhotometryTest, EachModelOnASphereIsTheReferencePixelByPixel) {
  SetSun(0.7);
  Reflectance smooth = ReflectanceBy(Law::Hapke);
  smooth.roughness_deg = 0.0;
  Reflectance weighted = ReflectanceBy(Law::LunarLambert);
  weighted.lunarWeight = 0.3;
  const Eigen::Vector3d center(4, 0, 0);
  const auto mesh = std::make_shared<const Mesh>(MakeSphere(1.0, 512));
  for (const Reflectance& reflectance :
       {ReflectanceBy(Law::Lambert), ReflectanceBy(Law::LommelSeeliger),
        ReflectanceBy(Law::LunarLambert), weighted, ReflectanceBy(Law::Hapke), smooth}) {
    GraphicsObject ball;
    ball.name = "ball";
    ball.levels = {{{{mesh, std::make_shared<Material>()}}, 0.0}};
    ball.X_FO.translation() = center;
    ball.material.color = {1, 1, 1};
    ball.material.reflectance = reflectance;
    const ObjectId id = scene->AddObject(ball);
    auto viewport = View(Size, Size);
    const Capture capture = Planes(viewport);
    int compared = 0;
    double worst = 0.0;
    const double offset = this->VertexOffset();
    for (int y = 0; y < Size; ++y) {
      for (int x = 0; x < Size; ++x) {
        const Eigen::Vector3d d = Direction(x, y);
        const double along = d.dot(center);
        const double root = along * along - center.squaredNorm() + 1.0;
        const std::size_t at = std::size_t(y) * Size + std::size_t(x);
        if (root <= 0.0) {
          if (root < -0.05) {
            EXPECT_TRUE(std::isnan(capture.incidence[at]));
            EXPECT_TRUE(std::isnan(capture.emission[at]));
            EXPECT_TRUE(std::isnan(capture.phase[at]));
            EXPECT_EQ(capture.radiance[3 * at], 0.0f);
          }
          continue;
        }
        const Eigen::Vector3d p = d * (along - std::sqrt(root));
        const Eigen::Vector3d n = p - center;
        const double emission = Degrees(n, -d);
        if (emission > 80.0) { // facets are seen edge-on
          continue;
        }
        const double incidence = Degrees(n, toSun);
        const double phase = Degrees(toSun, -d);
        // The normal turns by this angle over the offset.
        const double step =
            Degrees(d, Direction(x + 1, y)) * p.norm() / std::cos(emission * M_PI / 180.0) * offset;
        EXPECT_NEAR(capture.incidence[at], incidence, 0.01 + step);
        EXPECT_NEAR(capture.emission[at], emission, 0.01 + step);
        EXPECT_NEAR(capture.phase[at], phase, 1e-3);
        if (std::abs(incidence - 90.0) < 1.0) { // a hundredth of a degree is a percent
          continue;
        }
        const double expected =
            Unit * 0.7 * RadianceFactor(reflectance, n.dot(toSun), n.dot(-d), phase * M_PI / 180.0);
        const double got = capture.radiance[3 * at];
        EXPECT_EQ(capture.radiance[3 * at + 1], capture.radiance[3 * at]);
        if (expected == 0.0) {
          EXPECT_EQ(got, 0.0);
          continue;
        }
        worst = std::max(worst, std::abs(got / expected - 1.0));
        ++compared;
      }
    }
    EXPECT_GT(compared, 2000);
    // The normals are interpolated: up to 0.01 degrees off, and cos i there goes to 0.017.
    EXPECT_LT(worst, 0.005) << int(reflectance.model);
    scene->RemoveObject(id);
  }
}

TEST_F(PhotometryTest, ALambertianPlaneAtOneAuHasTheRadianceOfItsAlbedo) {
  for (const double angle_deg : {0.0, 35.0, 75.0}) {
    const double angle = angle_deg * M_PI / 180;
    toSun = {-std::cos(angle), 0, std::sin(angle)};
    SetSun();
    auto material = std::make_shared<Material>();
    material->color = {0.5, 0.25, 1.0};
    material->reflectance = ReflectanceBy(Law::Lambert);
    GraphicsObject wall = Object("wall", RootFrame, PlaneTowardsCamera(40, 40), material);
    wall.X_FO.translation() = Eigen::Vector3d(10, 0, 0);
    const ObjectId id = scene->AddObject(wall);
    // Neither exposure nor fill light count.
    auto viewport = View(Size, Size, 2);
    ViewLook look;
    look.exposure = 8.0;
    look.fill = 0.5;
    look.tone = ToneCurve::Filmic;
    viewport->SetLook(look);
    const Capture capture = Planes(viewport);
    for (std::size_t i = 0; i < capture.radiance.size(); ++i) {
      // sRGB (IEC 61966-2-1) by hand: 0.5 is 0.21404, 0.25 is 0.05088.
      const double albedo = i % 3 == 0 ? 0.214041 : i % 3 == 1 ? 0.0508761 : 1.0;
      const double expected = 1361.0 / M_PI * std::cos(angle) * albedo;
      ASSERT_NEAR(capture.radiance[i] / expected, 1.0, 1e-3);
    }
    EXPECT_NEAR(capture.incidence[Size * Size / 2], angle_deg, 1e-3);
    scene->RemoveObject(id);
  }
}

TEST_F(PhotometryTest, RadianceIsNotLimited) {
  toSun = {-1, 0, 0};
  SetSun(1e9);
  GraphicsObject wall =
      Object("wall", RootFrame, PlaneTowardsCamera(40, 40), std::make_shared<Material>());
  wall.X_FO.translation() = Eigen::Vector3d(10, 0, 0);
  wall.material.reflectance = ReflectanceBy(Law::Lambert);
  wall.material.color = {1, 1, 1};
  scene->AddObject(wall);
  // Glass before it lets three quarters pass.
  scene->AddObject(Object("glass", scene->Frames().Create(RootFrame, "glass", At(5, 0, 0)),
                          PlaneTowardsCamera(1, 1), Unlit({0, 0, 0}, 0.25)));
  auto viewport = View(Size, Size);
  const Capture capture = Planes(viewport);
  EXPECT_NEAR(capture.radiance[0] / (Unit * 1e9), 1.0, 1e-5);
  const std::size_t middle = std::size_t(Size) * Size / 2;
  EXPECT_NEAR(capture.radiance[3 * middle] / (Unit * 0.75e9), 1.0, 1e-5);
  // Glass without light has no angles, and hides those of what is behind it as labels do.
  EXPECT_TRUE(std::isnan(capture.incidence[middle]));
  EXPECT_NEAR(capture.incidence[0], 0.0, 1e-3);
}

TEST_F(PhotometryTest, WithoutASunOnlyTheEmissionIsDefined) {
  GraphicsObject wall =
      Object("wall", RootFrame, PlaneTowardsCamera(40, 40), std::make_shared<Material>());
  wall.X_FO.translation() = Eigen::Vector3d(10, 0, 0);
  wall.material.emissive = {1, 1, 1}; // it glows
  scene->AddObject(wall);
  auto viewport = View(Size, Size);
  const Capture capture = Planes(viewport);
  const std::size_t middle = std::size_t(Size) * Size / 2;
  EXPECT_TRUE(std::isnan(capture.incidence[middle]));
  EXPECT_TRUE(std::isnan(capture.phase[middle]));
  EXPECT_NEAR(capture.emission[middle], 0.0, 1e-3);
  EXPECT_NEAR(capture.radiance[3 * middle] / Unit, 1.0, 1e-5);
}

// The Earth over the Moon: 1361 W/m^2 times a geometric albedo of 0.434 and the square of 6371 km
// over 384400 km, from a disc of 0.95 degrees. The Lambertian irradiance of a disc above the
// horizon is that of its centre.
TEST_F(PhotometryTest, EarthshineAddsToTheSunAsLambertSays) {
  SetSun();
  Light earth;
  earth.name = "earth";
  earth.direction = Eigen::Vector3d(0.8, -0.2, -0.5);
  earth.intensity = 0.434 * std::pow(6371.0 / 384400.0, 2);
  earth.radius_deg = 0.95;
  earth.color = {0.8, 0.9, 1.0};
  scene->SetLight(earth);
  GraphicsObject wall =
      Object("wall", RootFrame, PlaneTowardsCamera(40, 40), std::make_shared<Material>());
  wall.X_FO.translation() = Eigen::Vector3d(10, 0, 0);
  wall.material.reflectance = ReflectanceBy(Law::Lambert);
  wall.material.color = {1, 1, 1};
  scene->AddObject(wall);
  auto viewport = View(Size, Size);
  const double cosEarth = 0.8 / std::sqrt(0.93);
  const auto compare = [&](double sun) {
    const Capture capture = Planes(viewport);
    for (int k = 0; k < 3; ++k) {
      const double color = LinearFromSrgb(earth.color[k]);
      const double expected = Unit * (sun + earth.intensity * color * cosEarth);
      EXPECT_NEAR(capture.radiance[std::size_t(k)] / expected, 1.0, 1e-5);
    }
  };
  compare(-toSun.x());
  toSun = {1, 0, 0}; // night
  SetSun();
  compare(0.0);
}

// Against a sum over the disc's parts that the surface sees, and for a hemisphere the closed form.
TEST_F(PhotometryTest, ADiscIsCutByTheSurfacesOwnHorizon) {
  const Eigen::Vector3d center(4, 0, 0);
  GraphicsObject ball =
      Object("ball", RootFrame, MakeSphere(1.0, 512), std::make_shared<Material>());
  ball.X_FO.translation() = center;
  ball.material.reflectance = ReflectanceBy(Law::Lambert);
  ball.material.color = {1, 1, 1};
  scene->AddObject(ball);
  for (const double radius : {0.95, 10.0, 45.0, 90.0}) {
    SCOPED_TRACE(radius);
    Light sky;
    sky.name = "sky";
    sky.direction = Eigen::Vector3d(0.3, -0.5, -0.8);
    sky.intensity = 0.5;
    sky.radius_deg = radius;
    scene->SetLight(sky);
    const Eigen::Vector3d toSky = -sky.direction.normalized();
    // By the angle between normal and centre.
    const auto reference = [&](double cosine) {
      constexpr int Rings = 400;
      constexpr int Sectors = 400;
      const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
      const Eigen::Vector3d normal(std::sin(angle), 0.0, std::cos(angle));
      double sum = 0.0;
      double facing = 0.0;
      for (int i = 0; i < Rings; ++i) {
        const double r = (i + 0.5) / Rings * radius * M_PI / 180.0;
        for (int k = 0; k < Sectors; ++k) {
          const double a = 2.0 * M_PI * (k + 0.5) / Sectors;
          const Eigen::Vector3d d(std::sin(r) * std::cos(a), std::sin(r) * std::sin(a),
                                  std::cos(r));
          sum += std::sin(r) * std::max(0.0, d.dot(normal));
          facing += std::sin(r) * d.z();
        }
      }
      return sum / facing;
    };
    auto viewport = View(Size, Size);
    const Capture capture = Planes(viewport);
    int compared = 0;
    double worst = 0.0;
    for (int y = 0; y < Size; y += 3) {
      for (int x = 0; x < Size; x += 3) {
        const Projection::Ray ray = Projection().PixelRay(x, y, Size, Size);
        const Eigen::Vector3d d =
            Eigen::Vector3d(ray.direction.z(), -ray.direction.x(), -ray.direction.y()).normalized();
        const double along = d.dot(center);
        const double root = along * along - center.squaredNorm() + 1.0;
        if (root <= 0.05) {
          continue;
        }
        const Eigen::Vector3d n = d * (along - std::sqrt(root)) - center;
        const double cosine = n.dot(toSky);
        const double expected = radius == 90.0 ? 0.5 * (1.0 + cosine) : reference(cosine);
        const double got =
            double(capture.radiance[3 * (std::size_t(y) * Size + std::size_t(x))]) / (0.5 * Unit);
        worst = std::max(worst, std::abs(got - expected));
        ++compared;
      }
    }
    EXPECT_GT(compared, 300);
    EXPECT_LT(worst, 1e-3); // of the irradiance on a surface that faces it
  }
}

TEST_F(PhotometryTest, AReflectanceOutOfRangeChangesNothing) {
  GraphicsObject ball = Object("ball", RootFrame, MakeSphere(1.0), std::make_shared<Material>());
  const ObjectId id = scene->AddObject(ball);
  MaterialOverride over;
  over.reflectance = ReflectanceBy(Law::Hapke);
  over.reflectance->oppositionWidth = 0.0;
  EXPECT_THROW(scene->SetObjectMaterial(id, over), Error);
  EXPECT_FALSE(scene->Object(id).material.reflectance.has_value());
  auto material = std::make_shared<Material>();
  material->reflectance.roughness_deg = 70;
  EXPECT_THROW(scene->AddObject(Object("other", RootFrame, MakeSphere(1.0), material)), Error);
}

} // namespace dspace
