// Drawn stars: their light and places against closed forms.
#include "RenderingTestSupport.h"

#include <dspace/render/stars/StarDrawer.h>
#include <dspace/scene/stars/StarField.h>

namespace dspace {
namespace {

struct StarTest : RenderingFixture {
  static constexpr int Size = 201;

  Eigen::Quaterniond forward; // of the camera that looks along the root's X

  StarTest() {
    Look({});
    forward = scene->Vantage("main").GetCamera("camera").mount.X_FC.rotation;
    RegisterStarDrawer(context->GetDrawers());
  }

  // The root's X is the camera's Z, -Y its X, -Z its Y.
  static Eigen::Vector3d DirectionOf(double x, double y) {
    const Projection::Ray ray = Projection().PixelRay(x, y, Size, Size);
    return Eigen::Vector3d(ray.direction.z(), -ray.direction.x(), -ray.direction.y()).normalized();
  }
  std::shared_ptr<StarField> Add(const std::vector<Star>& stars, const StarLook& look = {}) {
    auto field = std::make_shared<StarField>("stars", stars);
    field->SetLook("stars", look);
    GraphicsObject object;
    object.name = "stars";
    object.custom = field;
    scene->AddObject(object);
    return field;
  }
  // Radiances [W/m^2/sr] of the green channel.
  std::vector<double> Radiances(vtkDspaceViewport& viewport) {
    CaptureRequest request;
    request.color = false;
    request.radiance = true;
    const Capture capture = viewport.GetCapture(request);
    std::vector<double> green;
    for (std::size_t i = 1; i < capture.radiance.size(); i += 3) {
      green.push_back(double(capture.radiance[i]));
    }
    return green;
  }
  // Solid angle of a pixel: of a flat square at distance 1.
  static double SolidAngle(double x, double y) {
    const double edge = Projection().MetresPerPixel(1.0, Size);
    return edge * edge * std::pow(DirectionOf(x, y).x(), 3);
  }
  struct Blob {
    double irradiance = 0.0; // [W/m^2]
    double x = 0.0;
    double y = 0.0;
  };
  Blob Sum(const std::vector<double>& radiances, int left, int right) {
    Blob blob;
    for (int y = 0; y < Size; ++y) {
      for (int x = left; x < right; ++x) {
        const double light = radiances[std::size_t(y * Size + x)] * SolidAngle(x, y);
        blob.irradiance += light;
        blob.x += light * x;
        blob.y += light * y;
      }
    }
    blob.x /= blob.irradiance;
    blob.y /= blob.irradiance;
    return blob;
  }
};

Star StarAt(const Eigen::Vector3d& direction, double magnitude) {
  Star star;
  star.direction = direction.cast<float>();
  star.magnitude = float(magnitude);
  star.colorIndex = std::numeric_limits<float>::quiet_NaN();
  return star;
}

} // namespace

// V = 0 is 2.69e-8 W/m^2 at 1361 W/m^2 and V = -26.76 of the Sun.
TEST_F(StarTest, AStarsPixelsAddUpToItsIrradianceAtItsPlace) {
  for (const int samples : {1, 3}) {
    for (const double spread : {0.4, 0.6, 1.5}) {
      SCOPED_TRACE(spread);
      StarLook look;
      look.spread = spread;
      look.gain = 1e6; // not in physical pictures
      Add({StarAt(DirectionOf(40.3, 77.9), 0.0), StarAt(DirectionOf(170.75, 15.5), 2.5)}, look);
      auto viewport = View(Size, Size);
      viewport->SetSamples(samples);
      const std::vector<double> radiances = Radiances(*viewport);
      const Blob first = Sum(radiances, 0, 100);
      EXPECT_NEAR(first.irradiance / 2.6903e-8, 1.0, 1e-3);
      // The mean of a Gaussian that is sampled by pixels is off by up to this much.
      const double aliased = 0.003 + std::exp(-2.0 * std::pow(M_PI * spread, 2)) / M_PI;
      EXPECT_NEAR(first.x, 40.3, aliased);
      EXPECT_NEAR(first.y, 77.9, aliased);
      const Blob second = Sum(radiances, 100, Size);
      EXPECT_NEAR(second.irradiance / 2.6903e-9, 1.0, 2e-3);
      EXPECT_NEAR(second.x, 170.75, aliased);
      EXPECT_NEAR(second.y, 15.5, aliased);
      scene->RemoveObject(scene->FindObject("stars"));
    }
  }
}

TEST_F(StarTest, AGaussianIsIntegratedOverEachPixel) {
  StarLook look;
  look.spread = 0.8;
  const double x = 100.2;
  const double y = 99.7;
  Add({StarAt(DirectionOf(x, y), 1.0)}, look);
  auto viewport = View(Size, Size);
  const std::vector<double> radiances = Radiances(*viewport);
  const double all = 2.6903e-8 * std::pow(10.0, -0.4) / SolidAngle(x, y);
  const auto share = [](double d) {
    const double scale = 1.0 / (0.8 * std::sqrt(2.0));
    return 0.5 * (std::erf((d + 0.5) * scale) - std::erf((d - 0.5) * scale));
  };
  for (int row = 97; row <= 103; ++row) {
    for (int column = 97; column <= 103; ++column) {
      EXPECT_NEAR(radiances[std::size_t(row * Size + column)],
                  all * share(column - x) * share(row - y), 2e-3 * all);
    }
  }
}

TEST_F(StarTest, DisplayColorsFollowGainAndExposureAndFaintStarsAreLeftOut) {
  const auto field = Add({StarAt(DirectionOf(50, 50), 3.0)});
  auto viewport = View(Size, Size);
  const auto brightest = [&] {
    const std::vector<std::uint8_t> picture = viewport->GetCapture({}).color;
    std::uint8_t most = 0;
    for (std::size_t i = 1; i < picture.size(); i += picture.size() / (Size * Size)) {
      most = std::max(most, picture[i]);
    }
    return int(most);
  };
  EXPECT_EQ(brightest(), 0); // as on photographs of the sunlit Moon
  // So that its brightest pixel shows linear light 0.5: display value 188.
  const double peak = std::pow(std::erf(0.5 / (0.6 * std::sqrt(2.0))), 2);
  const double light = 2.6903e-8 * std::pow(10.0, -1.2) * peak / SolidAngle(50, 50) * M_PI / 1361.0;
  StarLook look;
  look.gain = 0.5 / light;
  field->SetLook("stars", look);
  EXPECT_NEAR(brightest(), 188, 1);
  look.gain = 1.0;
  field->SetLook("stars", look);
  ViewLook exposed;
  exposed.exposure = 0.5 / light;
  viewport->SetLook(exposed);
  EXPECT_NEAR(brightest(), 188, 1);
  exposed.automaticExposure = true; // exposed after it is drawn; stars are no lit surface
  exposed.exposure = 0.5 / light;
  viewport->SetLook(exposed);
  EXPECT_NEAR(brightest(), 188, 2);
  look.faintest = 2.9;
  field->SetLook("stars", look);
  EXPECT_EQ(brightest(), 0);
}

TEST_F(StarTest, ObjectsHideStarsAndStarsHaveNoDepth) {
  Add({StarAt(DirectionOf(100, 100), 0.0), StarAt(DirectionOf(20, 20), 0.0)});
  GraphicsObject ball;
  ball.name = "ball";
  ball.levels = {
      {{{std::make_shared<const Mesh>(MakeSphere(0.3, 32)), std::make_shared<Material>()}}, 0.0}};
  ball.X_FO.translation() = Eigen::Vector3d(1e9, 0, 0);
  ball.X_FO.linear() *= 1e8;
  scene->AddObject(ball);
  auto viewport = View(Size, Size);
  const std::vector<double> radiances = Radiances(*viewport);
  const Blob all = Sum(radiances, 0, Size);
  EXPECT_NEAR(all.x, 20.0, 0.05);
  EXPECT_NEAR(all.y, 20.0, 0.05);
  CaptureRequest request;
  request.depth = request.label = true;
  const Capture capture = viewport->GetCapture(request);
  const std::size_t at = 20 * Size + 20;
  EXPECT_EQ(capture.label[at], 0u);
  EXPECT_FALSE(capture.depth[at] < 1e30f);
}

// Parts of the sky that a view does not see are left out, and no others.
TEST_F(StarTest, EveryViewHasAllOfItsStars) {
  std::vector<Star> stars;
  for (int i = 0; i < 2000; ++i) { // a spiral over the sphere
    const double z = 1.0 - (2.0 * i + 1.0) / 2000.0;
    const double angle = 2.399963 * i;
    const double r = std::sqrt(1.0 - z * z);
    stars.push_back(StarAt({r * std::cos(angle), r * std::sin(angle), z}, 0.0));
  }
  Add(stars);
  auto viewport = View(Size, Size);
  for (const double pitch : {-89.0, -40.0, 0.0, 35.3, 90.0}) {
    for (const double yaw : {0.0, 45.0, 100.0, 180.0, -77.0}) {
      const Eigen::Matrix3d turn =
          (Eigen::AngleAxisd(yaw * M_PI / 180.0, Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(pitch * M_PI / 180.0, Eigen::Vector3d::UnitY()))
              .toRotationMatrix();
      Camera camera = scene->Vantage("main").GetCamera("camera");
      camera.mount.X_FC.rotation = Eigen::Quaterniond(turn) * this->forward;
      scene->SetCamera("main", camera);
      int expected = 0;
      const double edge = 0.5 * Size * Projection().MetresPerPixel(1.0, Size);
      for (const Star& star : stars) {
        const Eigen::Vector3d d = turn.transpose() * star.direction.cast<double>();
        expected += d.x() > 0.0 && std::abs(d.y()) < edge * d.x() && std::abs(d.z()) < edge * d.x();
      }
      const double seen = Sum(Radiances(*viewport), 0, Size).irradiance / 2.6903e-8;
      EXPECT_GT(expected, 50);
      EXPECT_NEAR(seen, expected, 2.0) << pitch << " " << yaw; // some lie on the edges
    }
  }
}

TEST_F(StarTest, ALargeStarBeyondTheEdgeReachesIntoThePicture) {
  StarLook look;
  look.spread = 6.0;
  Add({StarAt(DirectionOf(-3.0, 100.0), 0.0)}, look);
  auto viewport = View(Size, Size);
  const Blob seen = Sum(Radiances(*viewport), 0, Size);
  // The part of the Gaussian right of the picture's edge at x = -0.5.
  const double share = 0.5 * std::erfc(2.5 / (6.0 * std::sqrt(2.0)));
  EXPECT_NEAR(seen.irradiance / (2.6903e-8 * share), 1.0, 0.02);
}

} // namespace dspace
