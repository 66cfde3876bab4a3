// What the status bar shows of the point under the pointer.
#include "WindowFixture.h"

#include <cmath>
#include <utility>

#include <dspace/proto/commands.pb.h>
#include <dspace/widgets/overlay/PointerReadout.h>
#include <dspace/widgets/settings/DisplayUnits.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

using dspace::widgets::PointerReadout;
using dspace::widgets::ViewportWidget;

namespace {

class PointerReadoutTest : public WindowFixture {
protected:
  void TearDown() override {
    EXPECT_TRUE(Run("for each in list(app.views.values()): app.close_view(each)\n"
                    "[each.remove() for each in list(scene.objects.values())]\n"))
        << errors.toStdString();
    QTest::qWait(0);
  }
  // A view 10 m above the origin, looking down, with +X to the right.
  static ViewportWidget* View() {
    EXPECT_TRUE(QTest::qWaitForWindowExposed(window));
    EXPECT_TRUE(Run("view = app.new_view()\n"
                    "view.camera.look_at(eye=(0, 0, 10), target=(0, 0, 0), up=(0, 1, 0))\n"))
        << errors.toStdString();
    ViewportWidget* view = window->View(Value("view.name"));
    QSize last; // the docks move into their places
    EXPECT_TRUE(Wait([&] {
      QTest::qWait(200);
      return view && std::exchange(last, view->size()) == view->size();
    }));
    EXPECT_TRUE(Settled());
    return view;
  }
  static QString Text() { return window->findChild<PointerReadout*>()->text(); }
  static void MoveTo(ViewportWidget* view, const QPoint& place) {
    QMouseEvent move(QEvent::MouseMove, place, view->mapToGlobal(QPointF(place)), Qt::NoButton,
                     Qt::NoButton, Qt::NoModifier);
    QApplication::sendEvent(view, &move);
  }
  static double After(const QString& text, const QString& word) {
    const QRegularExpression end(QString("[ ,%1]").arg(QChar(0xb0)));
    return text.section(word, 1).trimmed().section(end, 0, 0).toDouble();
  }
};

} // namespace

TEST_F(PointerReadoutTest, ShowsTheObjectAndItsPlace) {
  ASSERT_TRUE(Run("scene.add_box((1, 1, 1), position=(2, 0, 0), name='crate')"));
  ViewportWidget* view = View();
  ASSERT_TRUE(view);
  // Pixels a metre at the top of the box, 9.5 m away: 45 degrees are the height of the picture.
  const double scale = 0.5 * view->height() / std::tan(M_PI / 8) / 9.5;
  MoveTo(view, {int(view->width() / 2 + 2.0 * scale), view->height() / 2});
  ASSERT_TRUE(Wait([] { return Text().startsWith("crate "); })) << Text().toStdString();
  EXPECT_NEAR(After(Text(), " x "), 2.0, 0.05); // two pixels
  EXPECT_NEAR(After(Text(), " y "), 0.0, 0.05);
  EXPECT_NEAR(After(Text(), " z "), 0.5, 1e-3);
  // Beside it there is nothing, and outside of the view nothing is shown.
  MoveTo(view, {4, 4});
  EXPECT_TRUE(Wait([] { return Text().isEmpty(); })) << Text().toStdString();
  MoveTo(view, {int(view->width() / 2 + 2.0 * scale), view->height() / 2});
  ASSERT_TRUE(Wait([] { return !Text().isEmpty(); }));
  QEvent leave(QEvent::Leave);
  QApplication::sendEvent(view, &leave);
  EXPECT_TRUE(Text().isEmpty());
}

// In a scene that changes all the time, and under a pointer that does not move.
TEST_F(PointerReadoutTest, FollowsWhatMovesUnderThePointer) {
  ASSERT_TRUE(Run("lift = scene.add_frame('lift')\n"
                  "scene.add_box((4, 4, 1), frame=lift, name='crate')\n"));
  ViewportWidget* view = View();
  ASSERT_TRUE(view);
  int steps = 0;
  QTimer timer;
  QObject::connect(&timer, &QTimer::timeout, [&] {
    window->Interpreter()->Run(QString("lift.pose = dspace.Pose((0, 0, %1))").arg(0.002 * ++steps));
  });
  timer.start(2);
  MoveTo(view, {view->width() / 2, view->height() / 2});
  ASSERT_TRUE(Wait([] { return Text().startsWith("crate "); })) << Text().toStdString();
  const double before = After(Text(), " z ");
  EXPECT_TRUE(Wait([&] { return After(Text(), " z ") > before + 0.05; })) << Text().toStdString();
  EXPECT_LE(After(Text(), " z "), 0.5 + 0.002 * steps + 1e-3);
  timer.stop();
  EXPECT_TRUE(Wait([&] { return std::abs(After(Text(), " z ") - 0.5 - 0.002 * steps) < 2e-3; }))
      << Text().toStdString(); // millimetres
  ASSERT_TRUE(Run("[each.remove() for each in list(scene.objects.values())]; lift.remove()"));
}

