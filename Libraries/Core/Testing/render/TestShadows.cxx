// Shadows of the Sun against rays to points of its disc, in double precision.
#include "RenderingTestSupport.h"

#include <functional>

using namespace dspace;

namespace {

// What throws shadows: a box, or the ellipsoid that fits into it.
struct Box {
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  bool round = false;

  bool Meets(const Eigen::Vector3d& from, const Eigen::Vector3d& along) const {
    if (this->round) {
      const Eigen::Array3d half = 0.5 * (this->high - this->low).array();
      const Eigen::Vector3d o = ((from - 0.5 * (this->high + this->low)).array() / half).matrix();
      const Eigen::Vector3d d = (along.array() / half).matrix();
      const double b = o.dot(d);
      const double root = b * b - d.squaredNorm() * (o.squaredNorm() - 1.0);
      return root > 0.0 && -b + std::sqrt(root) > 1e-9;
    }
    double first = 1e-9;
    double last = 1e9;
    for (int i = 0; i < 3; ++i) {
      const double a = (this->low[i] - from[i]) / along[i];
      const double b = (this->high[i] - from[i]) / along[i];
      first = std::max(first, std::min(a, b));
      last = std::min(last, std::max(a, b));
    }
    return first < last;
  }
};

// White matt ground at z = 0 with boxes on it, seen by a camera at a place.
struct ShadowTest : RenderingFixture {
  std::vector<Box> boxes;
  Light sun;
  ViewLook look;
  std::shared_ptr<Material> white = std::make_shared<Material>();
  ObjectId ground = 0;
  int width = 640;
  int height = 360;
  Capture capture;

