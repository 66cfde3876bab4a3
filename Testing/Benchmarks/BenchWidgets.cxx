// Four viewports in one window against the same four drawn by the core alone; what is uploaded; the
// time from a key to its picture; an idle window. Needs a display; without one it starts itself on
// one of its own.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>

#include <QApplication>
#include <QGridLayout>
#include <QTest>
#include <QTimer>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <dspace/scene/Primitives.h>
#include <dspace/scene/Scene.h>
#include <dspace/widgets/viewport/QtContext.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

#include "Alternate.h"
#include "WithDisplay.h"

using dspace::bench::Median;
using dspace::widgets::ViewportWidget;

namespace {

constexpr int Width = 640;
constexpr int Height = 360;
constexpr int Frames = 60;

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double ProcessorTime() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

// A hundred balls of a thousand triangles.
std::shared_ptr<dspace::Scene> MakeScene() {
  auto scene = std::make_shared<dspace::Scene>("scene");
  const auto mesh = std::make_shared<const dspace::Mesh>(dspace::MakeSphere(0.4, 24));
  for (int i = 0; i < 100; ++i) {
    dspace::GraphicsObject ball;
    ball.name = "ball " + std::to_string(i);
    dspace::Pose pose;
    pose.position = {double(i % 10) - 4.5, double(i / 10) - 4.5, 0.0};
    ball.frame = scene->Frames().Create(dspace::RootFrame, ball.name, pose);
    auto material = std::make_shared<dspace::Material>();
    material->color = {0.3 + 0.05 * (i % 10), 0.5, 0.8 - 0.05 * (i / 10)};
    ball.levels = {dspace::DetailLevel{{dspace::Part{mesh, material}}}};
    scene->AddObject(std::move(ball));
  }
  dspace::Light sun;
  sun.name = "sun";
  sun.direction = Eigen::Vector3d(-0.4, 0.5, -0.8).normalized();
  scene->SetLight(sun);
  scene->CreateVantage("main");
  return scene;
}

void Look(dspace::Scene& scene, const std::string& name, double angle) {
  dspace::Camera camera;
  camera.name = name;
  camera.mount.X_FC = dspace::LookAt(name, {9.0 * std::cos(angle), 9.0 * std::sin(angle), 5.0},
                                     {0, 0, 0}, {0, 0, 1});
  scene.SetCamera("main", camera);
}

// The pictures are there: a software renderer draws after the call otherwise.
void Finish(vtkDspaceViewport& viewport) {
  viewport.GetPicture();
}

int Measure() {
  vtkNew<vtkDspaceRenderContext> context;
  context->Initialize(dspace::widgets::MakeQtContext());
  const auto scene = MakeScene();
  QWidget window;
  QGridLayout layout(&window);
  layout.setContentsMargins(0, 0, 0, 0);
  std::vector<vtkSmartPointer<vtkDspaceViewport>> alone;
  std::vector<ViewportWidget*> widgets;
  for (int i = 0; i < 4; ++i) {
    const std::string name = "camera " + std::to_string(i);
    Look(*scene, name, 1.5 * i);
    for (const bool shown : {false, true}) {
      auto viewport = vtkSmartPointer<vtkDspaceViewport>::New();
      viewport->Initialize(context, scene, name + (shown ? " shown" : " alone"), "main", Width,
                           Height, 1);
      viewport->SetCamera(name);
      if (shown) {
        widgets.push_back(new ViewportWidget(viewport, &window));
        widgets.back()->setFixedSize(Width, Height);
        layout.addWidget(widgets.back(), i / 2, i % 2);
      } else {
        alone.push_back(viewport);
      }
    }
  }
  window.show();
  if (!QTest::qWaitForWindowExposed(&window, 10000)) {
    std::printf("widgets: the window is not shown\n");
    return 1;
  }
  QTest::qWait(300);
  std::vector<double> core;
  std::vector<double> shown;
  std::uint64_t uploaded = 0;
  for (int frame = 0; frame < Frames; ++frame) {
    for (int i = 0; i < 4; ++i) {
      Look(*scene, "camera " + std::to_string(i), 1.5 * i + 0.02 * frame);
    }
    double start = Now();
    for (const auto& viewport : alone) {
      viewport->Render();
    }
    for (const auto& viewport : alone) {
      Finish(*viewport);
    }
    core.push_back(Now() - start);
    const std::uint64_t before = context->GetStatistics().meshBytesUploaded;
    start = Now();
    for (ViewportWidget* widget : widgets) {
      widget->Refresh();
    }
    QCoreApplication::processEvents();
    for (ViewportWidget* widget : widgets) {
      Finish(*widget->GetViewport());
    }
    shown.push_back(Now() - start);
    uploaded += context->GetStatistics().meshBytesUploaded - before;
  }
  const double ofCore = Median(core);
  const double ofWidgets = Median(shown);
  std::printf("widgets: four views of %d x %d in a window %.1f ms, by the core alone %.1f ms: %.2f "
              "(goal <= 1.1); "
              "%llu B of meshes uploaded (goal 0)\n",
              Width, Height, 1e3 * ofWidgets, 1e3 * ofCore, ofWidgets / ofCore,
              static_cast<unsigned long long>(uploaded));

  // A key turns the camera; the picture is shown.
  std::vector<double> latency;
  for (int i = 0; i < 20; ++i) {
    const int before = widgets[0]->ShownPictures();
    const double start = Now();
    QTest::keyClick(widgets[0], Qt::Key_Left);
    while (widgets[0]->ShownPictures() == before && Now() - start < 1.0) {
      QCoreApplication::processEvents();
    }
    latency.push_back(Now() - start);
    QTest::qWait(30);
  }
  std::printf("widgets: a key to its picture %.1f ms (goal < 50)\n", 1e3 * Median(latency));

  QTest::qWait(1000); // all at rest
  const double used = ProcessorTime();
  const double began = Now();
  QEventLoop loop;
  QTimer::singleShot(5000, &loop, &QEventLoop::quit);
  loop.exec();
  std::printf("widgets: an idle window takes %.2f %% of a core (goal < 1)\n",
              100.0 * (ProcessorTime() - used) / (Now() - began));
  return 0;
}

} // namespace

int main(int count, char** arguments) {
  dspace::bench::NeedDisplay(arguments[0]);
  dspace::widgets::PrepareApplication();
  QApplication application(count, arguments);
  return Measure();
}
