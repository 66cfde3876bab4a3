// A simulation's own window with two viewports of one scene in it, and the simulation's own loop.
//   qt_embed chassis.gltf [SECONDS]: quits after that time; without it, when the window is closed
#include <iostream>

#include <QApplication>
#include <QMainWindow>
#include <QSplitter>
#include <QTimer>

#include <dspace/import/files/ModelReader.h>
#include <dspace/scene/Scene.h>
#include <dspace/widgets/viewport/QtContext.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <vtkDspaceRenderContext.h>
#include <vtkDspaceViewport.h>
#include <vtkNew.h>

int main(int argc, char** argv) {
  dspace::widgets::PrepareApplication(); // before the QApplication
  QApplication application(argc, argv);
  const auto scene = std::make_shared<dspace::Scene>("scene");
  dspace::GraphicsObject body;
  body.name = "body";
  body.frame = scene->Frames().Create(dspace::RootFrame, "body");
  const auto model = std::make_shared<const dspace::Model>(dspace::ReadModel(argv[1]));
  body.levels = {dspace::DetailLevel{dspace::PartsOf(model)}};
  const dspace::FrameId frame = body.frame;
  scene->AddObject(std::move(body));
  dspace::Light sun;
  sun.name = "sun";
  sun.direction = Eigen::Vector3d(-0.4, 0.5, -0.8).normalized();
  scene->SetLight(sun);
  scene->CreateVantage("main");

  vtkNew<vtkDspaceRenderContext> context; // one for all viewports
  context->Initialize(dspace::widgets::MakeQtContext());
  QMainWindow window;
  auto* splitter = new QSplitter(&window);
  vtkNew<vtkDspaceViewport> viewports[2];
  const Eigen::Vector3d eyes[2] = {{3, -3, 2}, {0.1, 0, 5}};
  for (int i = 0; i < 2; ++i) {
    dspace::Camera camera;
    camera.name = i == 0 ? "side" : "top";
    camera.mount.X_FC = dspace::LookAt(camera.name, eyes[i], {0, 0, 0}, {0, 0, 1});
    scene->SetCamera("main", camera);
    viewports[i]->Initialize(context, scene, camera.name, "main", 480, 360);
    viewports[i]->SetCamera(camera.name);
    splitter->addWidget(new dspace::widgets::ViewportWidget(viewports[i], splitter));
  }
  window.setCentralWidget(splitter);
  window.resize(960, 360);
  window.show();

  QTimer loop; // of the simulation
  int steps = 0;
  QObject::connect(&loop, &QTimer::timeout, [&] {
    dspace::Pose pose;
    pose.rotation = Eigen::AngleAxisd(0.02 * ++steps, Eigen::Vector3d::UnitZ());
    scene->Frames().SetLocalPose(frame, pose);
  });
  loop.start(10);
  if (argc > 2) {
    QTimer::singleShot(int(1000 * std::atof(argv[2])), &application, &QApplication::quit);
  }
  const int code = QApplication::exec();
  int shown = 0;
  for (auto* widget : window.findChildren<dspace::widgets::ViewportWidget*>()) {
    shown += widget->ShownPictures();
  }
  std::cout << steps << " steps, " << shown << " pictures\n";
  return code;
}