  ShadowTest() {
    this->white->color = {1, 1, 1};
    this->white->roughness = 1.0;
    this->sun.name = SunName;
    this->sun.intensity = 0.9;
    this->look.shadows.shown = true;
    this->scene->CreateVantage("main");
    this->ground =
        this->scene->AddObject(Object("ground", RootFrame, MakePlane(2000, 2000), this->white));
  }
  // The way the light comes from.
  Eigen::Vector3d ToSun() const { return -this->sun.direction.normalized(); }
  void SetSun(double azimuth_deg, double elevation_deg) {
    const double a = azimuth_deg * M_PI / 180.0;
    const double e = elevation_deg * M_PI / 180.0;
    this->sun.direction =
        -Eigen::Vector3d(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e));
    this->sun.intensity = 0.9 / std::sin(std::max(e, 0.01)); // so that level ground shows 0.9
    this->scene->SetLight(this->sun);
  }
  void AddBox(const Eigen::Vector3d& center, const Eigen::Vector3d& size) {
    const std::string name = "box " + std::to_string(this->boxes.size());
    const FrameId frame =
        this->scene->Frames().Create(RootFrame, name, At(center.x(), center.y(), center.z()));
    this->scene->AddObject(Object(name, frame, MakeBox(size), this->white));
    this->boxes.push_back({center - 0.5 * size, center + 0.5 * size});
  }
  void AddBall(const Eigen::Vector3d& center, double radius) {
    const std::string name = "ball " + std::to_string(this->boxes.size());
    const FrameId frame =
        this->scene->Frames().Create(RootFrame, name, At(center.x(), center.y(), center.z()));
    this->scene->AddObject(Object(name, frame, MakeSphere(radius, 256), this->white));
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(radius);
    this->boxes.push_back({center - half, center + half, true});
  }
  Projection projection;
  Pose X_RC;
  void Stand(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
    Camera camera;
    camera.name = "camera";
    camera.projection = this->projection;
    camera.mount.X_FC = LookAt("camera", eye, target, {0, 0, 1});
    this->X_RC = camera.mount.X_FC;
    this->scene->SetCamera("main", camera);
  }
  vtkSmartPointer<vtkDspaceViewport> viewport;
  void Take() {
    if (!this->viewport) {
      this->viewport = this->View(this->width, this->height);
    }
    this->viewport->SetLook(this->look);
    CaptureRequest request;
    request.label = true;
    request.litFraction = true;
    this->capture = this->viewport->GetCapture(request);
  }
  double Lit(int x, int y) const {
    return this->capture.litFraction[std::size_t(y) * this->width + x];
  }
  // What the picture shows of a pixel, linear.
  double Shown(int x, int y) const {
    return LinearFromSrgb(this->capture.color[std::size_t(4) * (y * this->width + x)] / 255.0);
  }
  // Where a pixel's ray meets the ground.
  Eigen::Vector3d OnGround(double x, double y) const {
    const Projection::Ray ray = this->projection.PixelRay(x, y, this->width, this->height);
    const Eigen::Vector3d from = this->X_RC.Apply(ray.origin);
    const Eigen::Vector3d along = this->X_RC.rotation * ray.direction;
    return from - from.z() / along.z() * along;
  }
  // The lit part of the disc by rays to `points` points of it.
  double LitFraction(const Eigen::Vector3d& p, int points = 100) const {
    const Eigen::Matrix3d axes = LightAxes(this->ToSun());
    const double radius = std::tan(this->sun.radius_deg * M_PI / 180.0);
    int lit = 0;
    for (int i = 0; i < points; ++i) {
      const double r = radius * std::sqrt((i + 0.5) / points);
      const double angle = 2.39996323 * i;
      const Eigen::Vector3d ray =
          axes.transpose() * Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), 1.0);
      bool hidden = false;
      for (const Box& box : this->boxes) {
        hidden = hidden || box.Meets(p, ray);
      }
      lit += hidden ? 0 : 1;
    }
    return double(lit) / points;
  }
  struct Difference {
    int pixels = 0;        // of the ground
    int wrong = 0;         // by more than 0.25
    double farthest = 0.0; // of a wrong one, across the rays, from where they say the same [m]
    double mean = 0.0;
    int shadowed = 0;
  };
  Difference Compare(double within = 1e9) {
    Difference difference;
    const Eigen::Vector3d toSun = this->ToSun();
    const Eigen::Matrix3d axes = LightAxes(toSun);
    for (int y = 0; y < this->height; y += 2) {
      for (int x = y / 2 % 2; x < this->width; x += 2) {
        if (this->capture.label[std::size_t(y) * this->width + x] != this->ground) {
          continue;
        }
        const Eigen::Vector3d p = this->OnGround(x, y);
        if ((p - this->X_RC.position).norm() > within) {
          continue;
        }
        const double expected = this->LitFraction(p);
        const double drawn = this->Lit(x, y);
        ++difference.pixels;
        difference.mean += std::abs(drawn - expected);
        difference.shadowed += expected < 0.5;
        if (std::abs(drawn - expected) > 0.25) {
          ++difference.wrong;
          // The nearest place on the ground, across the Sun's rays, where rays say what is drawn.
          double nearest = 1.0;
          for (double r = 0.002; r < nearest; r *= 1.4) {
            for (int i = 0; i < 12; ++i) {
              const double angle = 2 * M_PI * i / 12;
              const Eigen::Vector3d across = r * axes.topRows<2>().transpose() *
                                             Eigen::Vector2d(std::cos(angle), std::sin(angle));
              const Eigen::Vector3d q = p + across - across.z() / toSun.z() * toSun;
              const double there = this->LitFraction(q, 40);
              // It says so, or lies on the other side of an edge.
              if (std::abs(there - drawn) <= 0.25 || (there - drawn) * (expected - drawn) < 0.0) {
                nearest = r;
                break;
              }
            }
          }
          difference.farthest = std::max(difference.farthest, nearest);
        }
      }
    }
    difference.mean /= std::max(1, difference.pixels);
    return difference;
  }
};

} // namespace

// The Sun on the horizon, low and high: within a texel, which is at most 2 cm within 5 m.
TEST_F(ShadowTest, APoleThrowsTheShadowThatRaysSay) {
  AddBox({0, 0, 0.5}, {0.1, 0.1, 1.0});
  Stand({-4.0, -2.5, 1.7}, {0.3, 0.3, 0.2});
  for (const double elevation : {1.5, 10.0, 45.0}) {
    SCOPED_TRACE(elevation);
    SetSun(220, elevation);
    Take();
    EXPECT_LT(Compare().wrong, 0.005 * Compare().pixels);
    const Difference d = Compare(5.5);
    EXPECT_GT(d.shadowed, 15);
    EXPECT_LT(d.wrong, 0.005 * d.pixels);
    EXPECT_LT(d.farthest, 0.02);
    EXPECT_LT(d.mean, 0.01);
  }
}

TEST_F(ShadowTest, ABallThrowsAnEllipse) {
  AddBall({0, 0, 0.8}, 0.6);
  Stand({-3.0, -4.5, 2.5}, {0.5, 0.8, 0.0});
  for (const double elevation : {20.0, 60.0, 90.0}) {
    SCOPED_TRACE(elevation);
    SetSun(120, elevation);
    Take();
    const Difference d = Compare();
    EXPECT_GT(d.shadowed, 300);
    EXPECT_LT(d.wrong, 0.005 * d.pixels);
    EXPECT_LT(d.farthest, 0.025);
    EXPECT_LT(d.mean, 0.01);
  }
}

