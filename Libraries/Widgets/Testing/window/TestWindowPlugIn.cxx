// Plug-ins in C++: the example's docks, entries, keys, overlay and read-out; and libraries that are
// none.
#include "WindowFixture.h"

#include <QAction>
#include <QDockWidget>
#include <QFile>
#include <QLabel>
#include <QPushButton>

#include "OneApplication.h"

#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/MainWindow.h>

using namespace dspace::widgets;

class WindowPlugInTest : public WindowFixture {
protected:
  // Pixels of the cross-hair's colour in the middle of a view.
  static int CrossPixels(const QWidget* view) {
    const QImage image = const_cast<QWidget*>(view)->grab().toImage();
    int count = 0;
    for (int y = image.height() / 2 - 24; y < image.height() / 2 + 24; ++y) {
      for (int x = image.width() / 2 - 24; x < image.width() / 2 + 24; ++x) {
        const QColor color = image.pixelColor(x, y);
        count += color.red() > 200 && color.green() > 160 && color.blue() < 150 ? 1 : 0;
      }
    }
    return count;
  }
};

TEST_F(WindowPlugInTest, TheExampleAddsWhatItSays) {
  ASSERT_TRUE(Run("first = app.new_view()")) << errors.toStdString();
  ASSERT_TRUE(Settled());
  EXPECT_EQ(CrossPixels(window->View("view 1")), 0);
  window->LoadPlugIns({DSPACE_TEST_PLUG_IN});
  EXPECT_EQ(errors.toStdString(), "");
  auto* dock = window->findChild<QDockWidget*>("plug-in Sun clock");
  ASSERT_TRUE(dock);
  QTest::mouseClick(dock->findChild<QPushButton*>(), Qt::LeftButton);
  EXPECT_NEAR(Number("scene.sun.elevation_deg if hasattr(scene.sun, 'elevation_deg') else 80"),
              80.0, 1e-6);
  EXPECT_GT(CrossPixels(window->View("view 1")), 30);
  // A view that comes later has the overlay, too; the key hides it.
  ASSERT_TRUE(Run("second = app.new_view()"));
  ASSERT_TRUE(Settled());
  EXPECT_GT(CrossPixels(window->View("view 2")), 30);
  window->activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(window));
  QTest::keyClick(window, Qt::Key_F8);
  QTest::qWait(50);
  EXPECT_EQ(CrossPixels(window->View("view 2")), 0);
  QTest::keyClick(window, Qt::Key_F8);
  const int views = window->ViewCount();
  QTest::keyClick(window, Qt::Key_N, Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_EQ(window->ViewCount(), views + 1);
  ASSERT_TRUE(Run("scene.time = 12.5"));
  auto* readOut = window->findChild<QLabel*>("read-out scene time");
  ASSERT_TRUE(readOut);
  EXPECT_TRUE(Wait([&] { return readOut->text() == "scene time 12.5 s"; }, 3000))
      << readOut->text().toStdString();
  // A second load finds its keys taken, and leaves nothing behind.
  const auto docks = window->findChildren<QDockWidget*>().size();
  EXPECT_FALSE(Run("app.load_plugin(r'" DSPACE_TEST_PLUG_IN "')"));
  EXPECT_NE(errors.indexOf("accepted: a free one"), -1) << errors.toStdString();
  EXPECT_EQ(window->findChildren<QDockWidget*>().size(), docks);
}

TEST_F(WindowPlugInTest, WhatIsNoPlugInIsRejected) {
  EXPECT_FALSE(Run("app.load_plugin('/nowhere/x.so')"));
  EXPECT_NE(errors.indexOf("there is no such file"), -1) << errors.toStdString();
  const QString path = folder->filePath("text.so");
  QFile file(path);
  ASSERT_TRUE(file.open(QIODevice::WriteOnly));
  file.write("no library");
  file.close();
  errors.clear();
  EXPECT_FALSE(Run("app.load_plugin('" + path + "')"));
  EXPECT_NE(errors.indexOf("text.so"), -1) << errors.toStdString();
  errors.clear();
  EXPECT_FALSE(Run("app.load_plugin(r'" DSPACE_TEST_NO_PLUG_IN "')")); // another library
  EXPECT_NE(errors.indexOf("DSPACE_WINDOW_PLUG_IN"), -1) << errors.toStdString();
  EXPECT_EQ(Value("1 + 1"), "2");
}
