// Precision: far from the root's origin, from centimetres to beyond the Moon, and between
// viewports.
#include "RenderingTestSupport.h"

using namespace dspace;

namespace {

struct PrecisionTest : RenderingFixture {};

// One disc of each primary colour, on a ship that the camera's branch does not hold.
struct DiscPicture {
  // Where each disc's light has its centre, and how many pixels it covers. A pixel's value in
  // linear light is its coverage to 1/64; over the thousands of samples along a rim of this size
  // the steps average out to about a thousandth of a pixel.
  std::array<Eigen::Vector2d, 3> centre;
  std::array<double, 3> area;

  explicit DiscPicture(const Capture& capture) {
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      double weight = 0.0;
      for (int i = 0; i < capture.width * capture.height; ++i) {
        const double coverage = LinearFromSrgb(capture.color[4 * i + k] / 255.0);
        sum += coverage * Eigen::Vector2d(i % capture.width, i / capture.width);
        weight += coverage;
      }
      this->centre[k] = sum / weight;
      this->area[k] = weight;
    }
  }
};

} // namespace

TEST_F(PrecisionTest, WithTheCameraInAnotherBranchNothingMovesByAFiftiethOfAPixel) {
  const std::array<Eigen::Vector3d, 3> places = {// on the ship, X ahead of the camera, in metres
                                                 Eigen::Vector3d(0.0, 0.613, 0.527),
                                                 Eigen::Vector3d(1.3, -0.871, 0.604),
                                                 Eigen::Vector3d(-0.7, 0.118, -0.733)};
  const double radius = 0.5;
  const Eigen::Vector3d ahead(5, 0, 0); // from the camera to the ship
  const FrameId ship = scene->Frames().Create(RootFrame, "ship", At(5, 0, 0));
  const FrameId eye = scene->Frames().Create(RootFrame, "eye", At(0, 0, 0));
  for (int k = 0; k < 3; ++k) {
    const std::string name = "disc " + std::to_string(k);
    Pose place;
    place.position = places[k];
    std::array<double, 3> color = {0, 0, 0};
    color[k] = 1;
    GraphicsObject disc = Object(name, scene->Frames().Create(ship, name, place),
                                 MakeDisc(radius, 1024), Unlit(color));
    disc.X_FO = // its face towards the camera
        Eigen::Affine3d(Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitY()));
    scene->AddObject(disc);
  }
  Look({}, eye);
  const int size = 400;
  const double f = 0.5 * size / std::tan(M_PI / 8); // pixels; 45 degrees from top to bottom
  auto viewport = View(size, size, 8);
  // A disc that is parallel to the picture shows as a disc about its centre's image.
  const auto expectByHand = [&](const DiscPicture& picture, const char* when) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d p = ahead + places[k]; // X ahead, Y left, Z up
      const Eigen::Vector2d hand(0.5 * (size - 1) - f * p.y() / p.x(),
                                 0.5 * (size - 1) - f * p.z() / p.x());
      EXPECT_LT((picture.centre[k] - hand).norm(), 0.02) << when << ", disc " << k;
      EXPECT_NEAR(std::sqrt(picture.area[k] / M_PI), f * radius / p.x(), 0.02)
          << when << ", disc " << k;
    }
  };
  const DiscPicture near(viewport->GetCapture({}));
  expectByHand(near, "near the root's origin");

  // Both branches go one astronomical unit out, and turn.
  const double au = 149597870700.0;
  Pose X_RE = At(au, au, -au);
  X_RE.rotation = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized());
  Pose X_RS = X_RE;
  X_RS.position = X_RE.Apply(ahead);
  scene->Frames().SetLocalPose(eye, X_RE);
  scene->Frames().SetLocalPose(ship, X_RS);
  const DiscPicture far(viewport->GetCapture({}));
  expectByHand(far, "one astronomical unit away");
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT((far.centre[k] - near.centre[k]).norm(), 0.02) << "disc " << k;
  }
  // The relative pose itself, by closed form: doubles out there are 3e-5 m apart.
  EXPECT_LT((scene->Frames().RelativePose(eye, ship).position - ahead).norm() * f / 5, 0.02);

  // What the picture tells is fine enough to see a move of a fiftieth of a pixel.
  scene->Frames().SetLocalPose(eye, At(0, 0, 0));
  scene->Frames().SetLocalPose(ship, At(5, -0.02 * 5 / f, 0));
  const DiscPicture moved(viewport->GetCapture({}));
  EXPECT_NEAR(moved.centre[0].x() - near.centre[0].x(), 0.02, 0.004);
}

