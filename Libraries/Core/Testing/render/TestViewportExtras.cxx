// What a viewport adds to its scene: axes in the corner, text tables, props of VTK code.
#include "RenderingTestSupport.h"

#include <atomic>
#include <future>
#include <set>
#include <thread>

#include "vtkActor.h"
#include "vtkCellArray.h"
#include "vtkFloatArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

#include <dspace/overlay/Overlay.h>
#include <dspace/render/text/OverlayText.h>

using namespace dspace;

namespace {

struct ViewportExtrasTest : RenderingFixture {
  // Pixels that differ between two pictures of one size.
  static Extent Changed(const Capture& a, const Capture& b) {
    Capture difference = a;
    difference.label.assign(static_cast<std::size_t>(a.width) * a.height, 0);
    for (std::size_t i = 0; i < difference.label.size(); ++i) {
      difference.label[i] =
          std::equal(&a.color[4 * i], &a.color[4 * i] + 4, &b.color[4 * i]) ? 0 : 1;
    }
    return ExtentOf(difference, 1);
  }
};

// A square of two metres at `centre` that faces the camera, as VTK code would add it.
vtkSmartPointer<vtkActor> SquareActor(const Eigen::Vector3d& centre) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkFloatArray> normals;
  normals->SetNumberOfComponents(3);
  for (const auto& corner :
       {std::pair(1, -1), std::pair(-1, -1), std::pair(-1, 1), std::pair(1, 1)}) {
    points->InsertNextPoint(centre.x(), centre.y() + corner.first, centre.z() + corner.second);
    normals->InsertNextTuple3(-1, 0, 0);
  }
  vtkNew<vtkCellArray> polys;
  polys->InsertNextCell({0, 1, 2, 3});
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(polys);
  data->GetPointData()->SetNormals(normals);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  return actor;
}

} // namespace

TEST_F(ViewportExtrasTest, TheCornerShowsTheRootsAxesAndNothingElseChanges) {
  Look({});
  const FrameId frame = scene->Frames().Create(RootFrame, "f", At(10, 0, 0));
  scene->AddObject(Object("glass", frame, PlaneTowardsCamera(30, 30), Unlit({1, 1, 1}, 0.5)));
  scene->AddObject(Object("ball", frame, MakeSphere(2), Unlit({1, 1, 1})));
  auto viewport = View(360, 300, 2);
  const Capture without = viewport->GetCapture({});
  const RenderStatistics before = context->GetStatistics();
  viewport->SetCornerAxes(true);
  const Capture with = viewport->GetCapture({});
  const RenderStatistics after = context->GetStatistics();
  EXPECT_EQ(after.framesDrawn, before.framesDrawn + 1);
  EXPECT_EQ(after.trianglesDrawn, before.trianglesDrawn);
  EXPECT_EQ(after.drawCalls, before.drawCalls);
  EXPECT_EQ(after.translucentLayers, before.translucentLayers);
  EXPECT_GT(before.translucentLayers, 0);

  // A corner of 50 pixels that spans 2.6 m about (24.5, 274.5): arrows of a metre have 19.2 px. The
  // camera looks along X with Z up: Y (green) points left and Z (blue) up; X points away.
  const Extent changed = Changed(without, with);
  EXPECT_NEAR(changed.left, 24.5 - 19.2, 1.5);
  EXPECT_NEAR(changed.top, 274.5 - 19.2, 1.5);
  EXPECT_LT(changed.right, 32);
  EXPECT_LT(changed.bottom, 300 - 18);
  const auto pixel = [&](int x, int y) { return &with.color[4 * (y * 360 + x)]; };
  EXPECT_GT(pixel(13, 274)[1], pixel(13, 274)[0] + 40);
  EXPECT_GT(pixel(13, 274)[1], pixel(13, 274)[2] + 40);
  EXPECT_GT(pixel(24, 263)[2], pixel(24, 263)[0] + 40);
  EXPECT_GT(pixel(24, 263)[2], pixel(24, 263)[1] + 40);

  CaptureRequest physical;
  physical.physicalOnly = true;
  EXPECT_EQ(viewport->GetCapture(physical).color, without.color);
  EXPECT_EQ(viewport->GetCapture({}).color, with.color); // the request was for one picture
  viewport->SetOrnamentsVisible(false);
  EXPECT_EQ(viewport->GetCapture({}).color, without.color);
  viewport->SetOrnamentsVisible(true);
  viewport->SetCornerAxes(false);
  EXPECT_EQ(viewport->GetCapture({}).color, without.color);
}

