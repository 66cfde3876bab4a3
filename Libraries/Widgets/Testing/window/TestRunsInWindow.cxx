// Recordings in the application's window: Python, the timeline and the views show one recording at
// one time.
#include "WindowFixture.h"

#include <cmath>

#include <QComboBox>
#include <QFile>
#include <QInputDialog>
#include <QLabel>
#include <QPlainTextEdit>
#include <QToolButton>
#include <QTreeView>

#include "OneApplication.h"
#include "vtkDspacePlayer.h"
#include "vtkDspaceViewport.h"

#include <dspace/scene/Scene.h>
#include <dspace/widgets/scene/SceneTreeModel.h>
#include <dspace/widgets/scene/SceneTreeView.h>
#include <dspace/widgets/scene/SceneTreeWidget.h>
#include <dspace/widgets/timeline/ScrubBar.h>
#include <dspace/widgets/timeline/TimelineWidget.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/ShownScenes.h>

using dspace::widgets::ScrubBar;
using dspace::widgets::TimelineWidget;
using dspace::widgets::ViewportWidget;

namespace {

const char* const View = "viewer:main";

// A box that moves by 1 m a second before a still camera, from 100 s to 110 s, with an event.
// In a process of its own, as a simulation is.
const char* const Write = R"(
import subprocess, sys, textwrap
def apart(text, *arguments, **options):
    return subprocess.Popen([sys.executable, "-c", "import dspace, sys\n" + textwrap.dedent(text), *arguments],
                            env={**__import__("os").environ, "PYTHONPATH": sys.path[0]}, text=True, **options)
MAKE = """
    def make(session):
        place = session.scene("place")
        frame = place.add_frame("cart")
        place.add_box((1, 1, 1), frame=frame, color=(1, 0.2, 0.1))
        camera = place.add_camera(eye=(5, -14, 3), target=(5, 0, 0))
        place.add_viewport((320, 200), camera, name="main")
        return place, frame
"""
def write(path):
    assert apart(MAKE + """
    with dspace.Session() as session, session.record(sys.argv[1]):
        place, frame = make(session)
        for i in range(21):
            place.time = 100 + 0.5 * i
            frame.pose = dspace.Pose(position=(0.5 * i, 0, 0))
            if i == 6:
                place.log_event("stage", "the second stage")
    """, path).wait() == 0
class Writer:
    def __init__(self, path):
        self.process = apart(MAKE + """
    with dspace.Session() as session, session.record(sys.argv[1], commit_every=0.01) as recording:
        place, frame = make(session)
        for line in sys.stdin:
            place.time = float(line)
            recording.flush()
            print(line, end="", flush=True)
    """, path, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    def time(self, *times):
        for value in times:
            print(value, file=self.process.stdin, flush=True)
            self.process.stdout.readline()
    def close(self):
        self.process.stdin.close()
        assert self.process.wait() == 0
)";

class RunsInWindow : public WindowFixture {
protected:
  static QString Path() { return folder->filePath("cart.dspace"); }
  void SetUp() override {
    WindowFixture::SetUp();
    if (!QFile::exists(Path())) {
      ASSERT_TRUE(Run(Write)) << errors.toStdString();
      ASSERT_TRUE(Run("write('" + Path() + "')")) << errors.toStdString();
    }
    ASSERT_TRUE(QTest::qWaitForWindowExposed(window));
    ASSERT_TRUE(Run("run = app.open('" + Path() + "')")) << errors.toStdString();
    ASSERT_TRUE(window->View(View));
    ASSERT_TRUE(Wait([] { return window->View(View)->isVisible(); }));
    ASSERT_TRUE(Settled());
  }
  void TearDown() override {
    EXPECT_TRUE(Run("run.close()")) << errors.toStdString();
    EXPECT_EQ(window->ViewCount(), 0);
    EXPECT_EQ(window->Scenes()->Active(), "Live");
    QFile::remove(Path() + ".marks.json");
  }
  static TimelineWidget* Timeline() { return window->findChild<TimelineWidget*>(); }
  static void Click(const char* button) {
    auto* found = Timeline()->findChild<QToolButton*>(button);
    ASSERT_TRUE(found) << button;
    ASSERT_TRUE(found->isEnabled()) << button;
    QTest::mouseClick(found, Qt::LeftButton);
  }
  static double Time() { return Timeline()->Source()->GetState().time_s; }
  static QImage Picture() {
    EXPECT_TRUE(Settled());
    window->View(View)->repaint();
    return window->View(View)->grab().toImage();
  }
  // Where the box is in the picture, from 0 to 1.
  static double BoxAt() {
    const QImage picture = Picture();
    double sum = 0.0, count = 0.0;
    for (int y = 0; y < picture.height(); ++y) {
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
  static double CartX() {
    return Number("run.session.scenes['place'].frames['cart'].pose.position[0]");
  }
};

} // namespace

TEST_F(RunsInWindow, TheTimelineShowsAndMovesIt) {
  EXPECT_EQ(window->Scenes()->Active(), "cart.dspace");
  const auto state = Timeline()->Source()->GetState();
  ASSERT_TRUE(state.range);
  EXPECT_EQ(state.range->begin, 100.0);
  EXPECT_EQ(state.range->end, 110.0);
  ASSERT_EQ(Timeline()->Source()->Events().size(), 1u);
  EXPECT_EQ(Timeline()->Source()->Events()[0].text, "the second stage");
  const double begin = BoxAt();
  ASSERT_GT(begin, 0.0);
  // The mouse scrubs.
  ScrubBar* bar = Timeline()->Bar();
  QTest::mouseClick(bar, Qt::LeftButton, Qt::NoModifier,
                    {int(std::lround(bar->PlaceOf(108.0))), 22});
  ASSERT_TRUE(Wait([] { return std::abs(Time() - 108.0) < 0.6; }));
  EXPECT_NEAR(Number("run.time"), Time(), 1e-9);
  EXPECT_NEAR(CartX(), Time() - 100.0, 1e-9);
  const double later = BoxAt();
  EXPECT_GT(later, begin + 0.2);
  // A script seeks.
  ASSERT_TRUE(Run("assert run.seek(103.0) == 103.0")) << errors.toStdString();
  ASSERT_TRUE(Wait([] { return Time() == 103.0; }));
  EXPECT_NEAR(CartX(), 3.0, 1e-9);
  const double middle = BoxAt();
  EXPECT_GT(middle, begin + 0.05);
  EXPECT_LT(middle, later - 0.05);
  QTest::qWait(200);
  EXPECT_EQ(Time(), 103.0); // the timeline does not take it back
  Click("Step");
  ASSERT_TRUE(Wait([] { return Time() == 103.5; }));
  Click("Step back");
  Click("Step back");
  ASSERT_TRUE(Wait([] { return Time() == 102.5; }));
  EXPECT_EQ(Number("run.index"), Number("run.times.index(102.5)"));
}

TEST_F(RunsInWindow, ANewViewIsOfTheRecording) {
  const int views = window->ViewCount();
  ASSERT_TRUE(Run("made = app.new_view()")) << errors.toStdString();
  EXPECT_EQ(window->ViewCount(), views + 1);
  EXPECT_EQ(Value("made._client is run.session._client"), "True");
  EXPECT_EQ(window->Scenes()->Active(), "cart.dspace");
  ViewportWidget* made = window->View(Value("made.name"));
  ASSERT_TRUE(made);
  ASSERT_TRUE(Wait([&] { return made->ShownPictures() > 0 && made->isVisible(); }));
  ASSERT_TRUE(Settled());
  // The red cart is in it, as in the first view.
  const QImage picture = made->grab().toImage();
  int red = 0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const QColor color = picture.pixelColor(x, y);
      red += color.red() > 60 && color.red() > 2 * color.green() ? 1 : 0;
    }
  }
  EXPECT_GT(red, 20);
}

