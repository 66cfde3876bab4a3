// Camera keys on the timeline: added, dragged, frozen, edited and deleted by mouse and keys, kept
// in the movie's file, previewed in a view, exported.
#include "WindowFixture.h"

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QElapsedTimer>
#include <QFile>
#include <QInputDialog>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>
#include <QSpinBox>
#include <QTimer>
#include <QToolButton>

#include "OneApplication.h"
#include "vtkDspaceViewport.h"

#include <dspace/widgets/console/ConsoleWidget.h>
#include <dspace/widgets/timeline/KeyTrack.h>
#include <dspace/widgets/timeline/ScrubBar.h>
#include <dspace/widgets/timeline/TimelineWidget.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/ExportDialog.h>
#include <dspace/widgets/window/KeyDialog.h>
#include <dspace/widgets/window/MovieTrack.h>
#include <dspace/widgets/window/ShownScenes.h>
#include <dspace/widgets/window/TaskStrip.h>

using dspace::widgets::ExportDialog;
using dspace::widgets::KeyDialog;
using dspace::widgets::KeyTrack;
using dspace::widgets::ScrubBar;
using dspace::widgets::TimelineWidget;
using dspace::widgets::ViewportWidget;

namespace {

const char* const View = "viewer:main";

class MovieTrackTest : public WindowFixture {
protected:
  static QString Path() { return folder->filePath("flight.dspace"); }
  void SetUp() override {
    WindowFixture::SetUp();
    if (!QFile::exists(Path())) { // a box that moves by 1 m a second, from 100 s to 110 s
      ASSERT_TRUE(Run(QString(R"(
import subprocess, sys, os
assert subprocess.Popen([sys.executable, "-c", """
import dspace, sys
with dspace.Session() as session, session.record(sys.argv[1]):
    place = session.scene()
    frame = place.add_frame("cart")
    place.add_box((1, 1, 1), frame=frame, color=(1, 0.2, 0.1))
    camera = place.add_camera(eye=(5, -14, 3), target=(5, 0, 0))
    place.add_viewport((320, 200), camera, name="main")
    for i in range(41):
        place.time = 100 + 0.25 * i
        frame.pose = dspace.Pose((0.25 * i, 0, 0))
""", "%1"], env={**os.environ, "PYTHONPATH": sys.path[0]}).wait() == 0)")
                          .arg(Path())))
          << errors.toStdString();
    }
    ASSERT_TRUE(QTest::qWaitForWindowExposed(window));
    EXPECT_TRUE(Track()->isHidden());
    ASSERT_TRUE(Run("run = app.open('" + Path() + "')")) << errors.toStdString();
    ASSERT_TRUE(window->View(View));
    ASSERT_TRUE(Wait([] { return Track()->isVisible() && window->View(View)->isVisible(); }));
    ASSERT_TRUE(Settled());
  }
  void TearDown() override {
    EXPECT_TRUE(Run("run.close()")) << errors.toStdString();
    EXPECT_TRUE(Track()->isHidden());
    QFile::remove(Path() + ".movie.toml");
  }
  static TimelineWidget* Timeline() { return window->findChild<TimelineWidget*>(); }
  static KeyTrack* Track() { return Timeline()->Keys(); }
  static QPoint At(double run_s) {
    return {int(std::lround(Timeline()->Bar()->PlaceOf(run_s))), Track()->height() / 2};
  }
  static double Time() { return Timeline()->Source()->GetState().time_s; }
  static void Seek(double time_s) {
    ASSERT_TRUE(Run(QString("run.seek(%1)").arg(time_s)));
    ASSERT_TRUE(Wait([&] { return std::abs(Time() - time_s) < 1e-9; }));
  }
  static void Look(const char* eye) {
    ASSERT_TRUE(Run(QString("from dspace.application.views import own_camera\n"
                            "own_camera(app.views['%1']).look_at(eye=%2, target=(5, 0, 0))")
                        .arg(View, eye)))
        << errors.toStdString();
  }
  // Keys at 101, 105 and 109 s, by the key K on the timeline.
  static void AddThree() {
    const char* const eyes[] = {"(0, -10, 2)", "(5, -10, 2)", "(10, -10, 2)"};
    for (int i = 0; i < 3; ++i) {
      Seek(101.0 + 4.0 * i);
      Look(eyes[i]);
      QTest::keyClick(Timeline(), Qt::Key_K);
    }
    ASSERT_EQ(Track()->Keys().size(), 3u) << errors.toStdString();
  }
  static std::string Runs() {
    return Value("[(key.time, round(key.run, 6)) for key in app.movie.keys]");
  }
  static std::string Script() { return window->Console()->Script().toStdString(); }
};

} // namespace

