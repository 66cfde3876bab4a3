// Plug-ins in Python: docks of rows, menu entries, keys, and what goes wrong in them.
#include "WindowFixture.h"

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

TEST_F(PlugInsTest, ReadOutsTell) {
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
  // One a name, texts only, and the colour of the theme that is shown.
  ASSERT_TRUE(Run("app.set_theme('dark')\nvolts = app.add_read_out('bus')\n"
                  "volts.set(state='red')"));
  label = window->findChild<QLabel*>("read-out bus");
  ASSERT_TRUE(Run("app.set_theme('light')"));
  EXPECT_EQ(label->palette().color(QPalette::WindowText),
            AccentOf(dspace::widgets::Accent::Error, PaletteOf(dspace::widgets::Theme::Light)));
  ASSERT_TRUE(Run("app.set_theme('system')"));
  for (const auto& [line, kind] : {std::pair("app.add_read_out('bus')", "AlreadyExists"),
                                   std::pair("volts.set(text=3)", "WrongType"),
                                   std::pair("volts.set(state='blue')", "InvalidArgument")}) {
    EXPECT_TRUE(Run(QString("try:\n    %1\nexcept dspace.%2:\n    pass").arg(line, kind)))
        << errors.toStdString();
    errors.clear();
    EXPECT_FALSE(Run(line));
  }
  ASSERT_TRUE(Run("volts.close()"));
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
