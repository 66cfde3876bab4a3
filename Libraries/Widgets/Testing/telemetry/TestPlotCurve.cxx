// Ranges, ticks and curves of plots.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <QImage>
#include <QPainter>

#include <dspace/widgets/telemetry/PlotAxis.h>
#include <dspace/widgets/telemetry/PlotCurve.h>

using namespace dspace::widgets; // NOLINT(google-build-using-namespace)

namespace {

const double NaN = std::numeric_limits<double>::quiet_NaN();

std::string Texts(const PlotTicks& ticks) {
  std::string all;
  for (const PlotTick& tick : ticks.ticks) {
    all += (all.empty() ? "" : " ") + tick.text;
  }
  return all + (ticks.offsetText.empty() ? "" : " + " + ticks.offsetText);
}

PlotMap Map(double width, double height, PlotRange x, PlotRange y) {
  return {QRectF(0.0, 0.0, width, height), x, y};
}

void ExpectPoints(const QPolygonF& line, const std::vector<QPointF>& wanted) {
  ASSERT_EQ(std::size_t(line.size()), wanted.size());
  for (int i = 0; i < line.size(); ++i) {
    EXPECT_NEAR(line[i].x(), wanted[std::size_t(i)].x(), 1e-9) << i;
    EXPECT_NEAR(line[i].y(), wanted[std::size_t(i)].y(), 1e-9) << i;
  }
}

} // namespace

TEST(PlotAxis, TicksAreRound) {
  EXPECT_EQ(Texts(MakeTicks({0.0, 10.0}, 6)), "0 2 4 6 8 10");
  EXPECT_EQ(Texts(MakeTicks({-0.13, 0.27}, 5)), "-0.1 0.0 0.1 0.2");
  EXPECT_EQ(Texts(MakeTicks({0.0, 40000.0}, 5)), "0 10,000 20,000 30,000 40,000");
  // Far from zero the common digits are written once.
  const PlotTicks late = MakeTicks({812345610.0, 812345670.0}, 4);
  EXPECT_EQ(Texts(late), "620 640 660 + 812,345,000");
  EXPECT_EQ(late.ticks[1].value, 812345640.0);
  const PlotTicks fine = MakeTicks({5.00001, 5.00003}, 3);
  ASSERT_FALSE(fine.ticks.empty());
  for (const PlotTick& tick : fine.ticks) {
    EXPECT_NEAR(tick.value - fine.offset, std::stod(tick.text), 1e-12) << tick.text;
  }
  for (const PlotRange range : {PlotRange{-1e300, 1e300}, PlotRange{0.0, 1e-250},
                                PlotRange{1e18, 1e18 + 1e7}, PlotRange{-1e-12, 1e-12}}) {
    EXPECT_LE(MakeTicks(Shown(range), 7).ticks.size(), 7u) << range.high;
    EXPECT_GE(MakeTicks(Shown(range), 7).ticks.size(), 1u) << range.high;
  }
}

TEST(PlotAxis, RangesAreWhatCanBeShown) {
  EXPECT_EQ(Shown({3.0, 1.0}), (PlotRange{1.0, 3.0}));
  EXPECT_EQ(Shown({NaN, 1.0}), PlotRange());
  const PlotRange point = Shown({8e8, 8e8});
  EXPECT_GT(point.Length(), 1e-4);
  EXPECT_LT(point.Length(), 1e-2);
  EXPECT_EQ(Around({2.0, 4.0}, 0.25), (PlotRange{1.5, 4.5}));
  EXPECT_EQ(Around({5.0, 5.0}, 0.25), (PlotRange{4.5, 5.5}));
  EXPECT_EQ(Around({0.0, 0.0}, 0.25), (PlotRange{-1.0, 1.0}));
  EXPECT_EQ(Around({NaN, NaN}, 0.25), PlotRange());
  EXPECT_EQ(Zoomed({0.0, 8.0}, 2.0, 0.5), (PlotRange{1.0, 5.0}));
  EXPECT_EQ(Moved({0.0, 8.0}, -2.0), (PlotRange{-2.0, 6.0}));
}

TEST(PlotCurve, LinesAreCutAtTheEdgesAndAtGaps) {
  SampleSeries samples;
  samples.Append(-10.0, 0.0);
  samples.Append(10.0, 20.0); // leads in through (0, 10)
  samples.Append(20.0, 20.0);
  samples.Append(30.0, NaN);
  samples.Append(40.0, 5.0); // alone
  samples.Append(50.0, NaN);
  samples.Append(60.0, 0.0);
  samples.Append(70.0, 100.0);
  samples.Append(80.0, 0.0);
  // A unit is a pixel; values grow upwards.
  const PlotCurve curve =
      TimeCurve(samples, false, Map(100.0, 50.0, {0.0, 100.0}, {0.0, 50.0}), 100, 0.0);
  ASSERT_EQ(curve.lines.size(), 3u);
  ExpectPoints(curve.lines[0], {{0, 40}, {10, 30}, {20, 30}});
  ExpectPoints(curve.lines[1], {{60, 50}, {65, 0}});
  ExpectPoints(curve.lines[2], {{75, 0}, {80, 50}});
  EXPECT_EQ(std::count(curve.dots.begin(), curve.dots.end(), QPointF(40, 45)), 1);
}

