// A right click on an object in a view opens its menu: copy its coordinates, send it as a goal.
#include "WindowFixture.h"

#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QMenu>
#include <QPointer>

#include "OneApplication.h"

#include <dspace/widgets/console/ConsoleWidget.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

using dspace::widgets::ViewportWidget;

namespace {

// A box of 2 m about the root, seen from the south.
class ViewMenuTest : public WindowFixture {
protected:
  void SetUp() override {
    WindowFixture::SetUp();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(window));
    ASSERT_TRUE(Run("box = scene.add_box((2, 2, 2), name='box')\n"
                    "view = app.new_view()\n"
                    "view.camera.look_at(eye=(0, -8, 0), target=(0, 0, 0))\n"
                    "if 'heard' not in globals():\n"
                    "    session.on_event(lambda event: heard.append(event.dragged), 'dragged')\n"
                    "heard = []\n"))
        << errors.toStdString();
    ASSERT_TRUE(Settled());
    view = window->View(Value("view.name"));
    ASSERT_TRUE(view);
  }
  void TearDown() override {
    EXPECT_TRUE(Run("for each in list(app.views.values()): app.close_view(each)\n"
                    "[each.remove() for each in reversed(list(scene.cameras.values()))]\n"
                    "box.remove()\n"))
        << errors.toStdString();
    QTest::qWait(0);
  }
  static QMenu* Menu() { return view->findChild<QMenu*>("view menu"); }
  static void Choose(const QString& text) {
    ASSERT_TRUE(Menu());
    for (QAction* action : Menu()->actions()) {
      if (action->text().remove('&') == text) {
        ASSERT_TRUE(action->isEnabled());
        action->trigger();
      }
    }
    QPointer<QMenu> menu = Menu();
    menu->close();
    EXPECT_TRUE(Wait([&] { return menu.isNull(); }));
  }

  inline static ViewportWidget* view = nullptr;
};

} // namespace

TEST_F(ViewMenuTest, TheClickedPointIsSentAsAGoal) {
  QTest::mouseClick(view, Qt::RightButton, {}, view->rect().center());
  Choose("Send as goal");
  EXPECT_TRUE(window->Console()->Script().trimmed().section('\n', -1).startsWith("app.send_goal("));
  ASSERT_EQ(Value("len(heard)"), "1");
  EXPECT_EQ(Value("heard[0].scene, heard[0].goal, heard[0].done"), "scene goal True");
  EXPECT_NEAR(Number("heard[0].pose.position.x"), 0.0, 0.05);
  EXPECT_NEAR(Number("heard[0].pose.position.y"), -1.0, 0.001);
  QTest::mouseClick(view, Qt::RightButton, {}, view->rect().center());
  Choose("Copy coordinates");
  EXPECT_TRUE(QApplication::clipboard()->text().startsWith("box   "));
}

TEST_F(ViewMenuTest, TheBackgroundOtherButtonsAndDragsHaveNone) {
  QTest::mouseClick(view, Qt::RightButton, {}, QPoint(4, 4));
  EXPECT_FALSE(Menu());
  QTest::mouseClick(view, Qt::MiddleButton, {}, view->rect().center());
  EXPECT_FALSE(Menu());
  const QPoint from = view->rect().center();
  QTest::mousePress(view, Qt::RightButton, {}, from);
  QTest::mouseMove(view, from + QPoint(0, 30));
  QTest::mouseMove(view, from + QPoint(0, 60));
  QTest::mouseRelease(view, Qt::RightButton, {}, from + QPoint(0, 60));
  EXPECT_FALSE(Menu());
}

TEST_F(ViewMenuTest, ARecordingHearsNoGoal) {
  ASSERT_TRUE(Run(QString("with dspace.Session() as other, other.record(r'%1'):\n"
                          "    place = other.scene('place')\n"
                          "    place.add_box((2, 2, 2), name='crate')\n"
                          "    place.add_viewport((160, 120), place.add_camera(eye=(0, -8, 0), "
                          "target=(0, 0, 0)), name='main')\n"
                          "    place.time = 1.0\n"
                          "run = app.open(r'%1')\n"
                          "run.seek(1.0)\n")
                      .arg(folder->filePath("crate.dspace"))))
      << errors.toStdString();
  ASSERT_TRUE(Wait([] { return window->View("viewer:main") != nullptr; }));
  ASSERT_TRUE(Settled());
  ViewportWidget* recorded = window->View("viewer:main");
  QMenu* menu = nullptr;
  EXPECT_TRUE(Wait([&] { // the recording may be between two steps
    QTest::mouseClick(recorded, Qt::RightButton, {}, recorded->rect().center());
    menu = recorded->findChild<QMenu*>("view menu");
    return menu != nullptr;
  }));
  ASSERT_TRUE(menu);
  ASSERT_EQ(menu->actions().size(), 2);
  EXPECT_TRUE(menu->actions()[0]->isEnabled());
  EXPECT_FALSE(menu->actions()[1]->isEnabled());
  menu->close();
  ASSERT_TRUE(Run("run.close()")) << errors.toStdString();
}
