// A widget shows its viewport's picture byte for byte, follows its size, and turns the user's
// events into the camera's movements.
#include <gtest/gtest.h>

#include <memory>

#include <QDockWidget>
#include <QElapsedTimer>
#include <QMainWindow>
#include <QtTest>

#include "OneApplication.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <dspace/render/GpuStore.h>
#include <dspace/scene/Primitives.h>
#include <dspace/scene/Scene.h>
#include <dspace/scene/controls/OrbitController.h>
#include <dspace/widgets/viewport/QtContext.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

using dspace::widgets::PicturePath;
using dspace::widgets::ViewportInput;
using dspace::widgets::ViewportWidget;

namespace {

struct WidgetTest : ::testing::TestWithParam<bool> {
  vtkNew<vtkDspaceRenderContext> context;
  std::shared_ptr<dspace::Scene> scene = std::make_shared<dspace::Scene>("scene");

  void SetUp() override {
    // Textures of Qt's context, or a copy of pictures of EGL's.
    context->Initialize(GetParam() ? dspace::widgets::MakeQtContext() : nullptr);
    dspace::GraphicsObject object;
    object.name = "box";
    object.frame = dspace::RootFrame;
    auto red = std::make_shared<dspace::Material>();
    red->color = {0.8, 0.2, 0.1};
    object.levels = {dspace::DetailLevel{{dspace::Part{
        std::make_shared<const dspace::Mesh>(dspace::MakeBox({1.0, 2.0, 1.5})), red}}}};
    scene->AddObject(std::move(object));
    dspace::Light sun;
    sun.name = "sun";
    sun.direction = Eigen::Vector3d(-0.5, 0.3, -0.8).normalized();
    scene->SetLight(sun);
    scene->CreateVantage("main");
    for (const char* name : {"front", "side"}) {
      dspace::Camera camera;
      camera.name = name;
      camera.mount.X_FC = dspace::LookAt(
          name, std::string(name) == "front" ? Eigen::Vector3d(6, 1, 2) : Eigen::Vector3d(1, -5, 1),
          {0, 0, 0}, {0, 0, 1});
      scene->SetCamera("main", camera);
    }
  }
  vtkSmartPointer<vtkDspaceViewport> View(const std::string& name, int width = 320,
                                          int height = 240) {
    auto viewport = vtkSmartPointer<vtkDspaceViewport>::New();
    viewport->Initialize(context, scene, name, "main", width, height);
    viewport->SetCamera(name);
    viewport->SetBackground({0.1, 0.2, 0.3}, {0.5, 0.6, 0.7});
    return viewport;
  }
  static PicturePath Path() { return GetParam() ? PicturePath::Texture : PicturePath::Memory; }
  // Until the widget shows an up-to-date picture; false: it does not within 10 s.
  static bool Wait(ViewportWidget& widget, int pictures = 1) {
    return QTest::qWaitFor(
        [&] { return widget.ShownPictures() >= pictures && !widget.GetViewport()->IsOutdated(); },
        10000);
  }
  // The pixels that differ from the core's picture of the same size.
  static int Differing(ViewportWidget& widget) {
    const QImage grabbed = widget.grab().toImage().convertToFormat(QImage::Format_RGBX8888);
    const std::vector<std::uint8_t> wanted = widget.GetViewport()->GetPicture();
    if (grabbed.width() != widget.GetViewport()->GetWidth() ||
        grabbed.height() != widget.GetViewport()->GetHeight()) {
      return -1;
    }
    int differing = 0;
    for (int y = 0; y < grabbed.height(); ++y) {
      const std::uint8_t* row = grabbed.constScanLine(y);
      for (int x = 0; x < grabbed.width(); ++x) {
        const std::uint8_t* pixel = &wanted[4 * (std::size_t(y) * grabbed.width() + x)];
        differing += std::equal(pixel, pixel + 3, row + 4 * x) ? 0 : 1;
      }
    }
    return differing;
  }
};

} // namespace

INSTANTIATE_TEST_SUITE_P(Paths, WidgetTest, ::testing::Values(true, false),
                         [](const auto& info) { return info.param ? "Shared" : "Copied"; });

