// Views in the window: their bars, maximise, split, pictures, keys, selection, maps in step.
#include "WindowFixture.h"

#include <cmath>

#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QComboBox>
#include <QDockWidget>
#include <QMenu>

#include "OneApplication.h"
#include "vtkDspaceViewport.h"

#include <dspace/scene/Scene.h>
#include <dspace/widgets/console/ConsoleWidget.h>
#include <dspace/widgets/scene/SceneTreeModel.h>
#include <dspace/widgets/scene/SceneTreeView.h>
#include <dspace/widgets/scene/SceneTreeWidget.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/ViewBar.h>
#include <dspace/widgets/window/ViewPanes.h>
#include <dspace/widgets/window/ViewSelection.h>

using dspace::widgets::SceneTreeWidget;
using dspace::widgets::ViewBar;
using dspace::widgets::ViewportWidget;
using dspace::widgets::ViewSelection;

namespace {

// Two boxes before a camera: "left" on the frame "arm", and "right".
class ViewsInWindow : public WindowFixture {
protected:
  void SetUp() override {
    WindowFixture::SetUp();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(window));
    ASSERT_TRUE(Run("arm = scene.add_frame('arm', position=(-2, 0, 0))\n"
                    "left = scene.add_box((1, 1, 1), frame=arm, name='left')\n"
                    "right = scene.add_box((1, 1, 1), position=(2, 0, 0), name='right')\n"
                    "view = app.new_view()\n"
                    "view.camera.look_at(eye=(0, -8, 0), target=(0, 0, 0))\n"))
        << errors.toStdString();
    view = window->View(Value("view.name"));
    ASSERT_TRUE(view);
    ASSERT_TRUE(Settled());
  }
  void TearDown() override {
    window->Selection()->Clear();
    EXPECT_TRUE(Run("for each in list(app.views.values()): app.close_view(each)\n"
                    "[each.remove() for each in reversed(list(scene.cameras.values()))]\n"
                    "arm.remove() if hasattr(arm, 'remove') else None\n"
                    "[each.remove() for each in list(scene.objects.values())]\n"))
        << errors.toStdString();
    QTest::qWait(0);
  }
  static SceneTreeWidget* Tree() { return window->findChild<SceneTreeWidget*>(); }
  static std::string Selected() {
    const auto item = Tree()->Selected();
    const auto& scene = Tree()->Model()->GetScene();
    return item.object != 0                ? scene->Object(item.object).name
           : item.frame == dspace::NoFrame ? ""
                                           : scene->Frames().Path(item.frame);
  }
  // The pixel of the view in which a point of the root lies.
  static QPoint PixelOf(const QString& python) {
    const double x = Number(QString("%1[0]").arg(python));
    const double y = Number(QString("%1[1]").arg(python));
    const double ratio = view->devicePixelRatioF();
    return {int(std::lround((x + 0.5) / ratio)), int(std::lround((y + 0.5) / ratio))};
  }
  static QPoint LeftBox() { return Middle(-2.0); }
  static QPoint RightBox() { return Middle(2.0); }
  static QPoint Middle(double x) { // a camera 8 m away, 45 degrees, half of the picture's height
    const double scale = 0.5 * view->height() / std::tan(0.5 * 45.0 * M_PI / 180.0);
    return {int(std::lround(0.5 * view->width() + scale * x / 7.5)), view->height() / 2};
  }
  static QDockWidget* DockOf(ViewportWidget* widget) {
    return qobject_cast<QDockWidget*>(widget->parentWidget());
  }
  static ViewBar* BarOf(ViewportWidget* widget) {
    return qobject_cast<ViewBar*>(DockOf(widget)->titleBarWidget());
  }
  static void Choose(QMenu* menu, const QString& text) {
    for (QAction* action : menu->actions()) {
      if (action->text() == text) {
        ASSERT_TRUE(action->isEnabled()) << text.toStdString();
        action->trigger();
        return;
      }
    }
    FAIL() << "no entry " << text.toStdString();
  }
  static QString LastLine() { return window->Console()->Script().trimmed().section('\n', -1); }

  inline static ViewportWidget* view = nullptr;
};

} // namespace

