// DspaceQt with its demo scene: the time from the start to the first picture, and how long the
// window does not answer while the rover drives and the camera turns. Python files are compiled, as
// they are after the first start and in an installed tree.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <vector>

#include <unistd.h>

#include <QApplication>
#include <QDir>
#include <QElapsedTimer>
#include <QProcess>
#include <QStandardPaths>
#include <QTemporaryDir>
#include <QTest>
#include <QTimer>

#include "vtkDspaceViewport.h"

#include <dspace/widgets/viewport/QtContext.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/MainWindow.h>

#include "Alternate.h"
#include "WithDisplay.h"

namespace {

constexpr int Watched_ms = 10000;

// Since this program was started, from the kernel's record of it.
double SecondsSinceStart() {
  unsigned long long ticks = 0;
  if (std::FILE* file = std::fopen("/proc/self/stat", "r")) {
    // The 22nd field; the second is a name in brackets.
    if (std::fscanf(file,
                    "%*d (%*[^)]) %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %*u %*u %*d %*d %*d "
                    "%*d %*d %*d %llu",
                    &ticks) != 1) {
      ticks = 0;
    }
    std::fclose(file);
  }
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec) -
         double(ticks) / double(sysconf(_SC_CLK_TCK));
}

// A square of 500 x 500 cells.
void WriteModel(const QString& path) {
  constexpr int Side = 500;
  std::FILE* file = std::fopen(path.toUtf8().constData(), "w");
  for (int i = 0; file && i < (Side + 1) * (Side + 1); ++i) {
    std::fprintf(file, "v %d %d 0\n", i % (Side + 1), i / (Side + 1));
  }
  for (int i = 0; file && i < Side * Side; ++i) {
    const int a = i / Side * (Side + 1) + i % Side + 1;
    std::fprintf(file, "f %d %d %d %d\n", a, a + 1, a + Side + 2, a + Side + 1);
  }
  if (file) {
    std::fclose(file);
  }
}

// The first start only compiles.
int Measure(bool all) {
  dspace::widgets::MainWindow window(QStringLiteral(DSPACE_PACKAGES));
  const double windowMade = SecondsSinceStart();
  window.resize(1280, 800);
  window.show();
  if (!window.Run(QStringLiteral("app.demo()"))) {
    std::printf("application: the demo scene does not start\n");
    return 1;
  }
  dspace::widgets::ViewportWidget* view = window.View("chase");
  if (!view || !QTest::qWaitFor([&] { return view->ShownPictures() > 0; }, 30000)) {
    std::printf("application: there is no picture\n");
    return 1;
  }
  if (!all) {
    return 0;
  }
  std::printf(
      "application: from the start to the first picture of the demo scene %.2f s (goal 1.5), "
      "%.2f s of them to the window\n",
      SecondsSinceStart(), windowMade);

  // A timer of no duration comes round as often as the window can answer.
  QTest::qWait(3000);
  std::vector<double> gaps;
  QElapsedTimer since;
  QTimer beat;
  QObject::connect(&beat, &QTimer::timeout, &beat, [&] {
    gaps.push_back(1e-6 * double(since.nsecsElapsed()));
    since.restart();
  });
  QTimer turning;
  QObject::connect(&turning, &QTimer::timeout, view,
                   [view] { QTest::keyClick(view, Qt::Key_Left); });
  const int before = view->ShownPictures();
  since.start();
  beat.start(0);
  turning.start(200);
  QEventLoop loop;
  QTimer::singleShot(Watched_ms, &loop, &QEventLoop::quit);
  loop.exec();
  beat.stop();
  std::sort(gaps.begin(), gaps.end());
  std::printf("application: the demo in %dx%d and another view: %.1f pictures/s; the window does "
              "not answer for %.0f ms at most, 99 %% of the %zu gaps are under %.0f ms\n",
              view->width(), view->height(),
              1e3 * double(view->ShownPictures() - before) / Watched_ms, gaps.back(), gaps.size(),
              gaps[std::size_t(0.99 * double(gaps.size() - 1))]);

  // The longest gap while files are opened: a model of 500,000 triangles, terrain, a robot.
  const QString model = QDir::temp().filePath("dspace_bench_application.obj");
  WriteModel(model);
  const QString data = qEnvironmentVariable("DSPACE_SHIPPED_DATA");
  for (const QString& path : {model, data + "/field/field.tif", data + "/rover/rover.urdf"}) {
    gaps.clear();
    since.restart();
    beat.start(0);
    QElapsedTimer opening;
    opening.start();
    const bool good = window.Open(path);
    const double took = 1e-3 * double(opening.elapsed());
    gaps.push_back(1e-6 * double(since.nsecsElapsed())); // what was not interrupted
    beat.stop();
    std::printf("application: %s %s in %.2f s; the window does not answer for %.0f ms at most\n",
                good ? "opened" : "FAILED to open", path.section('/', -1).toUtf8().constData(),
                took, *std::max_element(gaps.begin(), gaps.end()));
  }
  std::remove(model.toUtf8().constData());
  return 0;
}

// Runs this program again, once its Python files are compiled: the second start is measured.
int StartTwice(const char* program) {
  const QTemporaryDir folder;
  qputenv("PYTHONPYCACHEPREFIX", folder.path().toUtf8());
  qunsetenv("PYTHONDONTWRITEBYTECODE");
  const int first = QProcess::execute(program, {"--start"});
  return first != 0 ? first : QProcess::execute(program, {"--measure"});
}

} // namespace

int main(int count, char** arguments) {
  dspace::bench::NeedDisplay(arguments[0]);
  const QByteArray mode = count > 1 ? arguments[1] : "";
  if (mode.isEmpty()) {
    return StartTwice(arguments[0]);
  }
  dspace::widgets::PrepareApplication();
  QApplication application(count, arguments);
  QStandardPaths::setTestModeEnabled(true); // not the user's settings
  return Measure(mode == "--measure");
}