TEST(PlotCurve, ValuesThatHoldAreSteps) {
  SampleSeries samples;
  samples.Append(10.0, 10.0);
  samples.Append(30.0, 40.0);
  const PlotCurve curve =
      TimeCurve(samples, true, Map(100.0, 50.0, {0.0, 100.0}, {0.0, 50.0}), 100, 60.0);
  ASSERT_EQ(curve.lines.size(), 1u);
  ExpectPoints(curve.lines[0], {{10, 40}, {30, 40}, {30, 10}, {60, 10}});
}

// Of many samples the picture is the same as of a line through every one.
TEST(PlotCurve, DecimatedCurvesCoverTheSamePixels) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  SampleSeries samples;
  constexpr int Columns = 192; // of 1/256: the column of a time is exact
  constexpr int Count = 1 << 17;
  for (int i = 0; i < Count; ++i) {
    const double x = double(i) / Count;
    const bool gap = i / 3000 % 7 == 3;
    samples.Append(x, gap ? NaN : std::sin(9.0 * x) + (i % 900 == 0 ? 0.5 : 0.05) * unit(random));
  }
  const PlotMap map = Map(Columns, 150.0, {0.125, 0.875}, {-2.0, 2.0});
  const PlotCurve curve = TimeCurve(samples, false, map, Columns, 0.0);
  // Rows that each column's line covers.
  std::vector<double> top(Columns, 1e9);
  std::vector<double> bottom(Columns, -1e9);
  std::size_t points = 0;
  for (const QPolygonF& line : curve.lines) {
    points += std::size_t(line.size());
    for (const QPointF& point : line) {
      const int column = int(point.x());
      top[std::size_t(column)] = std::min(top[std::size_t(column)], point.y());
      bottom[std::size_t(column)] = std::max(bottom[std::size_t(column)], point.y());
    }
  }
  EXPECT_LE(points, 4u * Columns + 4u);
  std::vector<double> wantedTop(Columns, 1e9);
  std::vector<double> wantedBottom(Columns, -1e9);
  for (int i = 0; i < Count; ++i) {
    const double time_s = samples.Time(std::size_t(i));
    const double value = samples.Value(std::size_t(i));
    if (time_s < 0.125 || time_s >= 0.875 || std::isnan(value)) {
      continue;
    }
    const auto column = std::size_t((time_s - 0.125) * 256.0);
    const double y = 150.0 * (2.0 - value) / 4.0;
    wantedTop[column] = std::min(wantedTop[column], y);
    wantedBottom[column] = std::max(wantedBottom[column], y);
  }
  int empty = 0;
  for (std::size_t c = 0; c < Columns; ++c) {
    EXPECT_NEAR(top[c], wantedTop[c], 1e-6) << c;
    EXPECT_NEAR(bottom[c], wantedBottom[c], 1e-6) << c;
    empty += wantedTop[c] > 1e8 ? 1 : 0;
  }
  EXPECT_GT(empty, 5); // the gaps were in view
}

TEST(PlotCurve, PairsMeetEverySampleWithinHalfAPixel) {
  SampleSeries x;
  SampleSeries y;
  for (int i = 0; i <= 400000; ++i) { // a circle, slowly
    x.Append(i, std::cos(2e-5 * i));
    if (i % 3 == 0) {
      y.Append(i, i == 150000 ? NaN : std::sin(2e-5 * i));
    }
  }
  const PlotMap map = Map(300.0, 300.0, {-1.5, 1.5}, {-1.5, 1.5});
  const PlotCurve curve = PairCurve(x, false, y, map, {-1.0, 1e9});
  std::vector<QPointF> points;
  for (const QPolygonF& line : curve.lines) {
    for (const QPointF& point : line) {
      points.push_back(point);
      ASSERT_NEAR(std::hypot(point.x() - 150.0, point.y() - 150.0), 100.0, 0.01);
    }
  }
  EXPECT_LT(points.size(), 10000u); // of 133,334
  for (int i = 0; i <= 400000; i += 60 * 3) {
    if (i == 150000) {
      continue;
    }
    const QPointF sample(150.0 + 100.0 * std::cos(2e-5 * i), 150.0 - 100.0 * std::sin(2e-5 * i));
    double nearest = 1e9;
    for (const QPointF& point : points) {
      nearest = std::min(nearest, std::hypot(point.x() - sample.x(), point.y() - sample.y()));
    }
    ASSERT_LE(nearest, 0.5) << i;
  }
  // Only samples of the interval; X is between its samples.
  const PlotCurve part = PairCurve(x, false, y, map, {0.0, 78539.8163}); // a quarter
  for (const QPolygonF& line : part.lines) {
    for (const QPointF& point : line) {
      ASSERT_GE(point.x(), 150.0 - 0.01);
      ASSERT_LE(point.y(), 150.0 + 0.01);
    }
  }
  EXPECT_FALSE(part.lines.empty());
}
