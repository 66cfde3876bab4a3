// Servers in the application's window: simulations of other processes, also fast ones, ones that
// die and come back, and servers that are not there.
#include "WindowFixture.h"

#include <algorithm>
#include <chrono>

#include <QAction>
#include <QElapsedTimer>
#include <QInputDialog>
#include <QLineEdit>
#include <QMenuBar>
#include <QToolButton>

#include "OneApplication.h"

#include <dspace/widgets/timeline/TimelineWidget.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/ShownScenes.h>
#include <dspace/widgets/window/TaskStrip.h>

using dspace::widgets::TaskStrip;
using dspace::widgets::TimelineWidget;
using dspace::widgets::ViewportWidget;

namespace {

const char* const ServerView = "viewer:main";

const char* const Tools = R"(
import os, signal, subprocess, sys, textwrap
def apart(text, *arguments):
    return subprocess.Popen([sys.executable, "-c", "import dspace, sys, time\n" + textwrap.dedent(text), *arguments],
                            env={**os.environ, "PYTHONPATH": sys.path[0]}, text=True,
                            stdin=subprocess.PIPE, stdout=subprocess.PIPE)
# A box on the left (side -1) or on the right (1), in a view of the simulation; then steps at `rate`.
SIMULATION = """
    address, side, rate = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
    with dspace.connect(address, name="cart " + sys.argv[4]) as session:
        place = session.scene("place")
        cart = place.frames.get("cart") or place.add_frame("cart")
        if "box" not in place.objects:
            place.add_box((1, 1, 1), frame=cart, color=(1, 0.2, 0.1), name="box")
            place.add_viewport((320, 200), place.add_camera(eye=(0, -14, 3), target=(0, 0, 0)), name="main")
        cart.pose = dspace.Pose(position=(3 * side, 0, 0))
        print("ready", flush=True)
        begun, steps = time.monotonic(), 0
        while True:
            place.time = steps / rate
            cart.pose = dspace.Pose(position=(3 * side, 0, 0.001 * (steps % 2)))
            steps += 1
            time.sleep(max(0.0, begun + steps / rate - time.monotonic()))
"""
def simulate(address, side, rate, name="one"):
    made = apart(SIMULATION, address, str(side), str(rate), name)
    return made
def end(process, number=signal.SIGKILL):
    process.send_signal(number)
    process.wait()
    process.stdin.close(), process.stdout.close()
)";

class ServersInWindow : public WindowFixture {
protected:
  void SetUp() override {
    WindowFixture::SetUp();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(window));
    ASSERT_TRUE(Run(Tools)) << errors.toStdString();
  }
  void TearDown() override {
    EXPECT_TRUE(Run("for link in list(app.links): link.close()")) << errors.toStdString();
    EXPECT_EQ(window->ViewCount(), 0);
    EXPECT_EQ(Strip()->Count(), 0);
  }
  static TaskStrip* Strip() { return window->findChild<TaskStrip*>(); }
  static bool WaitFor(const QString& expression, const std::string& value,
                      int milliseconds = 20000) {
    return Wait([&] { return Value(expression) == value; }, milliseconds);
  }
  // Where the box is in the picture, from 0 to 1; -1: nowhere.
  static double BoxAt() {
    const QImage picture = window->View(ServerView)->grab().toImage();
    double sum = 0.0, count = 0.0;
    for (int y = 0; y < picture.height() * 3 / 4; ++y) { // the notice is below
      for (int x = 0; x < picture.width(); ++x) {
        const QColor color = picture.pixelColor(x, y);
        if (color.red() > 60 && color.red() > 2 * color.green()) {
          sum += x;
          ++count;
        }
      }
    }
    return count > 0.0 ? sum / count / picture.width() : -1.0;
  }
  // What differs from black at the bottom of the picture: the notice.
  static int NoticePixels() {
    const QImage picture = window->View(ServerView)->grab().toImage();
    int count = 0;
    for (int y = picture.height() * 3 / 4; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        count += qGray(picture.pixel(x, y)) > 30 ? 1 : 0;
      }
    }
    return count;
  }
  static bool BoxIsOn(bool left) {
    return Wait([&] {
      const double at = window->View(ServerView) ? BoxAt() : -1.0;
      return at >= 0.0 && (left ? at < 0.45 : at > 0.55);
    });
  }
};

} // namespace

