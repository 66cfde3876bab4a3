// On screens of 1, 1.5 and 2 device pixels a pixel, a widget shows the picture that the core draws
// at the device's size, byte for byte. Each factor runs in a process of its own: Qt reads it once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include <unistd.h>

#include <QPainter>
#include <QProcess>
#include <QtTest>

#include "OneApplication.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"
#include "vtkNew.h"

#include <dspace/scene/Primitives.h>
#include <dspace/scene/Scene.h>
#include <dspace/widgets/viewport/QtContext.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

using dspace::widgets::PicturePath;
using dspace::widgets::ViewportWidget;

namespace {

const char* const FactorWord = "DSPACE_TEST_SCALE_FACTOR";

std::shared_ptr<dspace::Scene> MakeScene() {
  auto scene = std::make_shared<dspace::Scene>("scene");
  dspace::GraphicsObject object;
  object.name = "box";
  object.frame = dspace::RootFrame;
  auto red = std::make_shared<dspace::Material>();
  red->color = {0.8, 0.2, 0.1};
  object.levels = {dspace::DetailLevel{
      {dspace::Part{std::make_shared<const dspace::Mesh>(dspace::MakeBox({1.0, 2.0, 1.5})), red}}}};
  scene->AddObject(std::move(object));
  dspace::Light sun;
  sun.name = "sun";
  sun.direction = Eigen::Vector3d(-0.5, 0.3, -0.8).normalized();
  scene->SetLight(sun);
  scene->CreateVantage("main");
  dspace::Camera camera;
  camera.name = "front";
  camera.mount.X_FC = dspace::LookAt("front", {6, 1, 2}, {0, 0, 0}, {0, 0, 1});
  scene->SetCamera("main", camera);
  return scene;
}

void MakeView(vtkDspaceViewport* viewport, vtkDspaceRenderContext* context,
              const std::shared_ptr<dspace::Scene>& scene, const char* name, int width,
              int height) {
  viewport->Initialize(context, scene, name, "main", width, height);
  viewport->SetCamera("front");
  viewport->SetBackground({0.1, 0.2, 0.3}, {0.5, 0.6, 0.7});
}

} // namespace

TEST(HighDpi, EveryFactorShowsTheCoresPicture) {
  for (const char* factor : {"1", "1.5", "2"}) {
    QProcess child;
    auto environment = QProcessEnvironment::systemEnvironment();
    environment.insert("QT_SCALE_FACTOR", factor);
    environment.insert(FactorWord, factor);
    child.setProcessEnvironment(environment);
    child.setProcessChannelMode(QProcess::MergedChannels);
    child.start(QCoreApplication::applicationFilePath(), {"--gtest_filter=HighDpi.OfThisProcess"});
    ASSERT_TRUE(child.waitForFinished(120000)) << factor;
    const QString said = QString::fromUtf8(child.readAll());
    EXPECT_EQ(child.exitCode(), 0) << factor << ": " << said.toStdString();
    EXPECT_TRUE(said.contains("[  PASSED  ] 1 test")) << said.toStdString(); // and not skipped
  }
}

TEST(HighDpi, OfThisProcess) {
  const char* given = std::getenv(FactorWord);
  if (!given) {
    GTEST_SKIP() << "HighDpi.EveryFactorShowsTheCoresPicture starts it with each factor";
  }
  const double factor = std::atof(given);
  for (const bool shared : {true, false}) {
    vtkNew<vtkDspaceRenderContext> context;
    context->Initialize(shared ? dspace::widgets::MakeQtContext() : nullptr);
    const auto scene = MakeScene();
    vtkNew<vtkDspaceViewport> viewport;
    MakeView(viewport, context, scene, "shown", 320, 240);
    ViewportWidget widget(viewport, nullptr, shared ? PicturePath::Texture : PicturePath::Memory);
    widget.resize(300, 202);
    widget.show();
    ASSERT_TRUE(QTest::qWaitFor(
        [&] { return widget.ShownPictures() > 0 && !viewport->IsOutdated(); }, 20000));
    EXPECT_DOUBLE_EQ(widget.devicePixelRatioF(), factor);
    // The window manager may have changed the size by a pixel.
    EXPECT_NEAR(widget.height(), 202, 1);
    const int width = int(std::lround(widget.width() * factor));
    const int height = int(std::lround(widget.height() * factor));
    EXPECT_EQ(viewport->GetWidth(), width);
    EXPECT_EQ(viewport->GetHeight(), height);
    const QImage grabbed = widget.grab().toImage().convertToFormat(QImage::Format_RGBX8888);
    ASSERT_EQ(grabbed.size(), QSize(width, height));
    // Another viewport, which no widget has, draws the same scene at that size.
    vtkNew<vtkDspaceViewport> plain;
    MakeView(plain, context, scene, "plain", width, height);
    const auto wanted = plain->GetPicture();
    int differing = 0;
    int lit = 0;
    for (int y = 0; y < height; ++y) {
      const std::uint8_t* row = grabbed.constScanLine(y);
      for (int x = 0; x < width; ++x) {
        const std::uint8_t* pixel = &wanted[4 * (std::size_t(y) * width + x)];
        differing += std::equal(pixel, pixel + 3, row + 4 * x) ? 0 : 1;
        lit += pixel[0] > pixel[2] + 40 ? 1 : 0; // the red box
      }
    }
    EXPECT_EQ(differing, 0) << factor << (shared ? " shared" : " copied");
    EXPECT_GT(lit, width * height / 50);
  }
}
