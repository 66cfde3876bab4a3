// The application's window: it opens files, runs Python, shows views that Python makes, and says
// what fails.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include <QDockWidget>
#include <QFile>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QTemporaryDir>
#include <QTimer>
#include <QToolButton>
#include <QtTest>

#include "OneApplication.h"
#include "ShippedFiles.h"
#include "vtkDspaceViewport.h"

#include <dspace/widgets/console/ConsoleWidget.h>
#include <dspace/widgets/console/PythonInterpreter.h>
#include <dspace/widgets/scene/SceneTreeView.h>
#include <dspace/widgets/scene/SceneTreeWidget.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/MainWindow.h>

using dspace::widgets::MainWindow;
using dspace::widgets::ViewportWidget;

namespace {

// One window for all cases: a process has one interpreter of Python.
class MainWindowTest : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    QStandardPaths::setTestModeEnabled(true); // not the user's settings
    window = new MainWindow(QStringLiteral(DSPACE_PACKAGES));
    window->resize(900, 600);
    window->show();
    QObject::connect(window->Interpreter(), &dspace::widgets::PythonInterpreter::written, window,
                     [](const QString& text, bool error) { (error ? errors : printed) += text; });
  }
  static void TearDownTestSuite() {
    delete window;
    window = nullptr;
  }
  void SetUp() override {
    printed.clear();
    errors.clear();
  }
  static bool Settled() {
    return QTest::qWaitFor([] { return window->IsSettled(); }, 20000);
  }
  // Types a line at the prompt.
  static void Type(const QString& line) {
    auto* edit = window->Console()->findChild<QLineEdit*>();
    edit->setFocus();
    QTest::keyClicks(edit, line);
    QTest::keyClick(edit, Qt::Key_Return);
  }

  static MainWindow* window;
  static QString printed;
  static QString errors;
};

MainWindow* MainWindowTest::window = nullptr;
QString MainWindowTest::printed;
QString MainWindowTest::errors;

} // namespace

TEST_F(MainWindowTest, OpensAModelInAViewOfItsOwn) {
  ASSERT_TRUE(window->Open(ShippedData() + "/rover/rover.urdf")) << errors.toStdString();
  EXPECT_EQ(window->ViewCount(), 1);
  ViewportWidget* view = window->View("view 1");
  ASSERT_TRUE(view);
  ASSERT_TRUE(Settled());
  EXPECT_EQ(window->focusWidget(), view); // its keys work at once
  // The tree of the scene has it.
  auto* tree = window->findChild<dspace::widgets::SceneTreeWidget*>();
  ASSERT_TRUE(tree);
  tree->Refresh();
  const QAbstractItemModel* model = tree->View()->model();
  const QModelIndex root = model->index(0, 0);
  bool found = false;
  for (int row = 0; row < model->rowCount(root); ++row) {
    found = found || model->index(row, 0, root).data().toString() == "dspace_rover";
  }
  EXPECT_TRUE(found);
  // The rover fills the middle of the picture.
  const QColor middle = view->grab().toImage().pixelColor(view->width() / 2, view->height() / 2);
  EXPECT_GT(middle.red() + middle.green() + middle.blue(), 30);
}

TEST_F(MainWindowTest, SaysWhatCannotBeOpened) {
  const int views = window->ViewCount();
  EXPECT_FALSE(window->Open("/nowhere/at all.glb"));
  EXPECT_TRUE(errors.contains("there is no such file")) << errors.toStdString();
  QTemporaryDir folder;
  QFile odd(folder.filePath("odd.qqq"));
  ASSERT_TRUE(odd.open(QIODevice::WriteOnly));
  odd.close();
  EXPECT_FALSE(window->Open(odd.fileName()));
  EXPECT_TRUE(errors.contains("its name says no format")) << errors.toStdString();
  EXPECT_EQ(window->ViewCount(), views);
}

TEST_F(MainWindowTest, ThePromptRunsCompletesAndRecalls) {
  Type("print(1 + 2)");
  EXPECT_EQ(printed, "3\n");
  Type("for i in range(2):");
  Type("    print('row', i)");
  Type("");
  EXPECT_EQ(printed, "3\nrow 0\nrow 1\n");
  Type("nothing_of_this_name");
  EXPECT_TRUE(errors.contains("NameError")) << errors.toStdString();
  auto* edit = window->Console()->findChild<QLineEdit*>();
  QTest::keyClick(edit, Qt::Key_Up);
  EXPECT_EQ(edit->text(), "nothing_of_this_name");
  QTest::keyClick(edit, Qt::Key_Down);
  EXPECT_EQ(edit->text(), "");
  QTest::keyClicks(edit, "scene.add_poly");
  QTest::keyClick(edit, Qt::Key_Tab);
  EXPECT_TRUE(edit->text().startsWith("scene.add_polydata")) << edit->text().toStdString();
  edit->clear();
  EXPECT_TRUE(window->Console()->Script().contains("print(1 + 2)\n"));
  // Lines that raised are comments of a script, typed ones and those of menus.
  EXPECT_TRUE(window->Console()->Script().contains("\n# failed: nothing_of_this_name\n"));
  EXPECT_FALSE(window->Run("app.open('/nowhere.glb')"));
  EXPECT_TRUE(window->Console()->Script().endsWith("\n# failed: app.open('/nowhere.glb')\n"));
}

