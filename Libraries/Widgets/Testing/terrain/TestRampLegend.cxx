// The colours of the legend's bars.
#include <dspace/widgets/terrain/RampLegend.h>

#include <QtTest>
#include <gtest/gtest.h>

#include "OneApplication.h"

using dspace::widgets::RampEntry;
using dspace::widgets::RampLegend;

TEST(RampLegend, ColoursAreLinearBetweenTheGivenOnes) {
  const RampEntry entry{"Height [m]", 0.0, 1.0, {Qt::black, QColor(255, 0, 0), Qt::white}};
  EXPECT_EQ(RampLegend::ColorAt(entry, -1.0).rgb(), QColor(Qt::black).rgb());
  EXPECT_EQ(RampLegend::ColorAt(entry, 0.5).rgb(), QColor(255, 0, 0).rgb());
  EXPECT_NEAR(RampLegend::ColorAt(entry, 0.25).red(), 128, 1);
  EXPECT_EQ(RampLegend::ColorAt(entry, 2.0).rgb(), QColor(Qt::white).rgb());
  EXPECT_EQ(RampLegend::ColorAt({"", 0.0, 1.0, {Qt::blue}}, 0.3).rgb(), QColor(Qt::blue).rgb());
}

TEST(RampLegend, HasABarForEachEntryAndIsHiddenWithoutAny) {
  QWidget window;
  auto* legend = new RampLegend(&window);
  window.resize(240, 200);
  window.show();
  legend->SetEntries({});
  EXPECT_TRUE(legend->isHidden());
  legend->SetEntries({{"Height [m]", -4501.0, -1000.0, {Qt::blue, Qt::blue}}});
  EXPECT_FALSE(legend->isHidden());
  const int one = legend->sizeHint().height();
  EXPECT_EQ(legend->accessibleDescription(), "Height [m]: -4501 to -1000");
  legend->SetEntries({{"Height [m]", 0.0, 1.0, {Qt::blue, Qt::blue}},
                      {"Slope [deg]", 0.0, 45.0, {Qt::red, Qt::red}}});
  EXPECT_EQ(legend->sizeHint().height(), 2 * one);
  legend->resize(240, 2 * one);
  const QImage picture = legend->grab().toImage();
  int blue = 0;
  int red = 0;
  for (int y = 0; y < picture.height(); ++y) {
    const QRgb at = picture.pixel(picture.width() / 2 + 5, y);
    blue += at == QColor(Qt::blue).rgb() ? 1 : 0;
    red += at == QColor(Qt::red).rgb() ? 1 : 0;
  }
  EXPECT_GE(blue, 10);
  EXPECT_GE(red, 10);
}
