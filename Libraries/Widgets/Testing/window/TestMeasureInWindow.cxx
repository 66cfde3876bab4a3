// Clicks in a view measure: the dock has the results, and the view the marks.
#include "WindowFixture.h"

#include <QDockWidget>

#include "OneApplication.h"

#include <dspace/widgets/console/ConsoleWidget.h>
#include <dspace/widgets/measure/MeasureWidget.h>
#include <dspace/widgets/measure/ProfileChart.h>
#include <dspace/widgets/scene/SceneTreeModel.h>
#include <dspace/widgets/scene/SceneTreeView.h>
#include <dspace/widgets/scene/SceneTreeWidget.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

using dspace::widgets::MeasureWidget;
using dspace::widgets::ViewportWidget;

namespace {

// A level ground of 20 x 20 m from above, north up; a pixel is known by the orthographic camera.
class MeasureInWindow : public WindowFixture {
protected:
  void SetUp() override {
    WindowFixture::SetUp();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(window));
    ASSERT_TRUE(Run("import numpy as np\n"
                    "slab = scene.add_box((20, 20, 0.5), name='slab', position=(0, 0, -0.25))\n"
                    "view = app.new_view()\n"
                    "view.camera.set_projection(height=10)\n"
                    "view.camera.look_at(eye=(0, 0, 30), target=(0, 0, 0), up=(0, 1, 0))\n"))
        << errors.toStdString();
    ASSERT_TRUE(Run("app.show_dock('measure')")) << errors.toStdString();
    ASSERT_TRUE(Settled());
    view = window->View(Value("view.name"));
    ASSERT_TRUE(view);
  }
  void TearDown() override {
    Widget()->Use("");
    EXPECT_TRUE(Run("for each in list(app.views.values()): app.close_view(each)\n"
                    "[each.remove() for each in reversed(list(scene.cameras.values()))]\n"
                    "slab.remove()\n"))
        << errors.toStdString();
    QTest::qWait(0);
  }
  static MeasureWidget* Widget() { return window->Measure(); }
  // Of a place [m] right of and above the middle: the view is 10 m high.
  static QPoint At(double x, double y) {
    const double scale = view->height() / 10.0;
    return QPointF(0.5 * view->width() + x * scale, 0.5 * view->height() - y * scale).toPoint();
  }
  static double Tolerance() { return 2.0 * 10.0 / view->height(); } // two pixels
  // How many pixels have the colour of the marks.
  static int Marked() {
    const QImage picture = view->grab().toImage();
    int count = 0;
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        const QColor color = picture.pixelColor(x, y);
        count += color.red() > 230 && color.green() > 180 && color.blue() < 110 ? 1 : 0;
      }
    }
    return count;
  }

  inline static ViewportWidget* view = nullptr;
};

} // namespace

TEST_F(MeasureInWindow, ClicksMeasureALineAndMarkIt) {
  EXPECT_EQ(Marked(), 0);
  Widget()->Use("line");
  QTest::mouseClick(view, Qt::LeftButton, {}, At(-2, -1));
  QTest::mouseClick(view, Qt::LeftButton, {}, At(2, 2));
  ASSERT_EQ(Widget()->Points().size(), 2u) << errors.toStdString();
  EXPECT_TRUE(window->Console()->Script().trimmed().section('\n', -1).startsWith(
      "app.measure(\"line\", ["));
  EXPECT_NEAR(Number("app.measured.length"), 5.0, 2 * Tolerance());
  EXPECT_TRUE(Widget()->Text().startsWith("Straight length\t"));
  EXPECT_GT(Marked(), view->height() / 3); // a line of 5 m of 10
  // The marks follow the camera: half as long from twice as high.
  const int before = Marked();
  ASSERT_TRUE(Run("view.camera.set_projection(height=20)")) << errors.toStdString();
  ASSERT_TRUE(Settled());
  EXPECT_LT(Marked(), 0.75 * before);
  // Nothing is selected meanwhile, and Escape ends it.
  EXPECT_EQ(Value("len(scene.frames)"), "0");
  QTest::keyClick(view, Qt::Key_Escape);
  EXPECT_EQ(Widget()->Used(), "");
  EXPECT_FALSE(Widget()->Text().isEmpty());
}