TEST_P(WidgetTest, ShowsTheCoresPictureByteForByte) {
  const auto viewport = View("front");
  ViewportWidget widget(viewport, nullptr, Path());
  EXPECT_EQ(widget.SharesTextures(), GetParam());
  widget.resize(411, 273);
  widget.show();
  QObject::connect(&widget, &ViewportWidget::failed, [](const QString& message) {
    std::cerr << "failed: " << message.toStdString() << "\n";
  });
  ASSERT_TRUE(Wait(widget));
  EXPECT_EQ(viewport->GetWidth(), 411);
  EXPECT_EQ(viewport->GetHeight(), 273);
  EXPECT_EQ(Differing(widget), 0);
  // It follows the scene by itself.
  const int before = widget.ShownPictures();
  dspace::Camera camera = scene->Vantage("main").GetCamera("front");
  camera.mount.X_FC = dspace::LookAt("front", {4, 3, 1}, {0, 0, 0}, {0, 0, 1});
  scene->SetCamera("main", camera);
  ASSERT_TRUE(Wait(widget, before + 1));
  EXPECT_EQ(Differing(widget), 0);
  // A still scene is not drawn again.
  const int still = widget.ShownPictures();
  QTest::qWait(200);
  EXPECT_EQ(widget.ShownPictures(), still);
}

TEST_P(WidgetTest, TakesTheFasterPath) {
  const auto viewport = View("front");
  const ViewportWidget widget(viewport);
  const std::string renderer = context->GetRendererName();
  const bool software = renderer.find("llvmpipe") != std::string::npos;
  EXPECT_EQ(widget.SharesTextures(), GetParam() && !software) << renderer;
}

TEST_P(WidgetTest, DragsAndTheWheelMoveTheCamera) {
  const auto viewport = View("front");
  ViewportWidget widget(viewport, nullptr, Path());
  widget.resize(320, 240);
  widget.show();
  ASSERT_TRUE(Wait(widget));
  const auto pose = [&] { return scene->PlaceCamera("main", "front").X_FC.position; };
  const Eigen::Vector3d start = pose();
  QTest::mousePress(&widget, Qt::LeftButton, {}, {160, 120});
  QTest::mouseMove(&widget, {180, 125});
  QTest::mouseMove(&widget, {220, 130});
  QTest::mouseRelease(&widget, Qt::LeftButton, {}, {220, 130});
  const Eigen::Vector3d orbited = pose();
  EXPECT_GT((orbited - start).norm(), 0.3);
  EXPECT_EQ(viewport->GetSamples(), 1); // while it moves
  QWheelEvent wheel(QPointF(160, 120), widget.mapToGlobal(QPointF(160, 120)), QPoint(),
                    QPoint(0, 240), Qt::NoButton, Qt::NoModifier, Qt::NoScrollPhase, false);
  QApplication::sendEvent(&widget, &wheel);
  EXPECT_LT(pose().norm(), orbited.norm() - 0.3);
  const Eigen::Vector3d nearer = pose();
  QTest::keyClick(&widget, Qt::Key_Left);
  EXPECT_GT((pose() - nearer).norm(), 0.1);
  ASSERT_TRUE(QTest::qWaitFor([&] { return viewport->GetSamples() == 2; }, 3000));
  ASSERT_TRUE(Wait(widget));
  EXPECT_EQ(Differing(widget), 0);
}

// Two fingers on a touchpad: a pinch to twice the distance brings the camera twice as near, and a
// scroll without angles is a wheel's.
TEST_P(WidgetTest, ATouchpadMovesTheCamera) {
  const auto viewport = View("front");
  ViewportWidget widget(viewport, nullptr, Path());
  widget.resize(320, 240);
  widget.show();
  ASSERT_TRUE(Wait(widget));
  const dspace::PickResult pick = viewport->Pick(160, 120);
  ASSERT_NE(pick.object, 0u);
  const Eigen::Vector3d point = pick.p_root;
  const auto distance = [&] {
    return (scene->PlaceCamera("main", "front").X_FC.position - point).norm();
  };
  const double before = distance();
  const QPointF place(160.5, 120.5); // the pixel's centre
  QNativeGestureEvent pinch(Qt::ZoomNativeGesture, QPointingDevice::primaryPointingDevice(), 2,
                            place, place, widget.mapToGlobal(place), 1.0, QPointF());
  QApplication::sendEvent(&widget, &pinch);
  EXPECT_NEAR(distance(), 0.5 * before, 1e-3 * before);
  QNativeGestureEvent turn(Qt::RotateNativeGesture, QPointingDevice::primaryPointingDevice(), 2,
                           place, place, widget.mapToGlobal(place), 1.0, QPointF());
  QApplication::sendEvent(&widget, &turn);
  EXPECT_NEAR(distance(), 0.5 * before, 1e-3 * before);
  QWheelEvent scroll(place, widget.mapToGlobal(place), QPoint(0, -60), QPoint(), Qt::NoButton,
                     Qt::NoModifier, Qt::ScrollUpdate, false);
  QApplication::sendEvent(&widget, &scroll);
  EXPECT_NEAR(distance(), 0.5 * before * dspace::OrbitController::StepFactor, 2e-3 * before);
}