TEST_F(PrecisionTest, DepthHoldsFromCentimetresToBeyondTheMoon) {
  Projection projection;
  projection.nearDistance = 0.1;
  projection.farDistance = 4e8;
  projection.verticalFov_deg = 40;
  Look(projection);
  auto viewport = View(64, 64);
  for (const double distance : {0.2, 1.0, 1e3, 1e6, 1e8, 3.5e8}) {
    auto trial = std::make_shared<Scene>("trial");
    trial->CreateVantage("main");
    Camera camera = scene->Vantage("main").ActiveCamera();
    trial->SetCamera("main", camera);
    const double size = 0.4 * distance;
    // The farther one is drawn last, and is tilted so that depths vary over the picture.
    Pose near = At(distance, 0, 0);
    near.rotation = Eigen::AngleAxisd(0.5, Eigen::Vector3d(0, 1, 1).normalized());
    Pose far = near;
    far.position.x() = distance * (1 + 1e-4);
    Mesh mesh = PlaneTowardsCamera(1, 1);
    GraphicsObject front =
        Object("front", trial->Frames().Create(RootFrame, "f", near), mesh, Unlit({1, 1, 1}));
    GraphicsObject back =
        Object("back", trial->Frames().Create(RootFrame, "b", far), mesh, Unlit({1, 0, 0}));
    front.X_FO = Eigen::Affine3d(Eigen::Scaling(size));
    back.X_FO = Eigen::Affine3d(Eigen::Scaling(size));
    const ObjectId frontId = trial->AddObject(front);
    const ObjectId backId = trial->AddObject(back);
    auto view = vtkSmartPointer<vtkDspaceViewport>::New();
    view->Initialize(context, trial, "trial", "main", 64, 64);
    const Capture capture = view->GetCapture({false, true, true, false, {}});
    int fronts = 0;
    int backs = 0;
    for (int y = 20; y < 44; ++y) {
      for (int x = 20; x < 44; ++x) {
        fronts += capture.label[y * 64 + x] == frontId;
        backs += capture.label[y * 64 + x] == backId;
      }
    }
    EXPECT_EQ(fronts, 24 * 24) << "at " << distance << " m";
    EXPECT_EQ(backs, 0) << "at " << distance << " m";
    // Depth against the tilted plane itself, at the central pixel's corner of four.
    const Eigen::Vector3d n = near.rotation * Eigen::Vector3d::UnitX();
    const auto depthAt = [&](double x, double y) {
      const auto ray = projection.PixelRay(x, y, 64, 64);
      const Eigen::Vector3d d(ray.direction.z(), -ray.direction.x(), -ray.direction.y()); // in root
      return n.dot(near.position) / n.dot(d) * d.x();
    };
    const double depth = depthAt(30, 40);
    const double step =
        std::hypot(depthAt(31, 40) - depth, depthAt(30, 41) - depth) * this->VertexOffset();
    EXPECT_NEAR(capture.depth[40 * 64 + 30], depth, 2e-6 * depth + step)
        << "at " << distance << " m";
  }
}