TEST_F(MeasureInWindow, AnAreaAndAnAngleAreMeasured) {
  Widget()->Use("area");
  for (const auto& [x, y] : {std::pair(-2.0, -2.0), std::pair(2.0, -2.0), std::pair(2.0, 1.0)}) {
    QTest::mouseClick(view, Qt::LeftButton, {}, At(x, y));
  }
  EXPECT_NEAR(Number("app.measured.area"), 6.0, 8 * Tolerance()) << errors.toStdString();
  EXPECT_TRUE(Widget()->IsClosed());
  Widget()->Use("angle");
  for (const auto& [x, y] : {std::pair(3.0, 0.0), std::pair(0.0, 0.0), std::pair(0.0, 3.0)}) {
    QTest::mouseClick(view, Qt::LeftButton, {}, At(x, y));
  }
  EXPECT_NEAR(Number("app.measured"), 90.0, 3.0) << errors.toStdString();
  QTest::mouseClick(view, Qt::LeftButton, {}, QPoint(2, 2)); // beside the slab, or a new angle
}

// The origins of rows of the scene: 3 m to the right and 4 m up from one frame to the other.
TEST_F(MeasureInWindow, RowsOfTheSceneArePoints) {
  ASSERT_TRUE(Run("a = scene.add_frame('a', position=(1, 1, 0))\n"
                  "b = scene.add_frame('b', position=(4, 5, 0))\n"
                  "crate = scene.add_box((1, 1, 1), name='crate', frame=b, position=(0, -4, 0))\n"))
      << errors.toStdString();
  auto* tree = window->findChild<dspace::widgets::SceneTreeWidget*>();
  ASSERT_TRUE(tree);
  tree->Refresh();
  const auto scene = tree->Model()->GetScene();
  const auto click = [&](const char* path, dspace::ObjectId object = 0) {
    tree->Select({scene->Frames().Find(path), object}); // scrolls to it
    const QModelIndex index = tree->Model()->IndexOf(tree->Selected());
    const QRect place = tree->View()->visualRect(index);
    QTest::mouseClick(tree->View()->viewport(), Qt::LeftButton, {}, place.center());
  };
  const auto before = Widget()->Points(); // of an earlier test
  click("a");
  EXPECT_EQ(Widget()->Points(), before); // no tool is used
  Widget()->Use("line");
  click("a"); // which is selected already
  EXPECT_EQ(Widget()->Points().size(), 1u);
  tree->Select({scene->Frames().Find("b"), 0});
  QTest::keyClick(tree->View(), Qt::Key_Up);
  EXPECT_EQ(Widget()->Points().size(), 1u); // a row that the selection passes is no point
  click("b");
  EXPECT_EQ(Widget()->Points().size(), 2u);
  ASSERT_TRUE(Settled());
  EXPECT_NEAR(Number("app.measured.length"), 5.0, 1e-12) << errors.toStdString();
  Widget()->Use("angle"); // the right angle at the crate, at (4, 1)
  click("a");
  click("b", scene->FindObject("crate"));
  click("b");
  ASSERT_TRUE(Settled());
  EXPECT_NEAR(Number("app.measured"), 90.0, 1e-9);
  Widget()->Use("");
  tree->Select({});
  ASSERT_TRUE(Run("crate.remove(); b.remove(); a.remove()"));
}

TEST_F(MeasureInWindow, OnTerrainTheDockHasAProfile) {
  ASSERT_TRUE(Run(
      QString(
          "ground = scene.add_terrain(r'%1/Data/field/field.tif', name='ground', mode='clipmap')\n"
          "slab.visible = False\n"
          "view.camera.look_at(eye=(0, 0, 60), target=(0, 0, 0), up=(0, 1, 0))\n")
          .arg(DSPACE_SOURCES)))
      << errors.toStdString();
  ASSERT_TRUE(Settled());
  Widget()->Use("line");
  QTest::mouseClick(view, Qt::LeftButton, {}, At(-3, 0));
  QTest::mouseClick(view, Qt::LeftButton, {}, At(3, 0));
  ASSERT_EQ(Value("app.measured.terrain"), "ground") << errors.toStdString();
  EXPECT_NEAR(Number("app.measured.distance"), 6.0, 4 * Tolerance());
  EXPECT_GT(Widget()->Chart()->SampleCount(), 1000);
  EXPECT_TRUE(Widget()->Text().contains("Leg 1: azimuth\t"));
  const QString path = folder->filePath("profile.csv");
  emit Widget()->saveWanted(path);
  EXPECT_EQ(Value(QString("open(r'%1').readline().strip()").arg(path)),
            "distance_m,height_m,slope_deg,map_x,map_y");
  // Points of Python's, and what cannot be measured.
  EXPECT_TRUE(Run("app.measure('line', [(0, 0, 0), (1, 1, 0)], terrain='ground')"));
  EXPECT_EQ(Widget()->Points().size(), 2u);
  EXPECT_FALSE(Run("app.measure('line', [(0, 0, 0)])"));
  EXPECT_FALSE(Run("app.measure('volume', [(0, 0, 0), (1, 0, 0)])"));
  EXPECT_TRUE(Run("ground.remove()\nslab.visible = True")) << errors.toStdString();
}