TEST_F(ViewsInWindow, AClickSelectsTheRowAndARowIsOutlined) {
  QTest::mouseClick(view, Qt::LeftButton, {}, LeftBox());
  EXPECT_EQ(Selected(), "left");
  EXPECT_TRUE(Wait([] { return window->Selection()->IsOutlined(view); }));
  const QModelIndex row = Tree()->View()->currentIndex();
  EXPECT_EQ(row.data().toString(), "left");
  // The outline is about the box that was clicked, and not about the other.
  const auto orange = [](const QPoint& middle) {
    const QImage picture = view->grab().toImage();
    int count = 0;
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        const QColor color = picture.pixelColor(x, y);
        const bool near =
            std::abs(x / picture.devicePixelRatio() - middle.x()) < view->width() / 6.0;
        count += near && color == QColor(0xff, 0x8c, 0x1a) ? 1 : 0;
      }
    }
    return count;
  };
  EXPECT_GT(orange(LeftBox()), 100);
  EXPECT_EQ(orange(RightBox()), 0);
  // The other way: a row.
  Tree()->Select({dspace::RootFrame, Tree()->Model()->GetScene()->FindObject("right")});
  EXPECT_TRUE(Wait([&] { return orange(RightBox()) > 100; }));
  EXPECT_EQ(orange(LeftBox()), 0);
  // A frame outlines what is on it; the sky selects nothing; a drag selects nothing.
  const dspace::FrameId arm = Tree()->Model()->GetScene()->Frames().Find("arm");
  Tree()->Select({arm, 0});
  EXPECT_TRUE(Wait([&] { return orange(LeftBox()) > 100; }));
  QTest::mousePress(view, Qt::LeftButton, {}, QPoint(5, 5));
  QTest::mouseMove(view, QPoint(25, 5));
  QTest::mouseRelease(view, Qt::LeftButton, {}, QPoint(25, 5));
  EXPECT_EQ(Selected(), "arm");
  QTest::mouseClick(view, Qt::LeftButton, {}, QPoint(5, 5));
  EXPECT_EQ(Selected(), "");
  EXPECT_TRUE(Wait([] { return !window->Selection()->IsOutlined(view); }));
}

TEST_F(ViewsInWindow, TheOutlineIsBesideTheObject) {
  // 8 x 6 pixels with an object of 2 x 2 at (3, 2).
  std::vector<std::uint32_t> labels(48, 7);
  for (const int at : {19, 20, 27, 28}) {
    labels[std::size_t(at)] = 5;
  }
  const QImage outline = ViewSelection::Outline(labels, 8, 6, {5});
  ASSERT_EQ(outline.size(), QSize(8, 6));
  int count = 0;
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) {
      const bool inside = x >= 3 && x < 5 && y >= 2 && y < 4;
      const bool near = x >= 1 && x < 7 && y >= 0 && y < 6;
      EXPECT_EQ(qAlpha(outline.pixel(x, y)), near && !inside ? 255 : 0) << x << " " << y;
      count += qAlpha(outline.pixel(x, y)) ? 1 : 0;
    }
  }
  EXPECT_EQ(count, 32);
  EXPECT_TRUE(ViewSelection::Outline(labels, 8, 6, {9}).isNull());
}

TEST_F(ViewsInWindow, FShowsTheSelectionAndHTheKeys) {
  const auto distance = [] { // from the box on the right
    return Number("float(((view.camera.pose_in().position[0] - 2) ** 2 + "
                  "view.camera.pose_in().position[1] ** 2) ** 0.5)");
  };
  QTest::mouseClick(view, Qt::LeftButton, {}, RightBox());
  ASSERT_EQ(Selected(), "right");
  QTest::keyClick(view, Qt::Key_F);
  EXPECT_EQ(LastLine().toStdString(),
            "app.fit(app.views[\"view 1\"], app.views[\"view 1\"].scene.objects[\"right\"])");
  const double near = distance();
  EXPECT_LT(near, 4.5); // a box of 1 m
  EXPECT_NEAR(Number("view.camera.pose_in().position[0]"), 2.0, 0.2);
  QTest::keyClick(view, Qt::Key_Escape);
  EXPECT_EQ(Selected(), "");
  QTest::keyClick(view, Qt::Key_F); // everything
  EXPECT_EQ(LastLine().toStdString(), "app.fit(app.views[\"view 1\"])");
  EXPECT_NEAR(Number("view.camera.pose_in().position[0]"), 0.0, 0.2);
  EXPECT_FALSE(view->findChild<QWidget*>("keyOverlay"));
  QTest::keyClick(view, Qt::Key_H);
  ASSERT_TRUE(view->findChild<QWidget*>("keyOverlay"));
  EXPECT_TRUE(view->findChild<QWidget*>("keyOverlay")->isVisible());
  QTest::keyClick(view, Qt::Key_Escape);
  EXPECT_FALSE(view->findChild<QWidget*>("keyOverlay"));
  QTest::keyClick(view, Qt::Key_H);
  QTest::keyClick(view, Qt::Key_H);
  EXPECT_FALSE(view->findChild<QWidget*>("keyOverlay"));
}

