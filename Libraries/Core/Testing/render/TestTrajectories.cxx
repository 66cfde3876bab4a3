// Drawn trajectories: their place from metres to an astronomical unit, windows of time, labels.
#include "RenderingTestSupport.h"

#include <dspace/render/Captions.h>
#include <dspace/render/trajectories/TrajectoryDrawer.h>

namespace dspace {
namespace {

using Strip = TrajectoryLine::Strip;

struct TrajectoryTest : RenderingFixture {
  static constexpr int Size = 201;

  TrajectoryTest() { RegisterTrajectoryDrawer(context->GetDrawers()); }

  ObjectId Add(const std::shared_ptr<TrajectoryLine>& line, double width = 1.0) {
    GraphicsObject object;
    object.name = "line " + std::to_string(scene->Objects().size());
    object.custom = line;
    object.nature = Nature::Ornamental;
    object.fragment = "ornamental";
    object.lineWidth = width;
    return scene->AddObject(object);
  }
  static double Focal() { return 0.5 * Size / std::tan(M_PI / 8); } // 45 degrees
  // Column of a point of the camera's frame (X ahead, Y left).
  static double Column(const Eigen::Vector3d& p) {
    return 0.5 * (Size - 1) - Focal() * p.y() / p.x();
  }
  static int Brightness(const Capture& capture, int x, int y) {
    return capture.color[4 * static_cast<std::size_t>(y * Size + x)];
  }
  // The brightest column of a row.
  static int LineIn(const Capture& capture, int y) {
    int best = 0;
    for (int x = 1; x < Size; ++x) {
      best = Brightness(capture, x, y) > Brightness(capture, best, y) ? x : best;
    }
    return best;
  }
};

Strip Vertical(const Eigen::Vector3d& middle, double reach, int count) {
  Strip strip;
  for (int i = 0; i < count; ++i) {
    const double share = 2.0 * i / (count - 1.0) - 1.0;
    strip.times.push_back(100.0 * share);
    strip.points.push_back(middle + Eigen::Vector3d(0.0, 0.0, reach * share));
  }
  return strip;
}

TEST_F(TrajectoryTest, StandsWhereItsPointsAreFromMetresToAnAstronomicalUnit) {
  const double au = 149597870700.0;
  for (const double away : {0.0, 3.844e8, au}) {
    scene = std::make_shared<Scene>("scene");
    // The camera far from the line's frame, the line two metres before the camera.
    const Eigen::Vector3d eye(away, -away, 0.3 * away);
    const FrameId frame = scene->Frames().Create(RootFrame, "eye", At(eye.x(), eye.y(), eye.z()));
    Look({}, frame);
    const Eigen::Vector3d before(2.0, 0.371, 0.0);
    const ObjectId id = Add(std::make_shared<TrajectoryLine>(
        "line", std::vector<Strip>{Vertical(eye + before, 50.0, 101)}));
    auto viewport = View(Size, Size);
    CaptureRequest request;
    request.label = true;
    request.depth = true;
    const Capture capture = viewport->GetCapture(request);
    const double column = Column(before);
    for (const int row : {10, 100, 190}) {
      // At an astronomical unit the digits of the doubles end at 3e-5 m: 0.004 pixels.
      EXPECT_NEAR(LineIn(capture, row), column, 0.6) << away << " m away, row " << row;
      const int x = LineIn(capture, row);
      EXPECT_EQ(capture.label[static_cast<std::size_t>(row * Size + x)], id);
      EXPECT_NEAR(capture.depth[static_cast<std::size_t>(row * Size + x)], 2.0f, 1e-3f);
    }
  }
}

TEST_F(TrajectoryTest, DrawsAWindowOfTimeAboutTheScenesTime) {
  Look({});
  const auto line = std::make_shared<TrajectoryLine>(
      "line",
      std::vector<Strip>{Vertical({10.0, 0.0, 0.0}, 4.0, 41)}); // -100 s below to 100 s above
  Add(line, 3.0);
  auto viewport = View(Size, Size);
  TrajectoryLook look;
  look.before = 50.0;
  look.after = 10.0;
  line->SetLook("line", look);
  line->SetTime(0.0);
  // 4 m are 100 s: a row is 10 / f metres.
  const auto rowOf = [](double t) { return int(std::lround(100 - Focal() * 0.04 * t / 10.0)); };
  const auto seen = [&](double t) { return Brightness(viewport->GetCapture({}), 100, rowOf(t)); };
  EXPECT_EQ(seen(-45.0), 255);
  EXPECT_EQ(seen(8.0), 255);
  EXPECT_EQ(seen(-55.0), 0);
  EXPECT_EQ(seen(14.0), 0);
  line->SetTime(60.0);
  EXPECT_EQ(seen(-45.0), 0);
  EXPECT_EQ(seen(14.0), 255);
  EXPECT_EQ(seen(66.0), 255);
  EXPECT_EQ(seen(74.0), 0);
  // What is later is fainter: half of the light is the display value 188.
  look.after = 100.0;
  look.ahead = 0.5;
  line->SetLook("line", look);
  EXPECT_NEAR(seen(80.0), 188, 1);
  EXPECT_EQ(seen(40.0), 255);
  // Fading falls evenly in linear light to the window's end.
  look = {};
  look.before = 100.0;
  look.fade = true;
  line->SetLook("line", look);
  for (const double t : {50.0, 10.0, -20.0}) {
    const double light = LinearFromSrgb(seen(t) / 255.0);
    EXPECT_NEAR(light, 1.0 - (60.0 - t) / 100.0, 0.012) << t;
  }
}

TEST_F(TrajectoryTest, RunsThroughTheCraftThatIsNear) {
  // Four points of an orbit of 7,000 km: the chord passes the craft 2,000 km away.
  const auto path = [](double t) -> Eigen::Vector3d {
    return 7e6 * Eigen::Vector3d(std::cos(t), 0.0, std::sin(t));
  };
  Strip strip;
  for (int i = 0; i < 4; ++i) {
    strip.times.push_back(i);
    strip.points.push_back(path(i));
  }
  const auto line = std::make_shared<TrajectoryLine>("line", std::vector<Strip>{strip},
                                                     std::vector<TrajectoryLine::Tick>{}, path);
  Add(line, 2.0);
  // Looking along Y's negative from 10 m beside the craft.
  const Eigen::Vector3d craft = path(1.4);
  Camera camera;
  camera.name = "camera";
  camera.mount.X_FC =
      LookAt("camera", craft + Eigen::Vector3d(0, 10, 0), craft, craft.normalized());
  scene->CreateVantage("main");
  scene->SetCamera("main", camera);
  auto viewport = View(Size, Size);
  line->SetTime(0.0);
  const auto lit = [&] {
    const Capture capture = viewport->GetCapture({});
    int count = 0;
    for (int y = 98; y <= 102; ++y) {
      count += Brightness(capture, 100, y) > 0;
    }
    return count;
  };
  EXPECT_EQ(lit(), 0);
  line->SetTime(1.4);
  EXPECT_GE(lit(), 1);
}

TEST_F(TrajectoryTest, WhatIsBeforeItHidesIt) {
  Look({});
  Add(std::make_shared<TrajectoryLine>("line",
                                       std::vector<Strip>{Vertical({10.0, 0.0, 0.0}, 4.0, 3)}));
  scene->AddObject(Object("wall", scene->Frames().Create(RootFrame, "wall", At(5, 0, 2)),
                          PlaneTowardsCamera(4, 4), Unlit({0, 0, 0})));
  auto viewport = View(Size, Size);
  const Capture capture = viewport->GetCapture({});
  EXPECT_EQ(Brightness(capture, 100, 60), 0);
  EXPECT_GT(Brightness(capture, 100, 150), 200);
}

// Ornaments are no light: exposure does not change them, and translucent ones are there too.
TEST_F(TrajectoryTest, ExposureLeavesItAsItIs) {
  Look({});
  const auto line = std::make_shared<TrajectoryLine>(
      "line", std::vector<Strip>{Vertical({10.0, 0.0, 0.0}, 4.0, 3)});
  TrajectoryLook look;
  look.color = {0.5, 0.5, 0.5};
  line->SetLook("line", look);
  Add(line, 9.0);
  auto viewport = View(Size, Size);
  ViewLook exposed;
  exposed.exposure = 8.0;
  exposed.tone = ToneCurve::Filmic;
  const int before = Brightness(viewport->GetCapture({}), 100, 100);
  viewport->SetLook(exposed);
  EXPECT_NEAR(Brightness(viewport->GetCapture({}), 100, 100), before, 1);
  EXPECT_NEAR(before, 128, 1);
  look.opacity = 0.5; // half of the samples
  line->SetLook("line", look);
  const Capture capture = viewport->GetCapture({});
  double sum = 0.0;
  for (int y = 80; y < 120; ++y) {
    for (int x = 97; x <= 104; ++x) {
      sum += Brightness(capture, x, y);
    }
  }
  EXPECT_NEAR(sum / (40 * 8), 64, 4);
}

TEST(Captions, ThoseThatYieldLeaveRoom) {
  const auto caption = [](double x, bool yields) {
    Caption made;
    made.text = "12:00";
    made.at = {x, 50.0};
    made.yields = yields;
    return made;
  };
  const double width = 2.0 * HalfSize(caption(0, true))[0];
  std::vector<Caption> captions = {caption(0.0, true), caption(0.9 * width, true),
                                   caption(1.1 * width, true), caption(0.2 * width, false)};
  LeaveOutOverlaps(captions);
  ASSERT_EQ(captions.size(), 3u);
  EXPECT_EQ(captions[1].at[0], 1.1 * width);
  EXPECT_EQ(captions[2].at[0], 0.2 * width); // what does not yield stays
}

TEST(Captions, LegendsLeaveNoneBelowThem) {
  Caption caption;
  caption.text = "12E";
  const auto [x, y] = HalfSize(caption);
  std::vector<Caption> captions;
  const PictureBox legend{100, 200, 150, 300};
  for (const auto& at : {std::array<double, 2>{100 - x - 1, 250},
                         {100 - x + 1, 250},
                         {125, 300 + y + 1},
                         {125, 300 + y - 1},
                         {125, 250}}) {
    caption.at = at;
    captions.push_back(caption);
  }
  LeaveOutCovered(captions, {legend});
  ASSERT_EQ(captions.size(), 2u);
  EXPECT_EQ(captions[0].at[0], 100 - x - 1);
  EXPECT_EQ(captions[1].at[1], 300 + y + 1);
}

// Lines share a program, whose uniforms are set only where they change: also between viewports.
TEST_F(TrajectoryTest, LinesOfDifferentLooksAndViewportsKeepTheirOwn) {
  Look({});
  std::vector<ObjectId> ids;
  for (int i = 0; i < 4; ++i) {
    TrajectoryLook look;
    look.color = {i % 2 == 0 ? 1.0 : 0.0, i < 2 ? 1.0 : 0.0, 1.0};
    look.before = i == 3 ? 20.0 : look.before;
    const auto line = std::make_shared<TrajectoryLine>(
        "line", std::vector<Strip>{Vertical({10.0, 2.0 - 1.3 * i, 0.0}, 4.0, 41)});
    line->SetLook("line", look);
    ids.push_back(Add(line, 3.0));
  }
  CaptureRequest request;
  request.label = true;
  const auto alone = [&](int width) { return View(width, Size)->GetCapture(request); };
  const Capture wide = alone(Size);
  const Capture narrow = alone(Size / 2);
  for (int i = 0; i < 4; ++i) {
    const int x = int(std::lround(Column({10.0, 2.0 - 1.3 * i, 0.0})));
    const std::size_t at = std::size_t(100 * Size + x);
    EXPECT_EQ(wide.label[at], ids[std::size_t(i)]);
    EXPECT_EQ(wide.color[4 * at], i % 2 == 0 ? 255 : 0) << i;
    EXPECT_EQ(wide.color[4 * at + 1], i < 2 ? 255 : 0) << i;
  }
  const std::size_t late = std::size_t(170 * Size) + std::size_t(Column({10.0, -1.9, 0.0}) + 0.5);
  EXPECT_EQ(wide.label[late], 0u); // before the window
  auto first = View(Size, Size);
  auto second = View(Size / 2, Size);
  for (int turn = 0; turn < 3; ++turn) {
    EXPECT_EQ(first->GetCapture(request).color, wide.color) << turn;
    const Capture again = second->GetCapture(request);
    EXPECT_EQ(again.color, narrow.color) << turn;
    EXPECT_EQ(again.label, narrow.label) << turn;
  }
}

} // namespace
} // namespace dspace
