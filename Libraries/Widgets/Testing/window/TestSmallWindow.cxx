// A small window keeps its size: it closes docks in a fixed order, or the message names the
// smallest size.
#include <gtest/gtest.h>

#include <QDockWidget>
#include <QLabel>
#include <QMainWindow>
#include <QtTest>

#include "OneApplication.h"

#include <dspace/widgets/window/SmallWindow.h>

using dspace::widgets::KeepSmall;

namespace {

QDockWidget* AddDock(QMainWindow& window, const QString& name, Qt::DockWidgetArea area,
                     const QSize& least) {
  auto* dock = new QDockWidget(name, &window);
  dock->setObjectName(name);
  auto* content = new QWidget(dock);
  content->setMinimumSize(least);
  dock->setWidget(content);
  window.addDockWidget(area, dock);
  return dock;
}

} // namespace

TEST(SmallWindow, ClosesOnlyTheDocksThatLeaveNoRoom) {
  QMainWindow window;
  QDockWidget* view = AddDock(window, "view main", Qt::RightDockWidgetArea, {200, 150});
  QDockWidget* scene = AddDock(window, "scene", Qt::LeftDockWidgetArea, {150, 100});
  QDockWidget* time = AddDock(window, "time", Qt::BottomDockWidgetArea, {250, 60});
  QDockWidget* python = AddDock(window, "console", Qt::BottomDockWidgetArea, {300, 60});
  window.resize(900, 600);
  window.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&window));
  EXPECT_EQ(KeepSmall(window, {800, 500}), "");
  EXPECT_EQ(window.size(), QSize(800, 500));
  EXPECT_FALSE(python->isHidden());
  const QString told = KeepSmall(window, {420, 400});
  EXPECT_EQ(told, "420 x 400 has no room for all docks; closed are console (menu View)");
  EXPECT_TRUE(QTest::qWaitFor([&] { return window.size() == QSize(420, 400); }, 5000));
  EXPECT_TRUE(python->isHidden());
  EXPECT_FALSE(scene->isHidden() || time->isHidden() || view->isHidden());
  // Views stay; the message names the smallest size.
  const QString least = KeepSmall(window, {100, 90});
  EXPECT_NE(least.indexOf("closed are scene, time"), -1) << least.toStdString();
  EXPECT_NE(least.indexOf("the least size of this window is 2"), -1) << least.toStdString();
  EXPECT_FALSE(view->isHidden());
  EXPECT_TRUE(QTest::qWaitFor([&] { return window.width() < 260; }, 5000)) << window.width();
}
