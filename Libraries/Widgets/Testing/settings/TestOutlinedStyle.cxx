// Controls stand out from what is behind them.
#include <gtest/gtest.h>

#include <algorithm>

#include <QAbstractButton>
#include <QApplication>
#include <QComboBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QPushButton>
#include <QStyle>
#include <QVBoxLayout>
#include <QtTest>

#include <dspace/widgets/settings/OutlinedStyle.h>
#include <dspace/widgets/settings/Theme.h>

#include "OneApplication.h"

using namespace dspace::widgets;

namespace {

class OutlinedStyleTest : public ::testing::TestWithParam<Theme> {
protected:
  void TearDown() override { ApplyTheme(Theme::System); }
};

} // namespace

INSTANTIATE_TEST_SUITE_P(Themes, OutlinedStyleTest, ::testing::Values(Theme::Dark, Theme::Light),
                         [](const auto& info) { return WordOf(info.param).toStdString(); });

// Boxes are seen: what lies at the edge of each stands out from what is inside and outside of it.
TEST_P(OutlinedStyleTest, BoxesHaveEdges) {
  const QPalette palette = PaletteOf(this->GetParam());
  for (const auto ground : {QPalette::Window, QPalette::Base, QPalette::Button}) {
    EXPECT_GE(ContrastOf(OutlineOf(palette, true), palette.color(ground)), 3.0) << ground;
    EXPECT_GE(ContrastOf(OutlineOf(palette, false), palette.color(ground)), 1.5) << ground;
  }
  ApplyTheme(this->GetParam());
  QWidget window;
  auto* layout = new QVBoxLayout(&window);
  auto* choice = new QComboBox;
  choice->addItem("a");
  const QList<QWidget*> boxes{new QLineEdit, new QDoubleSpinBox, choice, new QPushButton("b")};
  for (QWidget* box : boxes) {
    box->setFocusPolicy(Qt::NoFocus);
    layout->addWidget(box);
  }
  window.resize(200, 200);
  window.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&window));
  for (QWidget* box : boxes) {
    const QImage picture = box->grab().toImage();
    const int x = picture.width() / 3;
    double most = 0.0; // near the upper edge
    for (int y = 0; y < 4; ++y) {
      most = std::max(most, ContrastOf(picture.pixelColor(x, y), palette.color(QPalette::Window)));
    }
    EXPECT_GE(most, 3.0) << box->metaObject()->className();
  }
}

// Also of docks that are there when the theme changes.
TEST_P(OutlinedStyleTest, MarksOfTitleBarsHaveTheColourOfTexts) {
  ApplyTheme(this->GetParam() == Theme::Dark ? Theme::Light : Theme::Dark);
  QDockWidget dock;
  ApplyTheme(this->GetParam());
  const QPalette palette = PaletteOf(this->GetParam());
  for (const char* name : {"qt_dockwidget_closebutton", "qt_dockwidget_floatbutton"}) {
    const auto* button = dock.findChild<QAbstractButton*>(name);
    ASSERT_TRUE(button) << name;
    const QImage picture = button->icon().pixmap(32, 32).toImage();
    double most = 0.0;
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        const QColor color = picture.pixelColor(x, y);
        if (color.alpha() == 255) {
          most = std::max(most, ContrastOf(color, palette.color(QPalette::Window)));
        }
      }
    }
    EXPECT_GE(most, 4.5) << name;
  }
}