// The penumbra grows with the height of what throws the shadow: a slab 10 m up blurs over 9 cm.
TEST_F(ShadowTest, ThePenumbraIsThatOfTheDisc) {
  AddBox({0, 0, 10.0}, {2.0, 40.0, 0.1});
  SetSun(90, 90);
  Stand({1.0, -4.0, 3.0}, {1.0, 0.0, 0.0});
  Take();
  const Difference d = Compare(7.0);
  EXPECT_LT(d.wrong, 0.005 * d.pixels);
  EXPECT_LT(d.mean, 0.01);
  int partly = 0;
  double outermost = 0.0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double lit = Lit(x, y);
      const Eigen::Vector3d p = OnGround(x, y);
      if ((p - X_RC.position).norm() < 7.0 && lit > 0.03 && lit < 0.97) {
        ++partly;
        outermost = std::max(outermost, std::abs(std::abs(p.x()) - 1.0));
      }
    }
  }
  // Half of it: 10 m times the tangent of 0.2666 degrees, and a texel.
  EXPECT_GT(partly, 100);
  EXPECT_NEAR(outermost, 10.0 * std::tan(0.2666 * M_PI / 180.0), 0.015);
}

// What stands on the ground is dark from its foot on.
TEST_F(ShadowTest, AShadowBeginsAtTheContact) {
  AddBall({0, 0, 0.25}, 0.25); // a wheel's shape where it touches
  AddBox({1.0, 0, 0.25}, {0.2, 0.2, 0.5});
  SetSun(0, 35);
  Stand({0.5, -2.5, 0.8}, {0.5, 0, 0.1});
  Take();
  const Difference d = Compare();
  EXPECT_LT(d.farthest, 0.012);
  EXPECT_LT(d.wrong, 0.005 * d.pixels);
}

TEST_F(ShadowTest, CastersOutsideThePictureCount) {
  AddBox({-20.0, 0, 5.0}, {0.6, 60.0, 10.0}); // behind the camera
  SetSun(270, 20);
  Stand({-1.0, 0.0, 2.0}, {6.0, 0.0, 0.0});
  Take();
  const Difference d = Compare(9.0);
  EXPECT_GT(d.shadowed, 1000);
  EXPECT_LT(d.wrong, 0.005 * d.pixels);
  EXPECT_EQ(capture.label[std::size_t(height / 2) * width + width / 2], ground);
}

TEST_F(ShadowTest, OddSizesAndOffAxisAndParallelCamerasAreRight) {
  AddBox({0, 0, 0.5}, {0.4, 0.4, 1.0});
  SetSun(300, 40);
  Projection frustum;
  frustum.kind = Projection::Kind::Frustum;
  frustum.left = -0.2;
  frustum.right = 0.6;
  frustum.top = -0.5;
  frustum.bottom = 0.3;
  Projection parallel;
  parallel.kind = Projection::Kind::Orthographic;
  parallel.height = 4.0;
  for (const Projection& kind : {Projection(), frustum, parallel}) {
    for (const auto& [w, h] : {std::pair(317, 203), {101, 400}}) {
      this->projection = kind;
      this->viewport = nullptr;
      this->width = w;
      this->height = h;
      Stand({-3.0, -2.0, 2.5}, {0.2, -0.2, 0.2});
      Take();
      const Difference d = Compare();
      EXPECT_GT(d.shadowed, 20);
      EXPECT_LE(d.wrong, 0.005 * d.pixels + 1);
      EXPECT_LT(d.mean, 0.01);
    }
  }
}

// Along the camera, overhead, and from below: nothing is hidden, and nothing lit.
TEST_F(ShadowTest, TheSunAnywhere) {
  AddBox({0, 0, 0.5}, {0.4, 0.4, 1.0});
  Stand({-3.0, 0.0, 3.0}, {0, 0, 0});
  SetSun(270, 45); // behind the camera: what it sees is lit
  Take();
  EXPECT_LT(Compare().mean, 0.01);
  SetSun(0, 90);
  Take();
  EXPECT_LT(Compare().mean, 0.01);
  SetSun(0, -90);
  Take();
  for (int x = 0; x < width; x += 20) {
    if (capture.label[std::size_t(height - 2) * width + x] == ground) {
      EXPECT_EQ(Lit(x, height - 2), 0.0);
      EXPECT_EQ(Shown(x, height - 2), 0.0);
    }
  }
}

