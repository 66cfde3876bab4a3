// The table of the cursors takes its room where the curves keep theirs.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include <QFontMetricsF>
#include <QGuiApplication>
#include <QImage>
#include <QPainter>

#include "OneApplication.h"

#include <dspace/widgets/telemetry/PlotReadouts.h>

using dspace::widgets::PlotReadouts;
using dspace::widgets::PlotState;
using dspace::widgets::SampleSeries;

namespace {

struct PlotReadoutsTest : ::testing::Test {
  PlotState state;
  QFont font;
  double line = 0.0;

  void SetUp() override {
    font = QGuiApplication::font();
    font.setPixelSize(12);
    line = std::ceil(QFontMetricsF(font).height());
    state.cursors = {1.0, 2.0};
  }
  void AddSeries(int count) {
    for (int i = 0; i < count; ++i) {
      auto samples = std::make_shared<SampleSeries>();
      samples->Append(0.0, i);
      samples->Append(5.0, i + 1.0);
      state.series.push_back({QString("channel %1").arg(i), "m", samples, false, true, i});
    }
  }
  PlotReadouts Of(double width, double height) const {
    return PlotReadouts(state, font, QPalette(Qt::white, Qt::white), {8.0, 20.0, width, height},
                        2.0 * line);
  }
};

} // namespace

TEST_F(PlotReadoutsTest, WithoutCursorsTheCurvesHaveAllTheRoom) {
  AddSeries(3);
  state.cursors = {};
  const PlotReadouts none = Of(600.0, 400.0);
  EXPECT_TRUE(none.Area().isEmpty());
  EXPECT_EQ(none.Rest(), QRectF(8.0, 20.0, 600.0, 400.0));
}

TEST_F(PlotReadoutsTest, RowsAreBelowWhereTheCurvesKeepTheirHeight) {
  AddSeries(3);
  const PlotReadouts all = Of(600.0, 400.0);
  EXPECT_FALSE(all.IsBeside());
  EXPECT_EQ(all.Area().height(), 4.0 * line); // the times and three series
  EXPECT_EQ(all.Area().bottom(), 420.0);
  EXPECT_LT(all.Rest().bottom(), all.Area().top());
  AddSeries(20);
  const PlotReadouts most = Of(600.0, 1000.0);
  EXPECT_EQ(most.Area().height(), 10.0 * line); // the times, eight series, and how many are left
  const PlotReadouts some = Of(600.0, 250.0);
  EXPECT_FALSE(some.IsBeside());
  EXPECT_LT(some.Area().height(), 10.0 * line);
  EXPECT_GE(some.Rest().height() - 2.0 * line, 100.0);
}

TEST_F(PlotReadoutsTest, InLowRoomTheTableIsBesideOrNowhere) {
  AddSeries(6);
  const PlotReadouts beside = Of(580.0, 80.0);
  EXPECT_TRUE(beside.IsBeside());
  EXPECT_EQ(beside.Rest().height(), 80.0);
  EXPECT_LT(beside.Rest().right(), beside.Area().left());
  EXPECT_EQ(beside.Area().right(), 588.0);
  EXPECT_LE(beside.Area().height(), 80.0);
  const PlotReadouts nowhere = Of(300.0, 80.0);
  EXPECT_TRUE(nowhere.Area().isEmpty());
  EXPECT_EQ(nowhere.Rest(), QRectF(8.0, 20.0, 300.0, 80.0));
}

TEST_F(PlotReadoutsTest, IsPaintedWithinItsArea) {
  AddSeries(6);
  for (const QSizeF size : {QSizeF(580.0, 80.0), QSizeF(580.0, 300.0)}) {
    const PlotReadouts readouts = Of(size.width(), size.height());
    QImage image(600, 340, QImage::Format_RGB32);
    image.fill(Qt::white);
    QPainter painter(&image);
    readouts.Paint(painter);
    painter.end();
    int inside = 0, outside = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        if (image.pixelColor(x, y) != QColor(Qt::white)) {
          ++(readouts.Area().adjusted(-1, -1, 1, 1).contains(x, y) ? inside : outside);
        }
      }
    }
    EXPECT_GT(inside, 100);
    EXPECT_EQ(outside, 0);
  }
}