TEST_P(WidgetTest, AHandlerTakesTheEventsInPixels) {
  const auto viewport = View("front");
  ViewportWidget widget(viewport, nullptr, Path());
  std::vector<ViewportInput> inputs;
  widget.SetHandler([&](const ViewportInput& input) { inputs.push_back(input); });
  widget.resize(320, 240);
  widget.show();
  ASSERT_TRUE(Wait(widget));
  QTest::mousePress(&widget, Qt::RightButton, Qt::ShiftModifier, {10, 20});
  QTest::mouseRelease(&widget, Qt::RightButton, Qt::ShiftModifier, {10, 20});
  QTest::keyClick(&widget, Qt::Key_A);
  QTest::keyClick(&widget, Qt::Key_F5);
  QTest::keyClick(&widget, Qt::Key_Space);
  ASSERT_EQ(inputs.size(), 5u);
  EXPECT_EQ(inputs[0].type, ViewportInput::Type::Press);
  EXPECT_EQ(inputs[0].button, ViewportInput::Button::Right);
  EXPECT_TRUE(inputs[0].shift);
  EXPECT_DOUBLE_EQ(inputs[0].x, 9.5); // the middle of pixel (0, 0) is (0, 0)
  EXPECT_DOUBLE_EQ(inputs[0].y, 19.5);
  EXPECT_EQ(inputs[2].key, "a");
  EXPECT_EQ(inputs[3].key, "F5");
  EXPECT_EQ(inputs[4].key, "space");
}

TEST_P(WidgetTest, DocksFloatMoveAndCloseWithOneCopyOfTheMeshes) {
  QMainWindow window;
  window.resize(700, 400);
  const auto front = View("front");
  const auto side = View("side");
  auto* left = new QDockWidget("front", &window);
  auto* frontWidget = new ViewportWidget(front);
  left->setWidget(frontWidget);
  auto* sideWidget = new ViewportWidget(side);
  window.setCentralWidget(sideWidget);
  window.addDockWidget(Qt::LeftDockWidgetArea, left);
  window.show();
  ASSERT_TRUE(Wait(*frontWidget));
  ASSERT_TRUE(Wait(*sideWidget));
  const auto& statistics = context->GetStatistics();
  const std::uint64_t meshes = statistics.meshBytes;
  const std::uint64_t uploaded = statistics.meshBytesUploaded;
  EXPECT_GT(meshes, 0u);
  for (int i = 0; i < 10; ++i) {
    left->setFloating(i % 2 == 0);
    QTest::qWait(30);
    if (i % 3 == 0) {
      window.resize(700 + 10 * i, 400 - 7 * i);
      left->hide();
      QTest::qWait(10);
      left->show();
    }
    ASSERT_TRUE(Wait(*frontWidget)) << i;
    EXPECT_EQ(Differing(*frontWidget), 0) << i;
    EXPECT_EQ(Differing(*sideWidget), 0) << i;
  }
  EXPECT_EQ(statistics.meshBytes, meshes);
  EXPECT_EQ(statistics.meshBytesUploaded, uploaded);
  delete left; // the other goes on
  dspace::Camera camera = scene->Vantage("main").GetCamera("side");
  camera.mount.X_FC = dspace::LookAt("side", {-2, -4, 3}, {0, 0, 0}, {0, 0, 1});
  const int before = sideWidget->ShownPictures();
  scene->SetCamera("main", camera);
  ASSERT_TRUE(Wait(*sideWidget, before + 1));
  EXPECT_EQ(Differing(*sideWidget), 0);
}