TEST_F(RunsInWindow, PlaysFasterSlowerAndBackwards) {
  Click("Faster");
  Click("Faster");
  EXPECT_EQ(Timeline()->Source()->GetState().speed, 4.0);
  Click("Play");
  ASSERT_TRUE(Wait([] { return Time() > 104.0; }));
  Click("Play"); // pause
  const double stood = Time();
  QTest::qWait(300);
  EXPECT_EQ(Time(), stood);
  Click("Reverse");
  Click("Play");
  ASSERT_TRUE(Wait([&] { return Time() < stood - 1.0; }));
  ASSERT_TRUE(Run("run.pause()"));
  Click("Slower");
  EXPECT_EQ(Timeline()->Source()->GetState().speed, -2.0);
  // A script loops over a part.
  ASSERT_TRUE(Run("run.seek(100.0); run.loop(105.0, 106.0); run.play(8.0)"))
      << errors.toStdString();
  double most = 0.0;
  ASSERT_TRUE(Wait([] { return Time() >= 105.0; }));
  for (int i = 0; i < 20; ++i) {
    QTest::qWait(30);
    most = std::max(most, Time());
    EXPECT_GE(Time(), 105.0);
  }
  EXPECT_LE(most, 106.0);
  ASSERT_TRUE(Run("run.loop(); run.pause()"));
}

