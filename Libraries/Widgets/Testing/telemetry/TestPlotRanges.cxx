// The ranges of a plot follow its samples until they are moved.
#include <gtest/gtest.h>

#include <memory>

#include <QGuiApplication>
#include <QPalette>

#include "OneApplication.h"

#include <dspace/widgets/telemetry/PlotRanges.h>

using dspace::widgets::PlotPicture;
using dspace::widgets::PlotRanges;
using dspace::widgets::PlotState;
using dspace::widgets::SampleSeries;

namespace {

struct PlotRangesTest : ::testing::Test {
  PlotState state;
  PlotRanges ranges{state};
  std::shared_ptr<SampleSeries> metres = std::make_shared<SampleSeries>();
  std::shared_ptr<SampleSeries> volts = std::make_shared<SampleSeries>();

  void SetUp() override {
    for (int i = 0; i <= 10; ++i) {
      metres->Append(i, 2.0 * i);
      volts->Append(i, 100.0 - i);
    }
    state.series.push_back({"way", "m", metres, false, true, 0});
    state.series.push_back({"bus", "V", volts, false, true, 1});
    ranges.SeriesChanged();
  }
  PlotPicture Picture() const {
    return PlotPicture(state, {600.0, 400.0}, QGuiApplication::font(), QPalette(), 1.0);
  }
};

} // namespace

TEST_F(PlotRangesTest, FollowsSamplesAndTheWindow) {
  ASSERT_EQ(state.axes.size(), 2u);
  EXPECT_EQ(state.time.low, 0.0);
  EXPECT_EQ(state.time.high, 10.0);
  EXPECT_NEAR(state.axes[0].range.high, 21.0, 1e-9); // a margin of a twentieth
  metres->Append(20.0, 40.0);
  ranges.Follow();
  EXPECT_EQ(state.time.high, 20.0);
  EXPECT_NEAR(state.axes[0].range.high, 42.0, 1e-9);
  ranges.SetWindow(5.0);
  ranges.Follow();
  EXPECT_EQ(state.time.low, 15.0);
  EXPECT_TRUE(ranges.IsFollowing());
}

TEST_F(PlotRangesTest, StandsStillOnceItIsMoved) {
  ranges.SetX({2.0, 4.0});
  EXPECT_FALSE(ranges.IsFollowing());
  EXPECT_NEAR(state.axes[0].range.low, 3.8, 1e-9); // values follow what is seen
  EXPECT_NEAR(state.axes[0].range.high, 8.2, 1e-9);
  ranges.SetValues(state.axes[0], {-1.0, 1.0});
  metres->Append(20.0, 40.0);
  ranges.Follow();
  EXPECT_EQ(state.time.high, 4.0);
  EXPECT_EQ(state.axes[0].range.high, 1.0);
  ranges.FollowAll();
  ranges.Follow();
  EXPECT_EQ(state.time.high, 20.0);
}

TEST_F(PlotRangesTest, AxesAreThoseOfTheShownSeries) {
  ranges.SetValues(state.axes[0], {-1.0, 1.0});
  state.series[1].shown = false;
  ranges.SeriesChanged();
  ASSERT_EQ(state.axes.size(), 1u);
  EXPECT_EQ(state.axes[0].range.high, 1.0); // one that is there stays
  state.series[1].shown = true;
  ranges.SeriesChanged();
  ASSERT_EQ(state.axes.size(), 2u);
  EXPECT_NEAR(state.axes[1].range.high, 100.5, 1e-9); // a new one shows its series
}

TEST_F(PlotRangesTest, ZoomsAndMovesByPlacesInThePicture) {
  const QRectF area = Picture().Area();
  ranges.Zoom(Picture(), area.center(), 0.5, true, PlotRanges::NoAxis);
  EXPECT_NEAR(state.time.low, 2.5, 1e-9);
  EXPECT_NEAR(state.time.high, 7.5, 1e-9);
  ranges.Pan(Picture(), {-0.2 * area.width(), 0.0}, true, PlotRanges::NoAxis);
  EXPECT_NEAR(state.time.low, 3.5, 1e-9);
  const double before = state.axes[1].range.Length();
  ranges.Zoom(Picture(), area.center(), 2.0, false, 1);
  EXPECT_NEAR(state.axes[1].range.Length(), 2.0 * before, 1e-9);
  EXPECT_NEAR(state.time.low, 3.5, 1e-9);
  EXPECT_FALSE(ranges.ZoomTo(Picture(), {area.center(), QSizeF(3.0, 30.0)}));
  EXPECT_NEAR(state.time.low, 3.5, 1e-9);
  EXPECT_TRUE(
      ranges.ZoomTo(Picture(), {area.topLeft(), QSizeF(0.5 * area.width(), 0.5 * area.height())}));
  EXPECT_NEAR(state.time.low, 3.5, 1e-9);
  EXPECT_NEAR(state.time.high, 6.0, 1e-9);
}
