// Plug-ins in Python: docks of rows, menu entries, keys, and what goes wrong in them.
#include "WindowFixture.h"

#include <cmath>
#include <utility>

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QFile>
#include <QLabel>
#include <QMenuBar>
#include <QPushButton>
#include <QTableWidget>

#include "OneApplication.h"

#include <dspace/widgets/panel/PanelWidget.h>
#include <dspace/widgets/settings/Theme.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/PlugIns.h>

using dspace::widgets::PanelWidget;

namespace {

class PlugInsTest : public WindowFixture {
protected:
  static PanelWidget* Panel(const QString& python) {
    return window->Extensions()->Panel(int(Number(python + "._number")));
  }
  static QAction* Action(const QString& text) {
    for (QAction* action : window->findChildren<QAction*>()) {
      if (action->text().remove('&') == text) {
        return action;
      }
    }
    return nullptr;
  }
};

} // namespace

TEST_F(PlugInsTest, ControlsCallFunctionsAndFunctionsChangeRows) {
  ASSERT_TRUE(Run("seen = []\ndock = app.add_dock('Tools', area='left')\n"
                  "go = dock.button('Go', lambda: seen.append('go'))\n"
                  "speed = dock.slider('Speed', 0, 2, 0.5, seen.append, unit='m/s')\n"
                  "mode = dock.choice('Mode', ('slow', 'fast'), function=seen.append)\n"
                  "safe = dock.check('Safe', True, seen.append)\n"
                  "tilt = dock.read_out('Tilt')\n"
                  "log = dock.table(('time', 'event'))\n"))
      << errors.toStdString();
  PanelWidget* panel = Panel("dock");
  ASSERT_TRUE(panel);
  ASSERT_EQ(panel->RowCount(), 6);
  QTest::mouseClick(panel->Control(0), Qt::LeftButton);
  qobject_cast<QDoubleSpinBox*>(panel->Control(1))->setValue(1.25);
  qobject_cast<QComboBox*>(panel->Control(2))->setCurrentText("fast");
  qobject_cast<QCheckBox*>(panel->Control(3))->click();
  EXPECT_EQ(Value("seen"), "['go', 1.25, 'fast', False]");
  EXPECT_EQ(Value("(speed.value, mode.value, safe.value)"), "(1.25, 'fast', False)");
  ASSERT_TRUE(Run("tilt.set(text='9.1 deg', state='red'); log.set(append=['3', 'stop']); "
                  "speed.set(value=2)"));
  auto* label = qobject_cast<QLabel*>(panel->Control(4));
  EXPECT_TRUE(label->text().endsWith("9.1 deg"));
  EXPECT_EQ(label->accessibleDescription(), "red");
  auto* table = qobject_cast<QTableWidget*>(panel->Control(5));
  ASSERT_EQ(table->rowCount(), 1);
  EXPECT_EQ(table->item(0, 1)->text(), "stop");
  EXPECT_EQ(qobject_cast<QDoubleSpinBox*>(panel->Control(1))->value(), 2.0);
  EXPECT_EQ(Number("len(seen)"), 4); // what Python sets is no event
  ASSERT_TRUE(Run("dock.close()"));
  EXPECT_FALSE(Panel("dock"));
  EXPECT_FALSE(Run("tilt.set(text='1')"));
  EXPECT_NE(errors.indexOf("it is closed"), -1);
}

TEST_F(PlugInsTest, MenusAndKeysCallFunctions) {
  ASSERT_TRUE(
      Run("told = []\napp.add_action('&Mission', 'Ce&ntre', lambda: told.append(1), key='F8')\n"
          "app.on_key('Ctrl+Shift+D', lambda: told.append(2))"));
  ASSERT_TRUE(Action("Centre"));
  Action("Centre")->trigger();
  window->activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(window));
  QTest::keyClick(window, Qt::Key_D, Qt::ControlModifier | Qt::ShiftModifier);
  QTest::keyClick(window, Qt::Key_F8);
  EXPECT_EQ(Value("told"), "[1, 2, 1]");
  EXPECT_FALSE(Run("app.on_key('Ctrl+N', print)"));
  EXPECT_NE(errors.indexOf("'New view'"), -1);
  errors.clear();
  EXPECT_FALSE(Run("app.on_key('Nonsense', print)"));
  EXPECT_NE(errors.indexOf("accepted"), -1);
  errors.clear();
  EXPECT_FALSE(Run("app.add_dock('Tools', area='middle')"));
  EXPECT_NE(errors.indexOf("left, right, top, bottom"), -1);
}

TEST_F(PlugInsTest, APlugInThatRaisesIsReportedAndTheWindowLives) {
  ASSERT_TRUE(Run("bad = app.add_dock('Bad')\nbad.button('Break', lambda: 1 / 0)"));
  QTest::mouseClick(Panel("bad")->Control(0), Qt::LeftButton);
  EXPECT_NE(errors.indexOf("ZeroDivisionError"), -1);
  EXPECT_EQ(Value("1 + 1"), "2");
  const QString path = folder->filePath("broken.py");
  QFile file(path);
  ASSERT_TRUE(file.open(QIODevice::WriteOnly));
  file.write("def plugin(app):\n    raise ValueError('no camera')\n");
  file.close();
  errors.clear();
  window->LoadPlugIns({path, "no_such_plug_in"});
  EXPECT_NE(errors.indexOf("no camera"), -1);
  EXPECT_NE(errors.indexOf("no_such_plug_in"), -1);
  ASSERT_TRUE(Run("bad.close()"));
}