TEST_F(RunsInWindow, ACameraOfOnesOwnStaysWhenItMoves) {
  ViewportWidget* view = window->View(View);
  const double before = BoxAt();
  const QPoint center = view->rect().center();
  QTest::mousePress(view, Qt::LeftButton, Qt::NoModifier, center);
  QMouseEvent move(QEvent::MouseMove, QPointF(center + QPoint(90, 20)),
                   view->mapToGlobal(QPointF(center + QPoint(90, 20))), Qt::NoButton,
                   Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(view, &move);
  QTest::mouseRelease(view, Qt::LeftButton, Qt::NoModifier, center + QPoint(90, 20));
  QTest::qWait(500); // until all samples are back
  ASSERT_TRUE(Settled());
  const double moved = BoxAt();
  EXPECT_GT(std::abs(moved - before), 0.01);
  const QImage picture = Picture();
  vtkDspaceViewport* const first = view->GetViewport();
  ASSERT_TRUE(Run("run.seek(109.0)"));
  ASSERT_TRUE(Run("run.seek(100.0)")); // back: everything is made anew
  ASSERT_TRUE(Wait([&] { return view->GetViewport() != first; }));
  ASSERT_TRUE(Settled());
  EXPECT_NEAR(BoxAt(), moved, 2e-3);
  EXPECT_EQ(Picture(), picture);
  // Of the recording nothing has changed.
  EXPECT_EQ(Value("sorted(n for n in run.session.scenes['place'].vantages)"),
            "['main', 'viewer:main']");
}

TEST_F(RunsInWindow, TheDocksShowTheSceneThatIsUsed) {
  auto* list = window->findChild<QComboBox*>("scenes");
  ASSERT_TRUE(list);
  EXPECT_TRUE(list->isVisible());
  ASSERT_EQ(list->count(), 2);
  auto* tree = window->findChild<dspace::widgets::SceneTreeWidget*>();
  const auto has = [&](const QString& name) {
    tree->Refresh();
    const QAbstractItemModel* model = tree->View()->model();
    const QModelIndex root = model->index(0, 0);
    for (int row = 0; row < model->rowCount(root); ++row) {
      if (model->index(row, 0, root).data().toString() == name) {
        return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(has("cart"));
  ASSERT_TRUE(Run("app.scene.add_frame('mine') if 'mine' not in app.scene.frames else None"));
  list->setFocus();
  QTest::keyClick(list, Qt::Key_Up); // the user's choice
  EXPECT_EQ(window->Scenes()->Active(), "Live");
  EXPECT_TRUE(has("mine"));
  EXPECT_FALSE(has("cart"));
  EXPECT_FALSE(Timeline()->Source()->GetState().canSeek);
  // A click into a view brings its scene back.
  QTest::mouseClick(window->View(View), Qt::LeftButton);
  EXPECT_EQ(window->Scenes()->Active(), "cart.dspace");
  EXPECT_TRUE(Wait([&] { return has("cart"); }));
  EXPECT_TRUE(Timeline()->Source()->GetState().canSeek);
  // It plays also when it is not in the docks.
  ASSERT_TRUE(Run("run.seek(100.0); run.play(4.0)"));
  list->setFocus();
  QTest::keyClick(list, Qt::Key_Up);
  ASSERT_TRUE(Wait([] { return Number("run.time") > 103.0; }));
  ASSERT_TRUE(Run("run.pause()"));
}

TEST_F(RunsInWindow, MarksAreKeptBesideTheRecording) {
  ASSERT_TRUE(Run("run.seek(104.0)"));
  ASSERT_TRUE(
      Wait([] { return Timeline()->findChild<QLabel*>("elapsed")->text() == "T+ 00:00:04.000"; }));
  Click("Mark");
  auto* dialog = Timeline()->findChild<QInputDialog*>();
  ASSERT_TRUE(dialog);
  dialog->findChild<QPlainTextEdit*>()->setPlainText("look here");
  dialog->accept();
  const QString file = Path() + ".marks.json";
  ASSERT_TRUE(Wait([&] { return QFile::exists(file); }));
  QFile read(file);
  ASSERT_TRUE(read.open(QIODevice::ReadOnly));
  EXPECT_TRUE(read.readAll().contains("look here"));
  ASSERT_TRUE(Run("run.close(); run = app.open('" + Path() + "')")) << errors.toStdString();
  ASSERT_TRUE(Wait([] { return Timeline()->Marks().size() == 1; }));
  EXPECT_EQ(Timeline()->Marks()[0].note, "look here");
  EXPECT_EQ(Timeline()->Marks()[0].time_s, 104.0);
}

TEST_F(RunsInWindow, TwoOfThemHaveTimesAndViewsOfTheirOwn) {
  ASSERT_TRUE(Run("other = app.open('" + Path() + "')")) << errors.toStdString();
  ASSERT_TRUE(window->View("viewer:main 2"));
  ASSERT_TRUE(Run("run.seek(101.0); other.seek(108.0)"));
  EXPECT_EQ(CartX(), 1.0);
  EXPECT_EQ(Number("other.session.scenes['place'].frames['cart'].pose.position[0]"), 8.0);
  ASSERT_TRUE(Settled());
  EXPECT_NE(window->View(View)->grab().toImage(), window->View("viewer:main 2")->grab().toImage());
  ASSERT_TRUE(Run("other.close()"));
  EXPECT_EQ(window->ViewCount(), 1);
}

TEST_F(RunsInWindow, FollowsTheEndOfOneThatIsBeingWritten) {
  const QString path = folder->filePath("live.dspace");
  ASSERT_TRUE(Run("writer = Writer('" + path + "'); writer.time(10, 11, 12, 13, 14)"))
      << errors.toStdString();
  ASSERT_TRUE(Run("live = app.open('" + path + "')")) << errors.toStdString();
  EXPECT_EQ(Timeline()->Source()->GetState().range->end, 14.0);
  EXPECT_FALSE(Timeline()->Source()->GetState().grows);
  ASSERT_TRUE(Run("writer.time(15, 16)"));
  ASSERT_TRUE(Wait([] { return Timeline()->Source()->GetState().range->end == 16.0; }));
  EXPECT_EQ(Time(), 10.0);
  Click("Live");
  ASSERT_TRUE(Wait([] { return Time() == 16.0; }));
  ASSERT_TRUE(Run("writer.time(20)"));
  ASSERT_TRUE(Wait([] { return Time() == 20.0; }));
  EXPECT_EQ(Number("live.time"), 20.0);
  ASSERT_TRUE(Run("live.close(); writer.close()")) << errors.toStdString();
}