TEST_F(PrecisionTest, MovingTheCommonFrameByAnAstronomicalUnitChangesNoByte) {
  const double au = 149597870700.0;
  const FrameId ship = scene->Frames().Create(RootFrame, "ship", At(1, 2, 3));
  const FrameId part = scene->Frames().Create(ship, "part", At(5, 0.3, 0.2));
  auto lit = std::make_shared<Material>();
  scene->AddObject(Object("part", part, MakeSphere(1.0), lit));
  Light sun;
  sun.name = "sun";
  sun.direction = {1, 0.3, -0.5};
  scene->SetLight(sun);
  Light lamp; // hangs on the ship, as the camera does
  lamp.name = "lamp";
  lamp.kind = Light::Kind::Point;
  lamp.frame = ship;
  lamp.position = {3, 1, 1};
  scene->SetLight(lamp);
  Look({}, ship);
  auto viewport = View(120, 90);
  const Capture before = viewport->GetCapture({true, true, true, false, {}});
  scene->Frames().SetLocalPose(ship, At(au, -au, 0.5 * au));
  const Capture after = viewport->GetCapture({true, true, true, false, {}});
  EXPECT_EQ(before.color, after.color);
  EXPECT_EQ(before.depth, after.depth);
  EXPECT_EQ(before.label, after.label);
  EXPECT_GT(ExtentOf(after, 1).right, 0);
}

TEST_F(PrecisionTest, CamerasAtEarthAndMoonShareTheSceneWithoutUploads) {
  const double distance = 384400e3;
  scene->AddObject(Object("earth", scene->Frames().Create(RootFrame, "earth", At(0, 0, 0)),
                          MakeSphere(6.4e6, 64), std::make_shared<Material>()));
  scene->AddObject(Object("moon", scene->Frames().Create(RootFrame, "moon", At(distance, 0, 0)),
                          MakeSphere(1.7e6, 64), std::make_shared<Material>()));
  Look({});
  Camera nearEarth = scene->Vantage("main").ActiveCamera();
  nearEarth.name = "near earth";
  nearEarth.mount.X_FC = LookAt("", {-2e7, 0, 0}, {0, 0, 0}, {0, 0, 1});
  scene->SetCamera("main", nearEarth);
  Camera nearMoon = nearEarth;
  nearMoon.name = "near moon";
  nearMoon.mount.X_FC = LookAt("", {distance + 5e6, 1e6, 0}, {distance, 0, 0}, {0, 0, 1});
  scene->SetCamera("main", nearMoon);
  auto a = View(80, 60);
  auto b = View(80, 60);
  a->SetCamera("near earth");
  b->SetCamera("near moon");
  a->Render();
  b->Render();
  const RenderStatistics first = context->GetStatistics();
  EXPECT_GT(first.meshBytesUploaded, 0u);
  for (int i = 0; i < 3; ++i) {
    a->ForceRender();
    b->ForceRender();
  }
  const RenderStatistics last = context->GetStatistics();
  EXPECT_EQ(first.meshBytesUploaded, last.meshBytesUploaded);
  EXPECT_EQ(first.textureBytesUploaded, last.textureBytesUploaded);
  EXPECT_EQ(first.instanceBytesUploaded, last.instanceBytesUploaded);
  EXPECT_EQ(first.meshBytes, last.meshBytes);
}

TEST_F(PrecisionTest, AWheelOnTheMoonDoesNotJitter) {
  // A wheel seen from 2 m, both on the Moon's body-fixed frame far from the root: as the Moon
  // moves along its orbit in steps that floats cannot resolve, no byte of the picture changes.
  const FrameId moon = scene->Frames().Create(RootFrame, "moon", At(3.844e8, 0, 0));
  const FrameId site = scene->Frames().Create(moon, "site", At(1737400.0, 0, 0));
  const FrameId wheel = scene->Frames().Create(site, "wheel", At(2, 0, 0));
  scene->AddObject(Object("wheel", wheel, MakeCylinder(0.25, 0.2), std::make_shared<Material>()));
  Light head;
  head.name = "head";
  head.kind = Light::Kind::Head;
  scene->SetLight(head);
  Look({}, site);
  auto viewport = View(100, 100);
  const Capture first = viewport->GetCapture({});
  for (int step = 1; step < 20; ++step) {
    Pose pose = At(3.844e8 + 0.137 * step, 1022.0 * step, 0);
    pose.rotation = Eigen::AngleAxisd(1e-7 * step, Eigen::Vector3d::UnitZ());
    scene->Frames().SetLocalPose(moon, pose);
    ASSERT_EQ(viewport->GetCapture({}).color, first.color) << "step " << step;
  }
}