TEST_F(MovieTrackTest, KeysAreAddedDraggedAndDeleted) {
  AddThree();
  EXPECT_EQ(Runs(), "[(0.0, 101.0), (4.0, 105.0), (8.0, 109.0)]");
  // The console has the lines.
  EXPECT_NE(Script().find("app.movie.add_key(app.views[\"viewer:main\"], 105"), std::string::npos);
  // A click selects and goes there.
  QTest::mouseClick(Track(), Qt::LeftButton, {}, At(101.0));
  EXPECT_EQ(Track()->Selected(), 0);
  EXPECT_TRUE(Wait([] { return Time() == 101.0; }));
  EXPECT_EQ(Runs(), "[(0.0, 101.0), (4.0, 105.0), (8.0, 109.0)]"); // a click moves nothing
  // A drag moves: one line for all of it.
  const auto lines = [] { return QString::fromStdString(Script()).count("move_key"); };
  const auto before = lines();
  QTest::mousePress(Track(), Qt::LeftButton, {}, At(105.0));
  for (const double time_s : {104.5, 104.0, 103.0}) {
    QTest::mouseMove(Track(), At(time_s));
  }
  QTest::mouseRelease(Track(), Qt::LeftButton, {}, At(103.0));
  EXPECT_EQ(lines() - before, 1);
  const double pixel = Timeline()->Bar()->TimeAt(101) - Timeline()->Bar()->TimeAt(100);
  EXPECT_NEAR(Track()->Keys()[1].run_s, 103.0, pixel);
  EXPECT_NEAR(Track()->Keys()[1].movie_s, 2.0, pixel);
  EXPECT_NEAR(Track()->Keys()[2].movie_s, 8.0, 1e-9);
  // Not beyond its neighbour, and Escape ends a drag.
  QTest::mousePress(Track(), Qt::LeftButton, {}, At(Track()->Keys()[1].run_s));
  QTest::mouseMove(Track(), At(109.9));
  QTest::keyClick(Track(), Qt::Key_Escape);
  QTest::mouseRelease(Track(), Qt::LeftButton, {}, At(109.9));
  EXPECT_EQ(lines() - before, 1);
  QTest::mousePress(Track(), Qt::LeftButton, {}, At(Track()->Keys()[1].run_s));
  QTest::mouseMove(Track(), At(108.0));
  QTest::mouseMove(Track(), At(109.9));
  QTest::mouseRelease(Track(), Qt::LeftButton, {}, At(109.9));
  EXPECT_LT(Track()->Keys()[1].run_s, 109.0);
  EXPECT_NEAR(Track()->Keys()[1].run_s, 109.0, 3.0 * pixel);
  // Delete removes the selected one.
  QTest::keyClick(Track(), Qt::Key_Delete);
  EXPECT_EQ(Track()->Keys().size(), 2u);
  // Another key in a double click beside keys.
  QTest::mouseDClick(Track(), Qt::LeftButton, {}, At(106.0));
  ASSERT_EQ(Track()->Keys().size(), 3u);
  EXPECT_NEAR(Track()->Keys()[1].run_s, 106.0, pixel);
  EXPECT_EQ(errors.toStdString(), "");
}

TEST_F(MovieTrackTest, TheFileIsThatOfTheCommandAndIsLoadedAgain) {
  AddThree();
  ASSERT_TRUE(Run("app.movie.flush()"));
  EXPECT_EQ(
      Value("[k.run for k in dspace.Movie.load('" + Path() + ".movie.toml').views['main'].keys]"),
      "[101.0, 105.0, 109.0]");
  ASSERT_TRUE(Run("run.close()\nrun = app.open('" + Path() + "')"));
  ASSERT_TRUE(Wait([] { return Track()->isVisible(); }));
  EXPECT_EQ(Track()->Keys().size(), 3u);
}

TEST_F(MovieTrackTest, TheDialogEditsAndFreezes) {
  AddThree();
  QTest::mouseDClick(Track(), Qt::LeftButton, {}, At(105.0));
  auto* dialog = window->findChild<KeyDialog*>();
  ASSERT_TRUE(dialog);
  EXPECT_EQ(dialog->findChild<QDoubleSpinBox*>("run")->value(), 105.0);
  EXPECT_EQ(dialog->findChild<QDoubleSpinBox*>("span")->value(), 4.0);
  EXPECT_TRUE(dialog->Lines().isEmpty());
  dialog->findChild<QDoubleSpinBox*>("freeze")->setValue(2.5);
  dialog->findChild<QDoubleSpinBox*>("span")->setValue(8.0);
  dialog->findChild<QComboBox*>("easing")->setCurrentIndex(1);
  QTest::keyClick(dialog, Qt::Key_Return);
  EXPECT_TRUE(Wait([] { return !window->findChild<KeyDialog*>(); }));
  EXPECT_EQ(Runs(), "[(0.0, 101.0), (4.0, 105.0), (6.5, 105.0), (14.5, 109.0)]");
  EXPECT_TRUE(Track()->Keys()[1].rest);
  // The freeze is drawn with its seconds; a key of it is dragged with it.
  EXPECT_NE(Track()->Keys()[1].text.indexOf("2.5 s"), -1) << Track()->Keys()[1].text.toStdString();
  QTest::mousePress(Track(), Qt::LeftButton, {}, At(105.0));
  QTest::mouseMove(Track(), At(104.0));
  QTest::mouseMove(Track(), At(103.0));
  QTest::mouseRelease(Track(), Qt::LeftButton, {}, At(103.0));
  EXPECT_EQ(Track()->Keys()[1].run_s, Track()->Keys()[2].run_s);
  EXPECT_NEAR(Track()->Keys()[2].movie_s - Track()->Keys()[1].movie_s, 2.5, 1e-9);
}