// Each colour is drawn by itself: in the text's own colour what comes is what came in one.
TEST_F(ViewportExtrasTest, ColouredValuesStandWhereTheyStoodBefore) {
  Look({});
  TextTable plain;
  plain.name = "t";
  plain.title = "Power";
  plain.rows = {{"bus", "28.1 V"}, {"j\u00f6g", "-3.25 A"}, {"", "gy"}, {"heat", ""}, {"q", "7"}};
  plain.fontSize = 17;
  plain.textColor = {0.9, 0.8, 1, 0.8};
  for (int anchor = 0; anchor < 4; ++anchor) {
    plain.anchor = TextTable::Anchor(anchor);
    TextTable colored = plain;
    auto viewport = View(300, 200, 1);
    viewport->SetTextTable(plain);
    const Capture before = viewport->GetCapture({});
    for (const std::set<std::size_t>& rows :
         {std::set<std::size_t>{0}, {1, 3}, {4}, {0, 1, 2, 3, 4}}) {
      colored.valueColors.clear();
      for (const std::size_t row : rows) {
        colored.valueColors[row] = {0.9, 0.8, 1};
      }
      viewport->SetTextTable(colored);
      const Capture after = viewport->GetCapture({});
      int most = 0;
      for (std::size_t i = 0; i < before.color.size(); ++i) {
        most = std::max(most, std::abs(before.color[i] - after.color[i]));
      }
      EXPECT_LE(most, 4) << "anchor " << anchor; // letters and background are mixed apart
    }
  }
}