TEST_F(ViewsInWindow, TheBarsMenusAreLinesOfPython) {
  ViewBar* bar = BarOf(view);
  ASSERT_TRUE(bar);
  Choose(bar->Menu("show"), "Ornaments");
  EXPECT_EQ(LastLine().toStdString(), "app.views[\"view 1\"].ornaments = False");
  EXPECT_EQ(Value("view.ornaments"), "False");
  Choose(bar->Menu("show"), "Ornaments");
  EXPECT_EQ(Value("view.ornaments"), "True");
  Choose(bar->Menu("show"), "Shadows");
  EXPECT_EQ(Value("view.shadows"), "True");
  Choose(bar->Menu("show"), "Corner axes");
  EXPECT_EQ(Value("view.corner_axes"), "True");
  Choose(bar->Menu("show"), "physical");
  EXPECT_EQ(Value("view.hidden_fragments"), "['physical']");
  Choose(bar->Menu("show"), "physical");
  EXPECT_EQ(Value("view.hidden_fragments"), "[]");
  Choose(bar->Menu("style"), "3 x 3");
  EXPECT_EQ(Value("view.samples"), "3");
  Choose(bar->Menu("style"), "Brighter");
  Choose(bar->Menu("style"), "Brighter");
  EXPECT_EQ(Value("view.exposure"), "4.0");
  Choose(bar->Menu("style"), "Filmic tones");
  EXPECT_EQ(Value("view.tone"), "filmic");
  Choose(bar->Menu("style"), "White");
  ASSERT_TRUE(Run("scene.add_camera('mast', eye=(1, -3, 1), target=(0, 0, 0))"));
  Choose(bar->Menu("camera"), "mast");
  EXPECT_EQ(Value("view.camera.name"), "mast");
  QMenu* chase = nullptr;
  for (QAction* action : bar->Menu("camera")->actions()) {
    chase = action->text() == "Chase" ? action->menu() : chase;
  }
  ASSERT_TRUE(chase);
  Choose(chase, "arm");
  EXPECT_EQ(LastLine().toStdString(), "app.chase(app.views[\"view 1\"], \"arm\")");
  EXPECT_EQ(Value("view.camera.pose"), "None");
  EXPECT_EQ(errors.toStdString(), "");
  auto* moves = bar->findChild<QComboBox*>("navigation");
  ASSERT_TRUE(moves);
  ASSERT_TRUE(Run("view.navigation = 'map'"));
  EXPECT_TRUE(Wait([&] {
    view->GetViewport()->Invalidate(); // the next picture
    return moves->currentText() == "map";
  }));
}

TEST_F(ViewsInWindow, AViewIsMaximisedSplitAndCopied) {
  window->resize(1000, 760);
  Choose(BarOf(view)->Menu("window"), "Split right");
  EXPECT_EQ(window->ViewCount(), 2);
  ViewportWidget* second = window->View("view 2");
  ASSERT_TRUE(second && Settled());
  EXPECT_TRUE(Wait([&] { return std::abs(second->width() - view->width()) < 40; }));
  EXPECT_GT(DockOf(second)->x(), DockOf(view)->x());
  const QByteArray before = window->saveState();
  const QSize small = view->size();
  Choose(BarOf(view)->Menu("window"), "Maximise");
  EXPECT_TRUE(window->Panes()->IsMaximized());
  EXPECT_TRUE(Wait([&] { return view->width() > window->width() - 20; }));
  EXPECT_FALSE(second->isVisible());
  EXPECT_FALSE(Tree()->isVisible());
  ASSERT_TRUE(Settled());
  Choose(BarOf(view)->Menu("window"), "Restore");
  EXPECT_TRUE(Wait([&] { return second->isVisible() && Tree()->isVisible(); }));
  EXPECT_TRUE(Wait([&] { return (view->size() - small).width() < 8; }));
  // F11 for the one with the focus; a new view brings the docks back.
  second->setFocus();
  QTest::mouseClick(second, Qt::LeftButton, {}, QPoint(4, 4));
  window->activateWindow();
  QTest::keyClick(window, Qt::Key_F11);
  EXPECT_TRUE(Wait([&] { return !view->isVisible() && second->isVisible(); }));
  QTest::keyClick(window, Qt::Key_F11);
  EXPECT_TRUE(Wait([&] { return view->isVisible(); }));
  // The clipboard has the core's picture, byte for byte.
  Choose(BarOf(view)->Menu("window"), "Copy picture");
  const QImage copied = QApplication::clipboard()->image().convertToFormat(QImage::Format_RGB32);
  const dspace::Capture core = view->GetViewport()->GetCapture({});
  ASSERT_EQ(copied.size(), QSize(core.width, core.height));
  int differ = 0;
  for (int y = 0; y < core.height; ++y) {
    for (int x = 0; x < core.width; ++x) {
      const std::uint8_t* pixel =
          &core.color[4 * (std::size_t(y) * std::size_t(core.width) + std::size_t(x))];
      differ += (copied.pixel(x, y) & 0xffffff) != (qRgb(pixel[0], pixel[1], pixel[2]) & 0xffffff);
    }
  }
  EXPECT_EQ(differ, 0);
  EXPECT_EQ(errors.toStdString(), "");
}