TEST_P(WidgetTest, AFailureIsShownAndToldOnce) {
  const auto viewport = View("front");
  ViewportWidget widget(viewport, nullptr, Path());
  QSignalSpy failures(&widget, &ViewportWidget::failed);
  widget.SetHandler([](const ViewportInput&) { throw std::runtime_error("the hook is stuck"); });
  widget.resize(320, 240);
  widget.show();
  ASSERT_TRUE(Wait(widget));
  QTest::keyClick(&widget, Qt::Key_A);
  QTest::keyClick(&widget, Qt::Key_A);
  ASSERT_GE(failures.count(), 1);
  EXPECT_EQ(failures.at(0).at(0).toString(), "the hook is stuck");
}

TEST_P(WidgetTest, LinesAreAsWideAsTheCores) {
  dspace::Mesh line;
  line.name = "trail";
  line.primitive = dspace::Mesh::Primitive::Lines;
  line.positions = {0.0F, -2.0F, 1.5F, 0.0F, 2.0F, 1.5F};
  line.indices = {0, 1};
  dspace::GraphicsObject object;
  object.name = "trail";
  object.frame = dspace::RootFrame;
  object.lineWidth = 4.0;
  auto green = std::make_shared<dspace::Material>();
  green->color = {0.0, 1.0, 0.0};
  object.material.lit = false;
  object.levels = {dspace::DetailLevel{
      {dspace::Part{std::make_shared<const dspace::Mesh>(std::move(line)), green}}}};
  scene->AddObject(std::move(object));
  const auto viewport = View("front");
  viewport->SetSamples(2);
  ViewportWidget widget(viewport, nullptr, Path());
  QSignalSpy failures(&widget, &ViewportWidget::failed);
  widget.resize(320, 240);
  widget.show();
  ASSERT_TRUE(Wait(widget));
  EXPECT_EQ(failures.count(), 0) << failures.value(0).value(0).toString().toStdString();
  const QImage picture = widget.grab().toImage();
  int most = 0;
  for (int x = 0; x < picture.width(); ++x) {
    int greens = 0;
    for (int y = 0; y < picture.height(); ++y) {
      const QColor color = picture.pixelColor(x, y);
      greens += color.green() > 2 * color.red() && color.green() > 2 * color.blue() ? 1 : 0;
    }
    most = std::max(most, greens);
  }
  EXPECT_GE(most, 3);
  EXPECT_LE(most, 6);
}

TEST_P(WidgetTest, MakesTheViewportsOfASceneItself) {
  auto front = std::make_unique<ViewportWidget>(scene, "front");
  auto side = std::make_unique<ViewportWidget>(scene, "side");
  for (ViewportWidget* widget : {front.get(), side.get()}) {
    widget->resize(320, 240);
    widget->show();
    ASSERT_TRUE(Wait(*widget));
    EXPECT_EQ(Differing(*widget), 0);
  }
  front.reset();
  const int before = side->ShownPictures();
  dspace::Camera camera = scene->Vantage("main").GetCamera("side");
  camera.mount.X_FC = dspace::LookAt("side", {-2, -4, 3}, {0, 0, 0}, {0, 0, 1});
  scene->SetCamera("main", camera);
  ASSERT_TRUE(Wait(*side, before + 1)); // the other goes on
  side.reset();
  const ViewportWidget again(scene, "front"); // in a new context
  EXPECT_THROW(ViewportWidget(scene, "none"), dspace::Error);
}

// Of the sizes that a layout tries, none is drawn, but by a QOpenGLWidget, which draws at each.
TEST_P(WidgetTest, SizesAreSettledBeforeTheFirstPicture) {
  const auto viewport = View("front");
  QWidget window;
  ViewportWidget widget(viewport, &window, Path());
  window.resize(500, 400);
  widget.resize(100, 100);
  window.show();
  for (const int width : {120, 250, 333}) {
    widget.resize(width, 200);
  }
  EXPECT_TRUE(GetParam() || widget.ShownPictures() == 0) << widget.ShownPictures();
  ASSERT_TRUE(Wait(widget));
  EXPECT_EQ(viewport->GetWidth(), 333);
  EXPECT_TRUE(GetParam() || widget.ShownPictures() == 1) << widget.ShownPictures();
  EXPECT_EQ(Differing(widget), 0);
}
