// Telemetry in the application's window: the table of the scene in the docks, plots of live values
// and of whole recordings.
#include "WindowFixture.h"

#include <cmath>

#include <QDockWidget>
#include <QTableView>

#include "OneApplication.h"

#include <dspace/widgets/telemetry/TelemetryModel.h>
#include <dspace/widgets/telemetry/TelemetryPlotWidget.h>
#include <dspace/widgets/telemetry/TelemetryTableWidget.h>
#include <dspace/widgets/timeline/TimelineWidget.h>
#include <dspace/widgets/window/ShownScenes.h>
#include <dspace/widgets/window/TelemetryDocks.h>

using dspace::widgets::TelemetryModel;
using dspace::widgets::TelemetryPlotWidget;
using dspace::widgets::TelemetryTableWidget;

namespace {

// Powers of 2 t for t = 0 to 10 s, by another process.
const char* const Write = R"(
import subprocess, sys, os
assert subprocess.run([sys.executable, "-c", '''
import dspace, sys
with dspace.Session() as session, session.record(sys.argv[1]):
    place = session.scene("place")
    place.telemetry.add("power", unit="W", warning_high=15)
    place.telemetry.add("mode", kind="text")
    camera = place.add_camera(eye=(5, -14, 3), target=(5, 0, 0))
    place.add_viewport((320, 200), camera, name="main")
    for i in range(11):
        place.time = i
        place.telemetry.set({"power": 2.0 * i, "mode": "on"})
''', PATH], env={**os.environ, "PYTHONPATH": sys.path[0]}).returncode == 0
)";

class TelemetryDocksTest : public WindowFixture {
protected:
  static TelemetryTableWidget* Table() { return window->findChild<TelemetryTableWidget*>(); }
  static QString Shown(const QString& channel, TelemetryModel::Column column) {
    Table()->Refresh();
    TelemetryModel* model = Table()->Model();
    const int row = model->RowOf(channel);
    return row < 0 ? QString("none") : model->index(row, column).data().toString();
  }
  static TelemetryPlotWidget* Plot(const QString& python) {
    return window->Telemetry()->Plot(long(Number(python + ".number")));
  }
};

} // namespace

TEST_F(TelemetryDocksTest, LiveValuesAreInTheTableAndInPlots) {
  ASSERT_TRUE(Run("scene.telemetry.add('rover/tilt', unit='deg', warning_high=5)"));
  ASSERT_TRUE(Run("scene.time = 1; scene.telemetry.set({'rover/tilt': 2.5})"));
  EXPECT_EQ(Shown("rover/tilt", TelemetryModel::Value), "2.5");
  EXPECT_EQ(Shown("rover/tilt", TelemetryModel::Unit), "deg");
  // A double click plots the channel, as a line of Python.
  QTableView* view = Table()->View();
  window->Telemetry()->TableDock()->raise();
  ASSERT_TRUE(Wait(
      [&] { return view->isVisible() && view->visualRect(view->model()->index(0, 0)).isValid(); }));
  const QPoint at = view->visualRect(view->model()->index(0, 0)).center();
  QTest::mouseClick(view->viewport(), Qt::LeftButton, Qt::NoModifier, at);
  QTest::mouseDClick(view->viewport(), Qt::LeftButton, Qt::NoModifier, at);
  EXPECT_EQ(Value("sorted(app.plots)"), "[1]");
  TelemetryPlotWidget* plot = window->Telemetry()->Plot(1);
  ASSERT_TRUE(plot);
  EXPECT_EQ(plot->Series(), QStringList{"rover/tilt"});
  for (int i = 2; i < 6; ++i) {
    ASSERT_TRUE(
        Run(QString("scene.time = %1; scene.telemetry.set({'rover/tilt': %1 * 1.5})").arg(i)));
    plot->Refresh();
  }
  EXPECT_EQ(plot->ValueAt("rover/tilt", 3.0), 4.5);
  EXPECT_EQ(plot->ValueAt("rover/tilt", 3.5), 4.5); // values hold
  EXPECT_EQ(plot->ValueAt("rover/tilt", 5.0), 7.5);
  ASSERT_FALSE(Run("app.plot('no/such')"));
  EXPECT_NE(errors.indexOf("no/such"), -1);
  EXPECT_TRUE(Run("scene.telemetry['rover/tilt'].remove()"));
}

TEST_F(TelemetryDocksTest, ARecordingIsPlottedWholeAndFollowsTheTimeline) {
  const QString path = folder->filePath("power.dspace");
  ASSERT_TRUE(Run(QString("PATH = '%1'\n").arg(path) + Write)) << errors.toStdString();
  ASSERT_TRUE(Run("run = app.open(PATH)")) << errors.toStdString();
  ASSERT_TRUE(Run("plot = app.plot('power')")) << errors.toStdString();
  TelemetryPlotWidget* plot = Plot("plot");
  ASSERT_TRUE(plot);
  ASSERT_EQ(plot->Samples("power")->Size(), 11u);
  EXPECT_EQ(plot->ValueAt("power", 7.2), 14.0);
  EXPECT_EQ(plot->Units(), QStringList{"W"});
  // The table has the values of the timeline's moment, and a click moves it.
  ASSERT_TRUE(Run("run.seek(4)"));
  EXPECT_EQ(Shown("power", TelemetryModel::Value), "8");
  EXPECT_TRUE(Wait([&] { return plot->CurrentTime().value_or(-1.0) == 4.0; }, 5000));
  emit plot->timeChosen(9.0);
  EXPECT_TRUE(Wait([&] { return Shown("power", TelemetryModel::Value) == "18"; }, 5000));
  ASSERT_FALSE(Run("app.plot('mode')"));
  EXPECT_NE(errors.indexOf("numbers and choices"), -1);
  errors.clear();
  ASSERT_TRUE(Run("other = app.plot(of=scene, title='live')"));
  EXPECT_TRUE(Run("run.close()")) << errors.toStdString();
  EXPECT_FALSE(Plot("plot")); // it was the recording's
  EXPECT_TRUE(Plot("other"));
}

TEST_F(TelemetryDocksTest, TheFirstPlotGetsAThirdOfTheHeight) {
  ASSERT_TRUE(Run("for each in list(app.plots): app.plots.pop(each)\n"));
  for (int i = 1; i < 10; ++i) {
    if (TelemetryPlotWidget* before = window->Telemetry()->Plot(i)) {
      delete before->parentWidget(); // its dock
    }
  }
  ASSERT_TRUE(Run("app.new_view()"));
  ASSERT_TRUE(Settled());
  ASSERT_TRUE(Run("first = app.plot(of=scene)"));
  EXPECT_TRUE(Wait([&] { return Plot("first")->height() > window->height() / 4; }, 5000))
      << Plot("first")->height();
}
