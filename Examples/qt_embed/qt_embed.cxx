// A simulation's own window with two viewports of one scene in it, and the simulation's own loop.
//   qt_embed chassis.gltf [SECONDS]: quits after that time; without it, when the window is closed
#include <iostream>

#include <QApplication>
#include <QMainWindow>
#include <QSplitter>
#include <QTimer>

#include <dspace/scene/staging/Staging.h>
#include <dspace/widgets/viewport/QtContext.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <vtkDspaceRenderContext.h>
#include <vtkDspaceViewport.h>
#include <vtkNew.h>

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: qt_embed MODEL [SECONDS]\n";
    return 2;
  }
  dspace::widgets::PrepareApplication(); // before the QApplication
  QApplication application(argc, argv);
  const auto scene = std::make_shared<dspace::Scene>("scene");
  const dspace::FrameId body = dspace::StageModel(*scene, argv[1], "body");
  dspace::StageSun(*scene, {0.4, -0.5, 0.8});

  vtkNew<vtkDspaceRenderContext> context; // one for all viewports
  context->Initialize(dspace::widgets::MakeQtContext());
  QMainWindow window;
  auto* splitter = new QSplitter(&window);
  vtkNew<vtkDspaceViewport> viewports[2];
  for (int i = 0; i < 2; ++i) {
    const char* const camera = i == 0 ? "side" : "top";
    const Eigen::Vector3d eye = i == 0 ? Eigen::Vector3d(3, -3, 2) : Eigen::Vector3d(0.1, 0, 5);
    dspace::StageCamera(*scene, camera, eye, {0, 0, 0});
    viewports[i]->Initialize(context, scene, camera, "main", 480, 360);
    viewports[i]->SetCamera(camera);
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
    scene->Frames().SetLocalPose(body, pose);
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
