// Themes: texts stand out from what is behind them, and widgets that are there follow.
#include <gtest/gtest.h>

#include <utility>

#include <QApplication>
#include <QLabel>
#include <QStyle>
#include <QtTest>

#include <dspace/widgets/settings/OutlinedStyle.h>
#include <dspace/widgets/settings/Theme.h>
#include <dspace/widgets/telemetry/PlotPicture.h>

#include "OneApplication.h"

using namespace dspace::widgets;

namespace {

class ThemeTest : public ::testing::TestWithParam<Theme> {
protected:
  void TearDown() override { ApplyTheme(Theme::System); }
};

} // namespace

INSTANTIATE_TEST_SUITE_P(Themes, ThemeTest, ::testing::Values(Theme::Dark, Theme::Light),
                         [](const auto& info) { return WordOf(info.param).toStdString(); });

TEST(Contrast, IsThatOfTheStandard) {
  EXPECT_DOUBLE_EQ(ContrastOf(Qt::black, Qt::white), 21.0);
  EXPECT_DOUBLE_EQ(ContrastOf(Qt::white, Qt::white), 1.0);
  // #767676 on white is the lightest grey that WCAG accepts for texts: 4.54.
  EXPECT_NEAR(ContrastOf(QColor(0x767676), Qt::white), 4.54, 0.005);
  EXPECT_NEAR(ContrastOf(QColor(0x777777), Qt::white), 4.48, 0.005);
}

TEST_P(ThemeTest, TextsStandOut) {
  const QPalette palette = PaletteOf(this->GetParam());
  EXPECT_EQ(IsDark(palette), this->GetParam() == Theme::Dark);
  using Role = QPalette::ColorRole;
  const std::pair<Role, Role> pairs[] = {{QPalette::WindowText, QPalette::Window},
                                         {QPalette::Text, QPalette::Base},
                                         {QPalette::Text, QPalette::AlternateBase},
                                         {QPalette::ButtonText, QPalette::Button},
                                         {QPalette::ToolTipText, QPalette::ToolTipBase},
                                         {QPalette::HighlightedText, QPalette::Highlight},
                                         {QPalette::Link, QPalette::Base},
                                         {QPalette::LinkVisited, QPalette::Base},
                                         {QPalette::PlaceholderText, QPalette::Base},
                                         {QPalette::PlaceholderText, QPalette::Window}};
  for (const auto& [text, ground] : pairs) {
    for (const auto group : {QPalette::Active, QPalette::Inactive}) {
      EXPECT_GE(ContrastOf(palette.color(group, text), palette.color(group, ground)), 4.5)
          << text << " on " << ground;
    }
  }
  // What is disabled may be dimmer, and is still read.
  for (const auto& [text, ground] : {pairs[0], pairs[1], pairs[3]}) {
    const double contrast = ContrastOf(palette.color(QPalette::Disabled, text),
                                       palette.color(QPalette::Disabled, ground));
    EXPECT_GE(contrast, 3.0) << text << " on " << ground;
    EXPECT_LT(contrast, 0.6 * ContrastOf(palette.color(text), palette.color(ground))) << text;
  }
  for (const Accent accent : {Accent::Error, Accent::Input, Accent::Warning}) {
    for (const Role ground : {QPalette::Base, QPalette::Window, QPalette::AlternateBase}) {
      EXPECT_GE(ContrastOf(AccentOf(accent, palette), palette.color(ground)), 4.5) << int(accent);
    }
  }
  for (int curve = 0; curve < 8; ++curve) { // lines of plots
    EXPECT_GE(ContrastOf(ColorOf(curve, palette), palette.color(QPalette::Base)), 3.0) << curve;
  }
}

TEST_P(ThemeTest, WidgetsThatAreThereFollow) {
  QLabel label("text");
  label.setAutoFillBackground(true);
  label.resize(80, 40);
  label.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&label));
  ApplyTheme(this->GetParam());
  const auto* style = qobject_cast<OutlinedStyle*>(QApplication::style());
  ASSERT_TRUE(style);
  EXPECT_EQ(style->baseStyle()->name().toLower(), "fusion");
  QCoreApplication::processEvents();
  const QColor ground = label.grab().toImage().pixelColor(2, 2);
  EXPECT_EQ(ground, PaletteOf(this->GetParam()).color(QPalette::Window));
  ApplyTheme(Theme::System);
  QCoreApplication::processEvents();
  EXPECT_EQ(QApplication::palette(), PaletteOf(Theme::System));
}

TEST(ThemeWords, AreThoseOfSettings) {
  for (const Theme theme : {Theme::System, Theme::Dark, Theme::Light}) {
    EXPECT_EQ(ThemeOf(WordOf(theme)), theme);
  }
  EXPECT_FALSE(ThemeOf("pink"));
}