TEST_F(PlugInsTest, OverlaysFollowTheCameraAndReadOutsTell) {
  ASSERT_TRUE(Run("shown = app.new_view()\n"
                  "shown.camera.look_at(eye=(10, 0, 0), target=(0, 0, 0), up=(0, 0, 1))\n"
                  "over = app.add_overlay(shown)\n"
                  "spot = over.circle(points=(0, 0, 0), radius=6, color='#ff00ff', filled=True)\n"
                  "corner = over.circle(at=(-20, -30), radius=6, color='#00ff00', filled=True)\n"
                  "over.line(at=((10, 10), (60, 10)), color='#ffff00', width=4)\n"
                  "word = over.text('IIII', at=(10, 60), size=40, color='#00ffff')\n"))
      << errors.toStdString();
  ASSERT_TRUE(Settled());
  dspace::widgets::ViewportWidget* view = window->View(Value("shown.name"));
  ASSERT_TRUE(view);
  EXPECT_EQ(Value("view is shown and app.view is shown"), "True"); // the console's own name
  const auto at = [&](int x, int y) { return view->grab().toImage().pixelColor(x, y); };
  const auto has = [&](const QColor& color) {
    const QImage picture = view->grab().toImage();
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        if (picture.pixelColor(x, y) == color) {
          return true;
        }
      }
    }
    return false;
  };
  const QColor magenta(255, 0, 255), green(0, 255, 0);
  EXPECT_EQ(at(view->width() / 2, view->height() / 2), magenta);
  EXPECT_EQ(at(view->width() - 20, view->height() - 30), green);
  EXPECT_EQ(at(35, 10), QColor(255, 255, 0));
  EXPECT_TRUE(has(QColor(0, 255, 255)));
  // 45 degrees are the height: a point 10 m away moves by its tangent.
  ASSERT_TRUE(Run("spot.set(points=(0, 2, 0)); corner.remove()"));
  const int right = int(0.2 / std::tan(M_PI / 8) * 0.5 * view->height());
  EXPECT_NE(at(view->width() / 2, view->height() / 2), magenta);
  EXPECT_EQ(at(view->width() / 2 + right, view->height() / 2), magenta);
  EXPECT_FALSE(has(green));
  ASSERT_TRUE(Run("shown.camera.look_at(eye=(-10, 0, 0), target=(0, 0, 0), up=(0, 0, 1))"));
  ASSERT_TRUE(Settled());
  EXPECT_EQ(at(view->width() / 2 - right, view->height() / 2), magenta);
  for (const auto& [line, says] :
       {std::pair("over.text('x')", "one of `at` and `points`"),
        std::pair("over.text('x', at=(1, 2, 3))", "2 finite numbers"),
        std::pair("over.circle(at=(1, 2), color='pinkish')", "a colour is"),
        std::pair("over.circle(at=(1, 2), radius=0)", "more than 0"),
        std::pair("corner.set(radius=3)", "it is removed"),
        std::pair("over.text(7, at=(1, 2))", "a str"),
        std::pair("spot.set(weight=3)", "an argument is")}) {
    errors.clear();
    EXPECT_FALSE(Run(line));
    EXPECT_NE(errors.indexOf(says), -1) << line << ": " << errors.toStdString();
  }
  ASSERT_TRUE(Run("over.close()"));
  EXPECT_FALSE(has(magenta));
  errors.clear();
  EXPECT_FALSE(Run("spot.set(radius=3)"));
  EXPECT_NE(errors.indexOf("it is closed"), -1);

  ASSERT_TRUE(Run("volts = app.add_read_out('bus', '28.1 V')"));
  auto* label = window->findChild<QLabel*>("read-out bus");
  ASSERT_TRUE(label);
  EXPECT_EQ(label->text(), "bus 28.1 V");
  ASSERT_TRUE(Run("volts.set(text='22.0 V', state='red')"));
  EXPECT_EQ(label->text(), "bus 22.0 V");
  EXPECT_EQ(label->palette().color(QPalette::WindowText),
            AccentOf(dspace::widgets::Accent::Error, window->palette()));
  EXPECT_FALSE(Run("volts.set(state='blue')"));
  ASSERT_TRUE(Run("volts.close()"));
  EXPECT_FALSE(window->findChild<QLabel*>("read-out bus"));
  errors.clear();
  EXPECT_FALSE(Run("volts.set(text='1')"));
  EXPECT_NE(errors.indexOf("it is closed"), -1);
  ASSERT_TRUE(Run("app.close_view(shown)"));
}

TEST_F(PlugInsTest, TheExampleBuildsAConsoleOfThreeDocks) {
  window->LoadPlugIns(
      {QStringLiteral(DSPACE_SOURCES) + "/Examples/mission_console/mission_console.py"});
  EXPECT_EQ(errors.toStdString(), "");
  ASSERT_TRUE(Run("scene.telemetry.add('rover/tilt', unit='deg'); "
                  "scene.telemetry.set({'rover/tilt': 6.0}); app.console.update()"));
  EXPECT_TRUE(Run("app.console.send()"));
  EXPECT_EQ(Value("scene.events()[-1].text"), "drive at 0.040 m/s, guarded");
  int docks = 0;
  for (const QDockWidget* dock : window->findChildren<QDockWidget*>()) {
    docks += dock->objectName().startsWith("plug-in ") ? 1 : 0;
  }
  EXPECT_EQ(docks, 3);
  EXPECT_TRUE(Action("Reset the check list"));
}