TEST_F(ViewportExtrasTest, ValuesHaveColoursOfTheirOwn) {
  Look({});
  TextTable table;
  table.name = "t";
  table.rows = {{"aaa", "MMM"}, {"aaa", "MMM"}, {"aaa", "MMM"}};
  table.fontSize = 30;
  auto viewport = View(300, 200, 1);
  viewport->SetTextTable(table);
  const Capture plain = viewport->GetCapture({});
  table.valueColors = {{0, {1, 0, 0}}, {2, {0, 0, 1}}};
  viewport->SetTextTable(table);
  const Capture colored = viewport->GetCapture({});
  // Full ink by its colour, with its extent.
  const auto inked = [](const Capture& of, const std::array<int, 3>& color) {
    Capture ink = of;
    ink.label.assign(std::size_t(of.width) * of.height, 0);
    for (std::size_t i = 0; i < ink.label.size(); ++i) {
      ink.label[i] = std::equal(color.begin(), color.end(), &of.color[4 * i]);
    }
    return ExtentOf(ink, 1);
  };
  const Extent all = inked(plain, {255, 255, 255});
  const Extent red = inked(colored, {255, 0, 0});
  const Extent blue = inked(colored, {0, 0, 255});
  const Extent white = inked(colored, {255, 255, 255});
  const double line = (all.bottom - all.top) / 3.0;
  EXPECT_EQ(red.right, all.right);
  EXPECT_EQ(red.top, all.top);
  EXPECT_EQ(red.right - red.left, blue.right - blue.left);
  EXPECT_LT(red.bottom - red.top, line);
  EXPECT_GT(blue.top - red.top, 1.8 * line);
  EXPECT_EQ(blue.bottom, all.bottom);
  EXPECT_EQ(white.left, all.left); // the labels, and the second value
  EXPECT_EQ(white.right, all.right);
  EXPECT_GT(red.left, all.left + 3 * 0.6 * 30);

  for (const auto& [wrong, part] :
       {std::pair(std::map<std::size_t, std::array<double, 3>>{{3, {1, 0, 0}}}, "value of row 3"),
        {{{0, {1, 2, 0}}}, "colour of a value"}}) {
    table.valueColors = wrong;
    try {
      viewport->SetTextTable(table);
      FAIL() << part;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(viewport->GetCapture({}).color, colored.color);
}

// VTK has one text renderer for all threads.
TEST_F(ViewportExtrasTest, TablesAndBarsWaitForTheTextRenderer) {
  Look({});
  auto viewport = View(300, 200, 1);
  TextTable table;
  table.name = "t";
  table.rows = {{"a", "1"}};
  viewport->SetTextTable(table);
  ColorBar bar;
  bar.name = "b";
  bar.colors = {{0, 0, 0}, {1, 1, 1}};
  viewport->GetCapture({}); // the first takes longer
  for (int i = 0; i < 2; ++i) {
    std::promise<void> held;
    std::atomic<bool> free{false};
    std::thread other([&] {
      const auto lock = LockTextRenderer();
      held.set_value();
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      free = true;
    });
    held.get_future().wait();
    if (i == 0) {
      table.rows[0].second = "2";
      viewport->SetTextTable(table);
    } else {
      viewport->SetColorBar(bar);
    }
    viewport->GetCapture({});
    EXPECT_TRUE(free) << i;
    other.join();
  }
}

TEST_F(ViewportExtrasTest, NothingHidesTheCornersAxes) {
  Look({});
  const FrameId frame = scene->Frames().Create(RootFrame, "f", At(0.06, 0, 0)); // near is at 0.05
  scene->AddObject(Object("wall", frame, PlaneTowardsCamera(1, 1), Unlit({0, 0, 0})));
  auto viewport = View(300, 300, 2);
  const Capture wall = viewport->GetCapture({});
  viewport->SetCornerAxes(true);
  const Extent axes = Changed(wall, viewport->GetCapture({}));
  EXPECT_NEAR(axes.left, 24.5 - 19.2, 1.5);
  EXPECT_NEAR(axes.top, 274.5 - 19.2, 1.5);
}

TEST_F(ViewportExtrasTest, TablesStandInTheirCornersAlsoAfterAResize) {
  Look({});
  auto viewport = View(400, 300);
  auto bare = View(400, 300);
  TextTable table;
  table.name = "table";
  table.rows = {{"height", "1.5 m"}, {"speed", "2 m/s"}};
  table.backgroundColor = {1, 0, 0, 1};
  using Anchor = TextTable::Anchor;
  for (const auto& size : {std::pair(400, 300), std::pair(300, 420)}) {
    for (const Anchor anchor :
         {Anchor::TopLeft, Anchor::TopRight, Anchor::BottomLeft, Anchor::BottomRight}) {
      table.anchor = anchor;
      viewport->Resize(400, 300);
      viewport->SetTextTable(table);
      viewport->GetCapture({});
      viewport->Resize(size.first, size.second);
      bare->Resize(size.first, size.second);
      const Extent changed = Changed(viewport->GetCapture({}), bare->GetCapture({}));
      ASSERT_GT(changed.right, 0);
      const bool left = anchor == Anchor::TopLeft || anchor == Anchor::BottomLeft;
      const bool top = anchor == Anchor::TopLeft || anchor == Anchor::TopRight;
      // The margin is 8 pixels; text and its ground end within a few of it.
      EXPECT_NEAR(left ? changed.left : size.first - 1 - changed.right, 8, 4);
      EXPECT_NEAR(top ? changed.top : size.second - 1 - changed.bottom, 8, 4);
      EXPECT_LT(changed.right - changed.left, 220);
      EXPECT_LT(changed.bottom - changed.top, 60);
    }
  }
  viewport->SetTextTable(table); // the same one: nothing to draw
  EXPECT_FALSE(viewport->Render());
  table.rows[0].second = "1.6 m";
  viewport->SetTextTable(table);
  EXPECT_TRUE(viewport->Render());
  CaptureRequest physical; // overlays are ornaments
  physical.physicalOnly = true;
  EXPECT_EQ(viewport->GetCapture(physical).color, bare->GetCapture({}).color);
  EXPECT_NE(viewport->GetCapture({}).color, bare->GetCapture({}).color);
  viewport->RemoveTextTable("table");
  EXPECT_EQ(viewport->GetCapture({}).color, bare->GetCapture({}).color);
  EXPECT_THROW(viewport->RemoveTextTable("table"), Error);
}

TEST_F(ViewportExtrasTest, PropsOfVtkCodeStandInTheSceneUnderItsLights) {
  Projection projection;
  projection.verticalFov_deg = 2.0 * std::atan(0.5) * 180.0 / M_PI; // 100 px a metre at one metre
  const FrameId eye = scene->Frames().Create(RootFrame, "eye", At(-3, 1, 2));
  Look(projection, eye);
  // Ours hides the actor's right half: both share one depth.
  scene->AddObject(Object("front", scene->Frames().Create(RootFrame, "front", At(5, 0, 3)),
                          PlaneTowardsCamera(2, 6), Unlit({0, 0, 1})));
  Light sun;
  sun.name = "sun";
  sun.intensity = 0.5;
  const double angle = M_PI / 3;
  sun.direction = {std::cos(angle), 0, -std::sin(angle)};
  scene->SetLight(sun);
  auto viewport = View(200, 100);
  const Capture without = viewport->GetCapture({});
  vtkSmartPointer<vtkActor> square = SquareActor({7, 1, 3});
  viewport->GetRenderer()->AddViewProp(square);
  viewport->Invalidate();
  const Capture with = viewport->GetCapture({});
  // Ten metres ahead of the eye, centred 1 m above it: 10 pixels a metre, Y 1 to -1 about the
  // middle, Z 0 to 2. The plane stands 8 m ahead, from Y 0 (of the eye: -1 + 1 = 0) to the right.
  const Extent changed = Changed(without, with);
  EXPECT_EQ(changed.left, 90);
  EXPECT_EQ(changed.right, 99);
  EXPECT_EQ(changed.top, 30);
  EXPECT_EQ(changed.bottom, 49);
  viewport->SetCornerAxes(true); // drawn before the props, elsewhere
  const Capture beside = viewport->GetCapture({});
  EXPECT_TRUE(
      std::equal(with.color.begin(), with.color.begin() + 4 * 200 * 80, beside.color.begin()));
  viewport->SetCornerAxes(false);
  // VTK's light is the scene's: Lambert's law, in display values as VTK has it.
  EXPECT_NEAR(with.color[4 * (40 * 200 + 95)], 255 * 0.5 * std::cos(angle), 2);
  sun.enabled = false;
  scene->SetLight(sun);
  Light head;
  head.name = "head";
  head.kind = Light::Kind::Head;
  head.intensity = 0.3;
  scene->SetLight(head);
  EXPECT_NEAR(viewport->GetCapture({}).color[4 * (40 * 200 + 95)], 255 * 0.3, 2);
  viewport->GetRenderer()->RemoveViewProp(square);
  viewport->Invalidate();
  EXPECT_EQ(viewport->GetCapture({}).color, without.color);
}

TEST_F(ViewportExtrasTest, VtkCodeMayRenderTheWindowItself) {
  Look({});
  scene->AddObject(Object("ball", scene->Frames().Create(RootFrame, "f", At(10, 0, 0)),
                          MakeSphere(2), Unlit({1, 1, 1})));
  auto viewport = View(50, 40);
  const auto render = [](vtkRenderWindow* window) { window->Render(); };
  EXPECT_NO_THROW(viewport->Run(render)); // before there is a picture
  const Capture picture = viewport->GetCapture({});
  EXPECT_NO_THROW(viewport->Run(render));
  EXPECT_TRUE(viewport->IsOutdated());
  EXPECT_EQ(viewport->GetCapture({}).color, picture.color);
}
