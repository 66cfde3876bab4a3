// Windows for a long time: views that open and close a hundred times, docks that float and close in
// odd orders, storms of resizing, two windows on one scene.
#include "WindowFixture.h"

#include <fstream>
#include <random>

#include <dirent.h>
#include <malloc.h>

#include <QDockWidget>
#include <QMainWindow>

#include "OneApplication.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceSession.h"
#include "vtkDspaceViewport.h"

#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/ShownScenes.h>

using namespace dspace::widgets;

namespace {

double ResidentMegabytes() {
  malloc_trim(0);
  long pages = 0;
  long resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return 4096e-6 * double(resident);
}

int Descriptors() {
  int count = 0;
  DIR* folder = opendir("/proc/self/fd");
  while (readdir(folder)) {
    ++count;
  }
  closedir(folder);
  return count;
}

// Pixels of the widget that differ from the core's picture; -1: another size.
int Differing(ViewportWidget* widget) {
  const QImage grabbed = widget->grab().toImage().convertToFormat(QImage::Format_RGBX8888);
  vtkDspaceViewport* viewport = widget->GetViewport();
  const auto wanted = viewport->GetPicture();
  if (grabbed.width() != viewport->GetWidth() || grabbed.height() != viewport->GetHeight()) {
    return -1;
  }
  int differing = 0;
  for (int y = 0; y < grabbed.height(); ++y) {
    const std::uint8_t* row = grabbed.constScanLine(y);
    for (int x = 0; x < grabbed.width(); ++x) {
      const std::uint8_t* pixel = &wanted[4 * (std::size_t(y) * grabbed.width() + x)];
      differing += std::equal(pixel, pixel + 3, row + 4 * x) ? 0 : 1;
    }
  }
  return differing;
}

class EnduranceTest : public WindowFixture {
protected:
  static QDockWidget* Dock(const QString& view) {
    return window->findChild<QDockWidget*>("view " + view);
  }
};

} // namespace

TEST_F(EnduranceTest, AHundredViewsOpenAndCloseWithFlatMemory) {
  ASSERT_TRUE(Run("scene.add_sphere(1.0)\nkept = app.new_view(name='kept')\nkept.fit()"));
  ASSERT_TRUE(Settled());
  const auto cycle = [&] {
    ASSERT_TRUE(Run("made = app.new_view(name='passing')")) << errors.toStdString();
    ASSERT_TRUE(Wait([] { return window->View("passing")->ShownPictures() > 0; }));
    ASSERT_TRUE(Run("app.close_view(made)")) << errors.toStdString();
  };
  for (int i = 0; i < 15; ++i) { // caches fill
    cycle();
  }
  const double memory = ResidentMegabytes();
  const int descriptors = Descriptors();
  const std::string cameras = Value("len(scene.cameras)");
  for (int i = 0; i < 100; ++i) {
    cycle();
  }
  EXPECT_LT(ResidentMegabytes() - memory, 12.0) << memory; // 0.12 MB a view: a picture has 3 MB
  EXPECT_LE(Descriptors(), descriptors);
  EXPECT_EQ(Value("len(scene.cameras)"), cameras);
  EXPECT_EQ(Value("sorted(app.views)"), "['kept']");
  ASSERT_TRUE(Settled());
  EXPECT_EQ(Differing(window->View("kept")), 0);
}

TEST_F(EnduranceTest, DocksFloatAndCloseInOddOrders) {
  ASSERT_TRUE(Run("odd = [app.new_view(name=f'odd {i}') for i in range(5)]"))
      << errors.toStdString();
  ASSERT_TRUE(Settled());
  std::mt19937 random(7);
  for (int i = 0; i < 60; ++i) {
    QDockWidget* dock = Dock(QString("odd %1").arg(random() % 5));
    ASSERT_TRUE(dock);
    switch (random() % 5) {
    case 0:
      dock->setFloating(!dock->isFloating());
      break;
    case 1:
      dock->hide();
      break;
    case 2:
      dock->show();
      break;
    case 3:
      window->addDockWidget(Qt::DockWidgetArea(1 << (random() % 4)), dock);
      break;
    default:
      window->tabifyDockWidget(Dock("kept") ? Dock("kept") : Dock("odd 0"), dock);
    }
    QTest::qWait(int(random() % 25));
  }
  for (int i = 0; i < 5; ++i) { // floating, hidden, in tabs
    ASSERT_TRUE(Run(QString("app.close_view(odd[%1])").arg((i * 3) % 5))) << errors.toStdString();
    QTest::qWait(5);
  }
  ASSERT_TRUE(Run("after = app.new_view(name='after')\nafter.fit()"));
  ASSERT_TRUE(Settled());
  EXPECT_EQ(Differing(window->View("after")), 0);
  ASSERT_TRUE(Run("app.close_view(after)"));
}

TEST_F(EnduranceTest, StormsOfResizingEndInTheRightPicture) {
  ASSERT_TRUE(Run("storm = app.new_view(name='storm')\nstorm.fit()"));
  ASSERT_TRUE(Settled());
  Dock("storm")->setFloating(true);
  std::mt19937 random(3);
  for (int i = 0; i < 150; ++i) {
    Dock("storm")->resize(120 + int(random() % 900), 90 + int(random() % 600));
    if (i % 7 == 0) {
      window->resize(600 + int(random() % 500), 500 + int(random() % 300));
    }
    QCoreApplication::processEvents();
  }
  window->resize(1000, 760);
  Dock("storm")->resize(411, 333);
  ASSERT_TRUE(Settled());
  ASSERT_TRUE(Wait([] { return window->View("storm")->IsUpToDate(); }));
  EXPECT_EQ(Differing(window->View("storm")), 0);
  ASSERT_TRUE(Run("app.close_view(storm)"));
}

TEST_F(EnduranceTest, TwoWindowsShowOneScene) {
  ASSERT_TRUE(Run("here = app.new_view(name='here')\nhere.fit()\n"
                  "there = scene.add_viewport((320, 240), here.camera, name='there')"))
      << errors.toStdString();
  auto* session = vtkDspaceSession::SafeDownCast(window->Scenes()->ActiveScene().first);
  ASSERT_TRUE(session);
  const auto meshes = session->GetRenderContext()->GetStatistics().meshBytes;
  {
    QMainWindow other;
    auto* widget = new ViewportWidget(session->GetViewport("there"));
    other.setCentralWidget(widget);
    other.resize(360, 280);
    other.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&other));
    ASSERT_TRUE(Wait([&] { return widget->IsUpToDate() && widget->ShownPictures() > 0; }));
    const int before = widget->ShownPictures();
    ASSERT_TRUE(Run("scene.add_box((0.5, 0.5, 3.0))")); // is seen in both
    ASSERT_TRUE(Wait([&] { return widget->ShownPictures() > before; }));
    ASSERT_TRUE(Settled());
    EXPECT_EQ(Differing(widget), 0);
    EXPECT_EQ(Differing(window->View("here")), 0);
    EXPECT_LT(session->GetRenderContext()->GetStatistics().meshBytes - meshes, 100000u);
  } // the other window closes first
  ASSERT_TRUE(Run("scene.add_box((3.0, 0.5, 0.5))"));
  ASSERT_TRUE(Settled());
  EXPECT_EQ(Differing(window->View("here")), 0);
}