TEST_F(ShadowTest, OrnamentsAndTranslucentThingsThrowNone) {
  SetSun(0, 40);
  Stand({-3.0, -2.0, 2.0}, {0, 0, 0});
  Take();
  const std::vector<float> bare = capture.litFraction;
  GraphicsObject ornament = Object("ornament", RootFrame, MakeBox({1, 1, 1}), this->white);
  ornament.nature = Nature::Ornamental;
  ornament.X_FO.translation().z() = 6.0; // out of the picture
  scene->AddObject(ornament);
  auto glass = std::make_shared<Material>(*this->white);
  glass->opacity = 0.5;
  GraphicsObject pane = Object("pane", RootFrame, MakeBox({1, 1, 1}), glass);
  pane.X_FO.translation().z() = 6.0;
  scene->AddObject(pane);
  Take();
  EXPECT_EQ(capture.litFraction, bare);
}

TEST_F(ShadowTest, TwoViewportsOfOneSceneHaveTheirOwn) {
  AddBox({0, 0, 0.5}, {0.4, 0.4, 1.0});
  SetSun(200, 30);
  Stand({-3.0, -2.0, 2.0}, {0.5, 0.5, 0});
  auto with = View(320, 180);
  auto without = vtkSmartPointer<vtkDspaceViewport>::New();
  without->Initialize(context, scene, "other", "main", 320, 180, 1);
  with->SetLook(this->look);
  const auto lit = without->GetCapture({}).color;
  const auto shadowed = with->GetCapture({}).color;
  EXPECT_NE(lit, shadowed);
  EXPECT_EQ(without->GetCapture({}).color, lit);
  EXPECT_EQ(with->GetCapture({}).color, shadowed);
  ViewLook off = this->look;
  off.shadows.shown = false;
  with->SetLook(off);
  EXPECT_EQ(with->GetCapture({}).color, lit);
}

// A map is drawn again for exactly that which changes it: the picture is that of a viewport which
// draws all of them.
TEST_F(ShadowTest, MapsInWhichNothingChangesAreKept) {
  AddBox({0, 0, 0.5}, {0.4, 0.4, 1.0});
  AddBox({30, 2, 4}, {3, 3, 8});
  // Near ground and far ground, so that the near box throws no shadow on what a farther map serves.
  scene->RemoveObject(this->ground);
  scene->AddObject(Object("near ground", RootFrame, MakePlane(6, 6), this->white));
  GraphicsObject farGround = Object("far ground", RootFrame, MakePlane(30, 60), this->white);
  farGround.X_FO.translation() = Eigen::Vector3d(30, 0, 0);
  scene->AddObject(farGround);
  SetSun(200, 30);
  this->look.shadows.size = 512;
  Stand({-3.0, -2.0, 2.0}, {4, 0.5, 0});
  auto kept = View(320, 180);
  kept->SetLook(this->look);
  int number = 0;
  const auto compare = [&](const std::string& what) {
    SCOPED_TRACE(what);
    const Capture after = kept->GetCapture({});
    const auto counts = std::make_pair(context->GetStatistics().shadowMapsDrawn,
                                       context->GetStatistics().shadowMapsKept);
    auto fresh = vtkSmartPointer<vtkDspaceViewport>::New();
    fresh->Initialize(context, scene, "fresh " + std::to_string(++number), "main", 320, 180);
    fresh->SetSamples(1);
    fresh->SetLook(this->look);
    EXPECT_EQ(after.color, fresh->GetCapture({}).color);
    return counts;
  };
  const int all = compare("all").first;
  EXPECT_EQ(all, 4);
  const FrameId near = scene->Frames().Find("box 0");
  const FrameId far = scene->Frames().Find("box 1");
  scene->Frames().SetLocalPose(near, At(0.1, 0, 0.5));
  const auto [nearDrawn, nearKept] = compare("the near box moves");
  EXPECT_GT(nearDrawn, 0);
  EXPECT_GT(nearKept, 0);
  EXPECT_EQ(nearDrawn + nearKept, all);
  scene->Frames().SetLocalPose(far, At(30, 2.5, 4));
  const auto [farDrawn, farKept] = compare("the far box moves");
  EXPECT_GT(farDrawn, 0);
  EXPECT_GT(farKept, 0);
  SetSun(201, 30);
  EXPECT_EQ(compare("the Sun moves").second, 0);
  scene->SetObjectVisible(scene->FindObject("box 1"), false);
  compare("the far box is hidden");
  scene->SetObjectVisible(scene->FindObject("box 1"), true);
  compare("it is shown again");
  Stand({-3.0, -2.0, 2.1}, {4, 0.5, 0});
  EXPECT_EQ(compare("the camera moves").second, 0);
  this->look.shadows.size = 1024;
  kept->SetLook(this->look);
  EXPECT_EQ(compare("maps are larger").second, 0);
}