TEST_F(ServersInWindow, ASimulationDrivesTheWindowDiesAndComesBack) {
  ASSERT_TRUE(Run("link = app.listen()")) << errors.toStdString();
  ASSERT_TRUE(WaitFor("link.state", "connected")) << errors.toStdString();
  EXPECT_TRUE(Strip()->Text(1).endsWith(": no simulation")) << Strip()->Text(1).toStdString();
  ASSERT_TRUE(Run("one = simulate(link.address, -1, 50)"));
  ASSERT_TRUE(Wait([] { return window->View(ServerView) != nullptr; })) << errors.toStdString();
  ASSERT_TRUE(BoxIsOn(true));
  EXPECT_TRUE(window->Scenes()->Active().startsWith("Simulation at 127.0.0.1:"));
  ASSERT_TRUE(Wait([] { return NoticePixels() == 0; }));
  ASSERT_TRUE(WaitFor("link.simulation", "cart one"));
  // It dies: the state stays, below a notice.
  ASSERT_TRUE(Run("end(one)"));
  ASSERT_TRUE(WaitFor("link.simulation", "None"));
  ASSERT_TRUE(Wait([] { return NoticePixels() > 200; }));
  EXPECT_TRUE(BoxIsOn(true));
  const double stood = Number("link.scenes['place'].time");
  EXPECT_GT(stood, 0.0);
  // Another one takes over: in the same view.
  ViewportWidget* const view = window->View(ServerView);
  ASSERT_TRUE(Run("two = simulate(link.address, 1, 50, 'two')"));
  ASSERT_TRUE(WaitFor("link.simulation", "cart two")) << errors.toStdString();
  ASSERT_TRUE(BoxIsOn(false));
  ASSERT_TRUE(Wait([] { return NoticePixels() == 0; }));
  EXPECT_EQ(window->View(ServerView), view);
  EXPECT_EQ(window->ViewCount(), 1);
  ASSERT_TRUE(Run("end(two)"));
  EXPECT_EQ(errors.toStdString(), "");
}