TEST_F(ViewsInWindow, AMapFollowsTheViewAndThePanOfTheMapMovesIt) {
  ASSERT_TRUE(Run("view.camera.look_at(eye=(0, -8, 8), target=(0, 0, 0))"));
  Choose(BarOf(view)->Menu("camera"), "Open a map in step");
  ASSERT_EQ(window->ViewCount(), 2) << errors.toStdString();
  ViewportWidget* map = window->View("view 2");
  ASSERT_TRUE(map && Settled());
  // The view pans, by the mouse: the map's centre follows.
  const double before = Number("app.map_links[0].map.camera.pose_in().position[0]");
  const QPoint from(view->width() / 2, view->height() / 2);
  QTest::mousePress(view, Qt::MiddleButton, {}, from);
  QTest::mouseMove(view, from + QPoint(30, 0));
  QTest::mouseMove(view, from + QPoint(60, 0));
  QTest::mouseRelease(view, Qt::MiddleButton, {}, from + QPoint(60, 0));
  ASSERT_TRUE(Wait([&] {
    return std::abs(Number("app.map_links[0].map.camera.pose_in().position[0]") - before) > 0.1;
  }));
  EXPECT_TRUE(Wait([] {
    return std::abs(Number("app.map_links[0].map.camera.pose_in().position[0] - "
                           "view.camera.pose_in().position[0]")) < 1e-6;
  }));
  ASSERT_TRUE(Settled());
  // The map pans: the view moves by as much.
  const double place = Number("view.camera.pose_in().position[0]");
  const QPoint middle(map->width() / 2, map->height() / 2);
  QTest::mousePress(map, Qt::LeftButton, {}, middle);
  QTest::mouseMove(map, middle + QPoint(-20, 0));
  QTest::mouseMove(map, middle + QPoint(-40, 0));
  QTest::mouseRelease(map, Qt::LeftButton, {}, middle + QPoint(-40, 0));
  EXPECT_TRUE(Wait([&] { return Number("view.camera.pose_in().position[0]") > place + 0.1; }))
      << errors.toStdString();
  ASSERT_TRUE(Settled());
  EXPECT_NEAR(Number("app.map_links[0].map.camera.pose_in().position[0]"),
              Number("view.camera.pose_in().position[0]"), 1e-6);
  EXPECT_EQ(errors.toStdString(), "");
}

TEST_F(ViewsInWindow, TheTreesMenuIsLinesOfPython) {
  using dspace::widgets::SceneAction;
  const auto& scene = Tree()->Model()->GetScene();
  const dspace::FrameId arm = scene->Frames().Find("arm");
  const dspace::ObjectId left = scene->FindObject("left");
  Tree()->Request(SceneAction::Trail, {arm, 0});
  EXPECT_EQ(LastLine(), "app.act(\"trail\", \"arm\")");
  EXPECT_NE(scene->FindObject("trail of arm"), 0U);
  ASSERT_TRUE(window->Run(LastLine())); // once more: it goes
  EXPECT_EQ(scene->FindObject("trail of arm"), 0U);
  Tree()->Request(SceneAction::Axes, {arm, 0});
  EXPECT_EQ(LastLine(), "app.act(\"axes\", \"arm\")");
  EXPECT_NE(scene->FindObject("axes of arm"), 0U);
  ASSERT_TRUE(window->Run(LastLine()));
  Tree()->Request(SceneAction::Hide, {scene->Object(left).frame, left});
  EXPECT_EQ(LastLine(), "app.act(\"hide\", \"arm\", \"left\")");
  EXPECT_FALSE(scene->Object(left).visible);
  ASSERT_TRUE(window->Run(QString("app.act('show', 'arm', %1)").arg(left)));
  EXPECT_TRUE(scene->Object(left).visible);
  EXPECT_FALSE(window->Run("app.act('hide', '/', 'nothing')"));
  EXPECT_FALSE(window->Run("app.act('hide', 'nowhere')"));
  EXPECT_FALSE(window->Run("app.act('melt', 'arm')"));
}