// A flight in 60 small steps: a point of the ground keeps its light, but for the edges of shadows.
TEST_F(ShadowTest, NothingFlickersWhileTheCameraMoves) {
  AddBox({0, 0, 0.5}, {0.4, 0.4, 1.0});
  AddBall({1.5, 1.0, 0.3}, 0.3);
  SetSun(230, 25);
  width = 320;
  height = 180;
  int jumps = 0;
  int compared = 0;
  for (int step = 0; step < 60; ++step) {
    const Eigen::Vector3d eye(-3.0 + 0.013 * step, -2.5 + 0.007 * step, 1.8 + 0.004 * step);
    Stand(eye, {0.4, 0.4, 0.1});
    Take();
    for (int y = 0; y < height; y += 3) {
      for (int x = 0; x < width; x += 3) {
        if (capture.label[std::size_t(y) * width + x] != ground) {
          continue;
        }
        const Eigen::Vector3d p = OnGround(x, y);
        if ((p - eye).norm() > 8.0) {
          continue;
        }
        const double expected = LitFraction(p, 40);
        if (expected == 0.0 || expected == 1.0) { // away from penumbrae all frames agree
          ++compared;
          jumps += std::abs(Lit(x, y) - expected) > 0.5;
        }
      }
    }
  }
  EXPECT_GT(compared, 100000);
  EXPECT_LT(jumps, 0.001 * compared);
}

TEST_F(ShadowTest, SettingsOutOfRangeAreRejected) {
  Stand({-3.0, -2.0, 2.0}, {0, 0, 0});
  auto view = View(64, 64);
  const auto rejected = [&](const std::function<void(ViewLook&)>& change, const char* words) {
    ViewLook changed = this->look;
    change(changed);
    try {
      view->SetLook(changed);
      ADD_FAILURE() << words;
    } catch (const Error& error) {
      EXPECT_EQ(int(error.GetKind()), int(Error::Kind::InvalidArgument));
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("view"), std::string::npos) << error.what();
    }
    EXPECT_EQ(view->GetLook().shadows.cascades, ShadowLook().cascades);
  };
  rejected([](ViewLook& l) { l.shadows.cascades = 0; }, "cascades 0");
  rejected([](ViewLook& l) { l.shadows.cascades = 9; }, "cascades 9");
  rejected([](ViewLook& l) { l.shadows.size = 255; }, "255 texels");
  rejected([](ViewLook& l) { l.shadows.size = 1 << 20; }, "1048576 texels");
  rejected([](ViewLook& l) { l.shadows.distance = -1.0; }, "distance");
  rejected([](ViewLook& l) { l.shadows.distance = std::nan(""); }, "distance");
  rejected([](ViewLook& l) { l.fill = 1.5; }, "fill");
  rejected([](ViewLook& l) { l.exposure = 0.0; }, "exposure");
}

// Red, green, blue, yellow, from the camera on; without shadows there is none.
TEST_F(ShadowTest, EachMapsPartOfTheViewHasAColorOnRequest) {
  SetSun(0, 90);
  Stand({0, 0, 2.0}, {10.0, 0, 0.0});
  this->look.shadows.cascadeColors = true;
  Take();
  const auto color = [&](int y) {
    const std::uint8_t* c = &capture.color[std::size_t(4) * (y * width + width / 2)];
    return std::array<bool, 3>{c[0] > 200, c[1] > 200, c[2] > 200};
  };
  EXPECT_EQ(color(height - 1), (std::array<bool, 3>{true, false, false}));
  std::vector<std::array<bool, 3>> seen;
  for (int y = height - 1; y >= 0; --y) {
    if (capture.label[std::size_t(y) * width + width / 2] == ground &&
        (seen.empty() || seen.back() != color(y))) {
      seen.push_back(color(y));
    }
  }
  ASSERT_GE(seen.size(), 4u);
  EXPECT_EQ(seen[1], (std::array<bool, 3>{false, true, false}));
  EXPECT_EQ(seen[2], (std::array<bool, 3>{false, false, true}));
  EXPECT_EQ(seen[3], (std::array<bool, 3>{true, true, false}));
}
