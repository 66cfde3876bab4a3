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

int main(int argc, char** argv) {
  dspace::widgets::PrepareApplication(); // before the QApplication
  QApplication application(argc, argv);
  const auto scene = std::make_shared<dspace::Scene>("scene");
  const dspace::FrameId body = dspace::StageModel(*scene, argc > 1 ? argv[1] : "", "body");
  dspace::StageSun(*scene, {0.4, -0.5, 0.8});
  dspace::StageCamera(*scene, "side", {3, -3, 2}, {0, 0, 0});
  dspace::StageCamera(*scene, "top", {0.1, 0, 5}, {0, 0, 0});

  QMainWindow window;
  auto* splitter = new QSplitter(&window);
  auto* side = new dspace::widgets::ViewportWidget(scene, "side", splitter);
  new dspace::widgets::ViewportWidget(scene, "top", splitter);
  window.setCentralWidget(splitter);
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
  std::cout << steps << " steps, " << side->ShownPictures() << " pictures\n";
  return code;
}
