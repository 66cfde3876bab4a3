// What plug-ins in Python paint over views.
#include "WindowFixture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "OneApplication.h"

#include <dspace/widgets/overlay/PlugInOverlays.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

namespace {

class PlugInOverlaysTest : public WindowFixture {};

} // namespace

TEST_F(PlugInOverlaysTest, FollowTheCamera) {
  ASSERT_TRUE(Run("shown = app.new_view()\n"
                  "shown.camera.look_at(eye=(10, 0, 0), target=(0, 0, 0), up=(0, 0, 1))\n"
                  "over = app.add_overlay(shown)\n"
                  "spot = over.circle(points=(0, 0, 0), radius=6, color='#ff00ff', filled=True)\n"
                  "corner = over.circle(at=(-20, -30), radius=6, color='#00ff00', filled=True)\n"
                  "over.line(at=((10, 10), (60, 10)), color='#ffff00', width=4)\n"
                  "word = over.text('IIII', at=(10, 60), size=40, color='#00ffff')\n"))
      << errors.toStdString();
  ASSERT_TRUE(Settled());
  dspace::widgets::ViewportWidget* view = window->View(Value("shown.name"));
  ASSERT_TRUE(view);
  EXPECT_EQ(Value("view is shown and app.view is shown"), "True"); // the console's own name
  const auto at = [&](int x, int y) { return view->grab().toImage().pixelColor(x, y); };
  const auto has = [&](const QColor& color) {
    const QImage picture = view->grab().toImage();
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        if (picture.pixelColor(x, y) == color) {
          return true;
        }
      }
    }
    return false;
  };
  const QColor magenta(255, 0, 255), green(0, 255, 0);
  EXPECT_EQ(at(view->width() / 2, view->height() / 2), magenta);
  EXPECT_EQ(at(view->width() - 20, view->height() - 30), green);
  EXPECT_EQ(at(35, 10), QColor(255, 255, 0));
  EXPECT_TRUE(has(QColor(0, 255, 255)));
  // 45 degrees are the height: a point 10 m away moves by its tangent. The window may still grow.
  const auto right = [&] { return int(0.2 / std::tan(M_PI / 8) * 0.5 * view->height()); };
  ASSERT_TRUE(Run("spot.set(points=(0, 2, 0)); corner.remove()"));
  EXPECT_NE(at(view->width() / 2, view->height() / 2), magenta);
  EXPECT_EQ(at(view->width() / 2 + right(), view->height() / 2), magenta);
  EXPECT_FALSE(has(green));
  ASSERT_TRUE(Run("shown.camera.look_at(eye=(-10, 0, 0), target=(0, 0, 0), up=(0, 0, 1))"));
  ASSERT_TRUE(Settled());
  EXPECT_EQ(at(view->width() / 2 - right(), view->height() / 2), magenta);
  for (const auto& [line, says] :
       {std::pair("over.text('x')", "one of `at` and `points`"),
        std::pair("over.text('x', at=(1, 2, 3))", "2 finite numbers"),
        std::pair("over.circle(at=(1, 2), color='pinkish')", "a colour is"),
        std::pair("over.circle(at=(1, 2), radius=0)", "0.5 to 10000 pixels"),
        std::pair("over.text('x', at=(1, 2), size=1e9)", "4 to 400 pixels"),
        std::pair("over.line(at=(1, 2))", "2 or more rows of 2"),
        std::pair("word.set(radius=3)", "an argument of a text is 'radius'"),
        std::pair("corner.set(radius=3)", "it is removed"),
        std::pair("over.text(7, at=(1, 2))", "a str"),
        std::pair("spot.set(weight=3)", "an argument of a circle is")}) {
    errors.clear();
    EXPECT_FALSE(Run(line));
    EXPECT_NE(errors.indexOf(says), -1) << line << ": " << errors.toStdString();
  }
  // Numbers of NumPy, and sizes between pixels.
  ASSERT_TRUE(Run("import numpy as np\n"
                  "spot.set(radius=np.float32(3), filled=np.bool_(True)); word.set(size=20.5)\n"
                  "word.set(size=np.int64(20))"))
      << errors.toStdString();
  // Through a lens: r becomes r (1 + k r²) focal lengths of 400 pixels, and the image of 400 x 300
  // is as large as the view holds it.
  EXPECT_TRUE(has(magenta));
  ASSERT_TRUE(Run("shown.lens = dspace.CameraModel('brown', size=(400, 300), focal=(400, 400), "
                  "center=(199.5, 149.5), radial=(0.5, 0, 0))"))
      << errors.toStdString();
  ASSERT_TRUE(Settled());
  const double scale = std::min(view->width() / 400.0, view->height() / 300.0);
  const int moved = int(scale * 400.0 * 0.2 * (1.0 + 0.5 * 0.2 * 0.2));
  EXPECT_EQ(at(view->width() / 2 - moved, view->height() / 2), magenta);
  ASSERT_TRUE(Run("spot.set(points=(0, 6, 0))")); // 0.6 is beside the image
  EXPECT_FALSE(has(magenta));
  ASSERT_TRUE(Run("shown.lens = None"));
  ASSERT_TRUE(Settled());
  ASSERT_TRUE(Run("spot.set(points=(0, 2, 0))"));
  EXPECT_TRUE(has(magenta));
  ASSERT_TRUE(Run("over.close()"));
  EXPECT_FALSE(has(magenta));
  errors.clear();
  EXPECT_FALSE(Run("spot.set(radius=3)"));
  EXPECT_NE(errors.indexOf("it is closed"), -1);
  EXPECT_TRUE(Run("try:\n    over.close()\nexcept dspace.NotFound:\n    pass"));
  ASSERT_TRUE(Run("app.close_view(shown)"));
}

// `view` of the prompt is the view that had the focus last, also in a script that makes it and in
// functions that are called later.
TEST_F(PlugInOverlaysTest, ThePromptHasTheCurrentView) {
  ASSERT_TRUE(Run("first = app.new_view()\nassert view is first\nsecond = app.new_view()\n"
                  "assert view is second\n"
                  "seen = []\nnumber = app.every(0.01, lambda: seen.append(view))\n"))
      << errors.toStdString();
  ASSERT_TRUE(Settled());
  window->View(Value("first.name"))->setFocus();
  EXPECT_TRUE(Wait([] { return Value("view is first and seen[-1] is first") == "True"; }));
  ASSERT_TRUE(Run("app.cancel(number); app.close_view(first); app.close_view(second)"));
  ASSERT_TRUE(Run("view = 3"));
  ASSERT_TRUE(Run("app.new_view()"));
  EXPECT_EQ(Value("view"), "3"); // the user's own
  ASSERT_TRUE(Run("app.close_view(app.view); view = app.view"));
}