TEST_F(MovieTrackTest, AViewFollowsTheKeysAndEscapeEndsThat) {
  AddThree();
  Look("(1, 2, 30)");
  ASSERT_TRUE(Run(QString("app.movie.follow(app.views['%1'])").arg(View))) << errors.toStdString();
  Seek(103.0);
  ASSERT_TRUE(Wait([] { // once the timeline shows the time
    return Number("app.views['viewer:main'].camera.pose_in().position[0]") < 9.0;
  }));
  EXPECT_NEAR(Number("app.views['viewer:main'].camera.pose_in().position[0]"), 2.5, 1e-9);
  window->View(View)->setFocus();
  QTest::keyClick(window->View(View), Qt::Key_Escape);
  EXPECT_NEAR(Number("app.views['viewer:main'].camera.pose_in().position[2]"), 30.0, 1e-9);
  // A preview runs at the movie's speed, moves the timeline, and ends by itself.
  ASSERT_TRUE(Run("app.movie.set_span(0, 0.5); app.movie.set_span(1, 0.5)"));
  ASSERT_TRUE(Run(QString("app.movie.preview(app.views['%1'])").arg(View))) << errors.toStdString();
  const int pictures = window->View(View)->ShownPictures();
  ASSERT_TRUE(Wait([] { return Time() > 104.0; }, 5000));
  ASSERT_TRUE(Wait([] { return Value("app.movie._previewed is None") == "True"; }, 5000));
  EXPECT_GT(window->View(View)->ShownPictures(), pictures + 2);
  EXPECT_NEAR(Number("app.views['viewer:main'].camera.pose_in().position[2]"), 30.0, 1e-9);
  EXPECT_EQ(errors.toStdString(), "");
}

TEST_F(MovieTrackTest, TheDialogExportsWhileTheWindowLives) {
  if (QStandardPaths::findExecutable("ffmpeg").isEmpty()) {
    GTEST_SKIP() << "ffmpeg is not installed";
  }
  AddThree();
  QAction* chosen = nullptr;
  emit window->Movies()->Menu()->aboutToShow();
  for (QAction* action : window->Movies()->Menu()->actions()) {
    chosen = action->text().remove('&') == "Export movie..." ? action : chosen;
  }
  ASSERT_TRUE(chosen && chosen->isEnabled());
  chosen->trigger();
  auto* dialog = window->findChild<ExportDialog*>();
  ASSERT_TRUE(dialog);
  auto* ok = dialog->findChild<QPushButton*>("export");
  ASSERT_TRUE(ok);
  dialog->findChild<QComboBox*>("size")->setCurrentText("65 x 48");
  EXPECT_FALSE(ok->isEnabled()); // H.264 needs even numbers
  dialog->findChild<QComboBox*>("size")->setCurrentText("64 x 48");
  const QString out = folder->filePath("flight.mp4");
  dialog->findChild<QLineEdit*>("path")->setText(out);
  dialog->findChild<QDoubleSpinBox*>("rate")->setValue(5.0);
  dialog->findChild<QSpinBox*>("jobs")->setValue(1);
  ASSERT_TRUE(ok->isEnabled());
  QTest::mouseClick(ok, Qt::LeftButton);
  auto* tasks = window->findChild<dspace::widgets::TaskStrip*>();
  EXPECT_TRUE(Wait([&] { return tasks->Count() == 1; }));
  // The window draws and takes events during the export.
  int beats = 0;
  double longest = 0.0;
  QElapsedTimer clock;
  clock.start();
  QTimer beat;
  QObject::connect(&beat, &QTimer::timeout, window, [&] {
    longest = std::max(longest, 1e-3 * double(clock.restart()));
    ++beats;
  });
  beat.start(10);
  ASSERT_TRUE(Wait([] { return Value("app.exports[-1].state") != "working"; }, 120000));
  EXPECT_EQ(Value("app.exports[-1].state"), "done") << Value("app.exports[-1].failure");
  EXPECT_GT(beats, 5);
  EXPECT_TRUE(QFile::exists(out));
  EXPECT_EQ(tasks->Count(), 0);
  RecordProperty("longest_gap_s", std::to_string(longest));
}