TEST_F(ServersInWindow, AServerThatComesBackIsFoundAgain) {
  const QString address = "unix:" + folder->filePath("socket");
  ASSERT_TRUE(Run("address = '" + address + "'\n" + R"(
def serve():
    made = subprocess.Popen([sys.executable, "-m", "dspace", "serve", "--listen", address],
                            env={**os.environ, "PYTHONPATH": sys.path[0]}, stdin=subprocess.PIPE,
                            stdout=subprocess.PIPE, text=True)
    made.stdout.readline()
    return made
server = serve()
one = simulate(address, -1, 20)
one.stdout.readline()
link = app.connect(address))"))
      << errors.toStdString();
  ASSERT_TRUE(Wait([] { return window->View(ServerView) != nullptr; })) << errors.toStdString();
  ASSERT_TRUE(BoxIsOn(true));
  ASSERT_TRUE(Run("end(one); end(server)"));
  ASSERT_TRUE(WaitFor("link.state", "lost"));
  EXPECT_TRUE(Strip()->Text(1).endsWith("is lost; connecting again"));
  ASSERT_TRUE(Wait([] { return NoticePixels() > 200; }));
  EXPECT_TRUE(BoxIsOn(true));
  QFile::remove(folder->filePath("socket"));
  ASSERT_TRUE(Run("server = serve(); two = simulate(address, 1, 20, 'two')"));
  ASSERT_TRUE(WaitFor("link.state", "connected"));
  ASSERT_TRUE(BoxIsOn(false));
  ASSERT_TRUE(Wait([] { return NoticePixels() == 0; }));
  EXPECT_EQ(window->ViewCount(), 1);
  ASSERT_TRUE(Run("end(two); end(server)"));
}

// The longest time that the loop of events stands still is told; a thousand steps a second arrive.
TEST_F(ServersInWindow, AThousandStepsASecondLeaveTheWindowAlive) {
  ASSERT_TRUE(Run("link = app.listen()"));
  ASSERT_TRUE(WaitFor("link.state", "connected")) << errors.toStdString();
  ASSERT_TRUE(Run("one = simulate(link.address, -1, 1000)"));
  ASSERT_TRUE(Wait([] { return window->View(ServerView) != nullptr; })) << errors.toStdString();
  ASSERT_TRUE(BoxIsOn(true));
  const double before = Number("link.scenes['place'].time");
  qint64 longest = 0;
  QElapsedTimer gap, whole;
  QTimer beat;
  QObject::connect(&beat, &QTimer::timeout, [&] {
    longest = std::max(longest, gap.elapsed());
    gap.restart();
  });
  beat.start(5);
  gap.start();
  whole.start();
  QTest::qWait(3000);
  beat.stop();
  const double passed = Number("link.scenes['place'].time") - before;
  const double factor = passed / (1e-3 * double(whole.elapsed()));
  std::cout << "real-time factor " << factor << ", longest gap " << longest << " ms\n";
  EXPECT_GT(factor, 0.0); // the machine also runs the simulation and the server
  EXPECT_GT(Number("link.sequence"), 500.0);
  // The person at the window moves the camera meanwhile, and the simulation does not.
  ViewportWidget* view = window->View(ServerView);
  const std::string pose = Value("app.views['viewer:main'].camera.pose.position");
  const QPoint center = view->rect().center();
  QTest::mousePress(view, Qt::LeftButton, Qt::NoModifier, center);
  QMouseEvent move(QEvent::MouseMove, QPointF(center + QPoint(60, 10)),
                   view->mapToGlobal(QPointF(center + QPoint(60, 10))), Qt::NoButton,
                   Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(view, &move);
  QTest::mouseRelease(view, Qt::LeftButton, Qt::NoModifier, center + QPoint(60, 10));
  const std::string moved = Value("app.views['viewer:main'].camera.pose.position");
  EXPECT_NE(moved, pose);
  QTest::qWait(200);
  EXPECT_EQ(Value("app.views['viewer:main'].camera.pose.position"), moved);
  ASSERT_TRUE(Run("end(one)"));
}

TEST_F(ServersInWindow, WhatDoesNotAnswerIsCancelled) {
  QElapsedTimer clock;
  clock.start();
  // By the menu, as a person does.
  for (QAction* menu : window->menuBar()->actions()) {
    for (QAction* action : menu->menu()->actions()) {
      if (action->text().startsWith("&Connect")) {
        action->trigger();
      }
    }
  }
  auto* dialog = window->findChild<QInputDialog*>();
  ASSERT_TRUE(dialog);
  dialog->findChild<QLineEdit*>()->setText("unix:" + folder->filePath("nobody"));
  dialog->accept();
  EXPECT_LT(clock.elapsed(), 2000); // it does not wait for the server
  EXPECT_EQ(Value("app.links[0].state"), "connecting");
  ASSERT_EQ(Strip()->Count(), 1);
  EXPECT_TRUE(Strip()->Text(1).startsWith("Connecting to unix:"));
  QTest::qWait(300);
  auto* cancel = Strip()->findChild<QToolButton*>("cancel");
  ASSERT_TRUE(cancel);
  QTest::mouseClick(cancel, Qt::LeftButton);
  EXPECT_EQ(Value("app.links"), "[]");
  EXPECT_EQ(Strip()->Count(), 0);
}

TEST_F(ServersInWindow, WhatCannotBeIsSaid) {
  EXPECT_FALSE(Run("app.connect('')"));
  EXPECT_TRUE(errors.contains("HOST:PORT or unix:PATH")) << errors.toStdString();
  errors.clear();
  EXPECT_FALSE(Run("app.connect('no address')"));
  EXPECT_TRUE(errors.contains("no address")) << errors.toStdString();
  errors.clear();
  ASSERT_TRUE(Run("bad = app.listen('nowhere.invalid:1')"));
  ASSERT_TRUE(WaitFor("bad.state", "failed"));
  EXPECT_NE(Value("bad.failure"), "");
  EXPECT_EQ(Strip()->Count(), 0);
}