TEST_F(MainWindowTest, PythonMakesViewsThatFloatAndClose) {
  const int views = window->ViewCount();
  ASSERT_TRUE(window->Run("second = app.new_view()")) << errors.toStdString();
  EXPECT_EQ(window->ViewCount(), views + 1);
  ASSERT_TRUE(QTest::qWaitFor([] { return window->View("view 2")->ShownPictures() > 0; }, 20000));
  ASSERT_TRUE(Settled());
  ASSERT_TRUE(window->Run("assert second.size != (640, 400), second.size")) << errors.toStdString();
  ASSERT_TRUE(window->Run("second.samples = 1"));
  for (QDockWidget* dock : window->findChildren<QDockWidget*>()) {
    if (dock->objectName().startsWith("view")) {
      dock->setFloating(true);
      ASSERT_TRUE(Settled());
      dock->setFloating(false);
      ASSERT_TRUE(Settled());
    }
  }
  ASSERT_TRUE(window->Run("app.close_view(second)")) << errors.toStdString();
  EXPECT_EQ(window->ViewCount(), views);
}

TEST_F(MainWindowTest, TimersAndKeysCallPython) {
  ASSERT_TRUE(
      window->Run("ticks, keys = [], []\nnumber = app.every(0.01, lambda: ticks.append(1))"));
  ASSERT_TRUE(QTest::qWaitFor(
      [] {
        printed.clear();
        window->Interpreter()->Run("print(len(ticks) > 3)");
        return printed == "True\n";
      },
      5000));
  ASSERT_TRUE(window->Run("app.cancel(number)"));
  if (!window->View("view 1")) {
    ASSERT_TRUE(window->Run("app.new_view()"));
  }
  ASSERT_TRUE(Settled());
  ASSERT_TRUE(window->Run("app.views['view 1'].on_key(lambda given: keys.append(given.key))"));
  QTest::keyClick(window->View("view 1"), Qt::Key_G);
  printed.clear();
  window->Interpreter()->Run("print(keys)");
  EXPECT_EQ(printed, "['g']\n") << errors.toStdString();
  // A function that raises says so once.
  errors.clear();
  ASSERT_TRUE(window->Run("app.every(0.01, lambda: 1 / 0)"));
  QTest::qWait(200);
  EXPECT_EQ(errors.count("ZeroDivisionError"), 1) << errors.toStdString();
}

TEST_F(MainWindowTest, AScriptThatLoopsLetsTheWindowLiveAndIsInterrupted) {
  auto* button = window->Console()->findChild<QToolButton*>("interrupt");
  ASSERT_TRUE(button);
  EXPECT_FALSE(button->isEnabled());
  int ticks = 0;
  QTimer ticking;
  QObject::connect(&ticking, &QTimer::timeout, &ticking, [&ticks] { ++ticks; });
  ticking.start(20);
  QTimer pressing;
  QObject::connect(&pressing, &QTimer::timeout, &pressing, [&] {
    if (ticks > 10 && button->isEnabled()) {
      QTest::mouseClick(button, Qt::LeftButton);
      pressing.stop();
    }
  });
  pressing.start(20);
  EXPECT_FALSE(window->Run("loops = 0\nwhile True:\n    loops += 1"));
  EXPECT_NE(errors.indexOf("KeyboardInterrupt"), -1) << errors.toStdString();
  EXPECT_GT(ticks, 10);
  EXPECT_FALSE(button->isEnabled());
  EXPECT_FALSE(window->Interpreter()->IsBusy());
  // A second one, from within which a menu's line runs.
  QTimer::singleShot(500, window, [] { window->Run("inside = loops"); });
  QTimer::singleShot(900, window, [] { dspace::widgets::PythonInterpreter::Interrupt(); });
  EXPECT_FALSE(window->Run("while True:\n    loops += 1"));
  EXPECT_TRUE(window->Run("assert 0 < inside < loops"));
}

TEST_F(MainWindowTest, AScriptMayDrawWithASessionOfItsOwn) {
  ASSERT_TRUE(
      window->Run("view = app.new_view()\nscene.add_box((1, 1, 1), name='own box')\nview.fit()"))
      << errors.toStdString();
  ASSERT_TRUE(Settled());
  const char* const script = R"(
import dspace
with dspace.Session() as other:
    place = other.scene()
    place.add_sphere(1.0)
    picture = place.add_viewport((64, 48), place.add_camera(eye=(4, 0, 1), target=(0, 0, 0))).image()
    print('drawn', picture.shape, int(picture.max()) > 100)
    kept = dspace.Session()   # stays with its context
    still = kept.scene().add_viewport((32, 32), kept.scene().add_camera(eye=(4, 0, 1), target=(0, 0, 0)))
    still.image()
)";
  for (int round = 0; round < 3; ++round) {
    printed.clear();
    ASSERT_TRUE(window->Run(script)) << errors.toStdString();
    EXPECT_NE(printed.indexOf("drawn (48, 64, 3) True"), -1) << printed.toStdString();
    // The window's views go on, and a picture of the same scene can be read.
    ASSERT_TRUE(window->Run("view.camera.look_at(eye=(3, 2, 1), target=(0, 0, 0))\n"
                            "print('own', int(view.image().max()))"))
        << errors.toStdString();
    ASSERT_TRUE(Settled());
    ViewportWidget* widget = window->View("view 1") ? window->View("view 1") : nullptr;
    if (widget) {
      widget->repaint();
      EXPECT_FALSE(widget->grab().isNull());
    }
  }
  EXPECT_TRUE(window->Open(ShippedData() + "/field/field.tif")) << errors.toStdString();
  EXPECT_TRUE(Settled());
}
