// The Terrain dock of the application's window: what is changed there is in the scene and in its
// pictures.
#include "WindowFixture.h"

#include <QComboBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QMenu>
#include <QMenuBar>

#include "OneApplication.h"
#include "OpenedFiles.h"

#include <dspace/widgets/console/ConsoleWidget.h>
#include <dspace/widgets/desktop/NoticeBar.h>
#include <dspace/widgets/terrain/LayerList.h>
#include <dspace/widgets/terrain/RampLegend.h>
#include <dspace/widgets/terrain/StyleEditor.h>
#include <dspace/widgets/terrain/TerrainWidget.h>
#include <dspace/widgets/window/Shell.h>

using dspace::widgets::TerrainWidget;

namespace {

// The shipped field in one grey, with its picture as a layer, from above.
class TerrainInWindow : public WindowFixture {
protected:
  void SetUp() override {
    WindowFixture::SetUp();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(window));
    ASSERT_TRUE(Run(
        QString("import numpy as np\n"
                "field = r'%1/Data/field/'\n"
                "ground = scene.add_terrain(field + 'field.tif', name='ground', mode='clipmap',\n"
                "                           color=(0.5, 0.5, 0.5), lit=False)\n"
                "photo = ground.add_image(field + 'field_color.tif', name='photo')\n"
                "view = scene.add_viewport((160, 120), scene.add_camera(eye=(0, 0, 60), "
                "target=(0, 0, 0), up=(0, 1, 0)), name='above')\n"
                "app.show(view)\n")
            .arg(DSPACE_SOURCES)))
        << errors.toStdString();
    Dock()->hide();
    ASSERT_TRUE(Run("app.show_dock('terrain')")) << errors.toStdString();
    ASSERT_TRUE(Wait([] { return Widget()->isVisible() && Widget()->Terrain() == "ground"; }));
    ASSERT_TRUE(Settled());
  }
  void TearDown() override {
    EXPECT_TRUE(Run("app.close_view(view)\n"
                    "ground.remove()\n"
                    "[each.remove() for each in list(scene.cameras.values())]\n"))
        << errors.toStdString();
    QTest::qWait(0);
  }
  static QDockWidget* Dock() { return window->findChild<QDockWidget*>("terrain"); }
  static TerrainWidget* Widget() { return window->Terrain(); }
  static QDoubleSpinBox* Box(const QString& name) {
    return Widget()->Style()->findChild<QDoubleSpinBox*>(name);
  }
  static void Enter(const QString& name, const QString& text) {
    Box(name)->selectAll();
    QTest::keyClicks(Box(name), text);
    QTest::keyClick(Box(name), Qt::Key_Return);
    QTest::qWait(0);
  }
  static std::string LastLine() {
    return window->Console()->Script().trimmed().section('\n', -1).toStdString();
  }
  // How much the colours of the picture differ within a pixel: 0 for greys.
  static double Colourful() {
    return Number("float(np.ptp(view.image().astype(float), axis=2).mean())");
  }
};

} // namespace

TEST_F(TerrainInWindow, ALayerThatIsSwitchedOffIsGoneFromThePicture) {
  const double before = Colourful();
  EXPECT_GT(before, 5.0);
  auto* layers = Widget()->Layers();
  layers->Select("photo");
  layers->setFocus();
  QTest::keyClick(layers, Qt::Key_Space);
  EXPECT_EQ(LastLine(), "app.scene.terrains[\"ground\"].layer(\"photo\").visible = False");
  EXPECT_EQ(Value("photo.visible"), "False");
  EXPECT_LT(Colourful(), 1.0);
  ASSERT_TRUE(Wait([&] { return layers->topLevelItem(0)->checkState(0) == Qt::Unchecked; }));
  QTest::keyClick(layers, Qt::Key_Space);
  EXPECT_EQ(Value("photo.visible"), "True");
  EXPECT_NEAR(Colourful(), before, 0.5);
}