TEST_F(PointerReadoutTest, ShowsWhatTerrainKnows) {
  // A plane that rises by 0.1 m a metre to the east.
  ASSERT_TRUE(
      Run(QString("import os\n"
                  "path = os.path.join(r'%1', 'slope.asc')\n"
                  "open(path, 'w').write('ncols 41\\nnrows 41\\nxllcorner 1000\\n"
                  "yllcorner 2000\\ncellsize 1\\n' + '\\n'.join(' '.join("
                  "str(0.1 * x) for x in range(41)) for y in range(41)))\n"
                  "ground = scene.add_terrain(path, name='ground', origin=(1020.5, 2020.5))\n")
              .arg(folder->path())))
      << errors.toStdString();
  ViewportWidget* view = View();
  ASSERT_TRUE(view);
  MoveTo(view, {view->width() / 2, view->height() / 2});
  ASSERT_TRUE(Wait([] { return Text().contains("slope"); })) << Text().toStdString();
  EXPECT_NEAR(After(Text(), "slope"), std::atan(0.1) * 180.0 / M_PI, 0.05); // one decimal
  const QString map = Text().section("map ", 1);
  EXPECT_NEAR(map.section(',', 0, 0).toDouble(), 1020.5, 0.05);
  EXPECT_NEAR(map.section(',', 1).trimmed().section(' ', 0, 0).toDouble(), 2020.5, 0.05);
  EXPECT_NEAR(After(Text(), "height"), 2.0, 0.01);
  EXPECT_FALSE(Text().contains(QChar(0xb0) + QString(" E"))); // a raster without a CRS
  ASSERT_TRUE(Run("ground.remove()"));
}

TEST(PointerReadout, WritesLongitudesToTheSideThatTheyAreOn) {
  dspace::v1::Reply reply;
  auto* pick = reply.mutable_pick();
  pick->set_object(3);
  pick->set_object_name("Gale");
  pick->set_terrain("gale");
  pick->mutable_map()->set_z(-4501.25);
  pick->mutable_coordinates()->set_longitude_deg(137.4416);
  pick->mutable_coordinates()->set_latitude_deg(-4.5895);
  const QString text = PointerReadout::TextOf(reply.SerializeAsString(), {});
  EXPECT_TRUE(text.contains(QString("137.441600%1 E  4.589500%1 S").arg(QChar(0xb0))))
      << text.toStdString();
  EXPECT_TRUE(text.contains("height -4501.250 m")) << text.toStdString();
  EXPECT_EQ(PointerReadout::TextOf({}, {}), "");
}

TEST(PointerReadout, WritesTheUnitsThatThePreferencesChoose) {
  dspace::v1::Reply reply;
  auto* pick = reply.mutable_pick();
  pick->set_object(3);
  pick->set_object_name("Gale");
  pick->mutable_in_root()->set_x(1234.5678);
  auto& units = dspace::widgets::DisplayUnits::The();
  using dspace::widgets::UnitChoice;
  EXPECT_TRUE(
      PointerReadout::TextOf(reply.SerializeAsString(), {}).contains("x 1234.568  y 0.000"));
  units.Set({UnitChoice::Length::Kilometre, UnitChoice::Angle::Radian});
  EXPECT_TRUE(PointerReadout::TextOf(reply.SerializeAsString(), {})
                  .contains("x 1.234568  y 0.000000  z 0.000000 km"));
  pick->set_terrain("gale");
  pick->mutable_map()->set_z(-4501.25);
  pick->mutable_coordinates()->set_longitude_deg(-180.0);
  dspace::v1::Reply slope;
  slope.mutable_terrain_values()->add_slope_deg(90.0);
  const QString text = PointerReadout::TextOf(reply.SerializeAsString(), slope.SerializeAsString());
  units.Set({});
  EXPECT_TRUE(text.contains("3.14159265 rad W")) << text.toStdString();
  EXPECT_TRUE(text.contains("height -4.501250 km")) << text.toStdString();
  EXPECT_TRUE(text.contains("slope 1.571 rad")) << text.toStdString();
  // Coordinates from the body's centre where they are chosen, or all are wanted.
  pick->mutable_coordinates()->mutable_body_fixed()->set_x(3396190.5);
  const auto told = [&](bool all) {
    return PointerReadout::TextOf(reply.SerializeAsString(), {}, all);
  };
  EXPECT_FALSE(told(false).contains("body-fixed"));
  EXPECT_TRUE(told(true).contains("body-fixed x 3396190.500  y 0.000"));
  EXPECT_FALSE(told(true).contains("J2000")); // of no known body
  pick->mutable_coordinates()->mutable_inertial()->set_y(-1e6);
  EXPECT_TRUE(told(true).contains("J2000 x 0.000  y -1000000.000  z 0.000 m"));
  units.Set({UnitChoice::Length::Metre, UnitChoice::Angle::Degree, true, false});
  EXPECT_TRUE(told(false).contains("body-fixed x 3396190.500"));
  EXPECT_FALSE(told(false).contains("J2000"));
  units.Set({});
}