TEST_F(TerrainInWindow, AStyleReachesTheSceneAndTheLegendHasItsLimits) {
  Run("ground.set_style(contours=dict(interval=2.0, width=3, color='red'))");
  auto* by = Widget()->Style()->findChild<QComboBox*>("ramp");
  ASSERT_TRUE(Wait([&] { return by->currentIndex() == 0; }));
  QTest::keyClick(by, Qt::Key_Down);
  ASSERT_EQ(Value("ground.style['color_by']"), "height") << errors.toStdString();
  const auto& entries = Widget()->Legend()->Entries();
  ASSERT_TRUE(Wait([&] { return entries.size() == 1; }));
  EXPECT_EQ(entries[0].title, "Height [m]");
  EXPECT_DOUBLE_EQ(entries[0].low, Number("ground.style['range'][0]"));
  EXPECT_DOUBLE_EQ(entries[0].high, Number("ground.style['range'][1]"));
  EXPECT_EQ(int(entries[0].colors.size()), int(Number("len(ground.style['colors'])")));
  const double high = entries[0].high;
  Enter("low", "-0.5");
  EXPECT_EQ(Number("ground.style['range'][0]"), -0.5);
  EXPECT_EQ(Number("ground.style['range'][1]"), high); // exactly
  EXPECT_TRUE(Wait([&] { return entries[0].low == -0.5; }));
  // The width of the contours is not in the dock, and stays.
  ASSERT_TRUE(Wait([&] { return Box("contours interval")->value() == 2.0; }));
  Enter("contours interval", "4");
  EXPECT_EQ(Value("[(g.contours.interval, g.contours.width) for g in [scene._ask("
                  "'describe_terrain_style', terrain='ground', viewport='').terrain_style.given]]"),
            "[(4.0, 3.0)]");
}

TEST_F(TerrainInWindow, ABadNumberIsRefusedWithItsMessage) {
  Run("ground.set_style(color_by='height', range=(0, 10))");
  ASSERT_TRUE(Wait([] { return Box("high")->value() == 10.0; }));
  Enter("low", "10"); // both ends are the same
  EXPECT_EQ(Value("ground.style['range']"), "(0.0, 10.0)");
  const QString last = window->Desktop()->Notices()->Text();
  EXPECT_TRUE(last.contains("ground") && last.contains("10")) << last.toStdString();
  EXPECT_TRUE(Wait([] { return Box("low")->value() == 0.0; })); // as it is
}

TEST_F(TerrainInWindow, TheDockOpensNoFileAndViewHasIt) {
  const OpenedFiles opened;
  for (int i = 0; i < 5; ++i) {
    Widget()->Refresh();
  }
  EXPECT_TRUE(opened.Below(DSPACE_SOURCES "/Data").empty());
  bool listed = false;
  for (const QAction* menu : window->menuBar()->actions()) {
    listed = listed || menu->menu()->actions().contains(Dock()->toggleViewAction());
  }
  EXPECT_TRUE(listed);
  EXPECT_FALSE(Run("app.show_dock('nothing')"));
  EXPECT_TRUE(errors.contains("there are: console, measure, messages,")) << errors.toStdString();
}

TEST_F(TerrainInWindow, ARecordingIsShownAndNotChanged) {
  const QString path = folder->filePath("ground.dspace");
  ASSERT_TRUE(Run(QString("with dspace.Session() as other, other.record(r'%1'):\n"
                          "    place = other.scene('place')\n"
                          "    there = place.add_terrain(field + 'field.tif', name='recorded', "
                          "mode='clipmap')\n"
                          "    there.set_style(color_by='slope', range=(1, 12))\n"
                          "    place.add_viewport((160, 120), place.add_camera(eye=(0, 0, 60), "
                          "target=(0, 0, 0), up=(0, 1, 0)), name='main')\n"
                          "    place.time = 1.0\n"
                          "run = app.open(r'%1')\n"
                          "run.seek(1.0)\n")
                      .arg(path)))
      << errors.toStdString();
  ASSERT_TRUE(Wait([] { return Widget()->Terrain() == "recorded"; })) << errors.toStdString();
  const auto& entries = Widget()->Legend()->Entries();
  ASSERT_TRUE(Wait([&] { return entries.size() == 1 && entries[0].title == "Slope [deg]"; }));
  EXPECT_EQ(entries[0].low, 1.0);
  EXPECT_EQ(entries[0].high, 12.0);
  EXPECT_FALSE(Widget()->Style()->findChild<QComboBox*>("ramp")->isEnabled());
  ASSERT_TRUE(Run("run.close()")) << errors.toStdString();
  EXPECT_TRUE(Wait([] { return Widget()->Terrain() == "ground"; }));
}
