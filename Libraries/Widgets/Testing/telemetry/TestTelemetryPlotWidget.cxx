// The plot turns the user's events into ranges, cursors and times, follows channels, and exports
// what it shows.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include <QDir>
#include <QDropEvent>
#include <QImage>
#include <QMenu>
#include <QToolTip>
#include <QWheelEvent>
#include <QXmlStreamReader>
#include <QtTest>
#include <unistd.h>

#include "FullDisk.h"
#include "OneApplication.h"

#include <dspace/Error.h>
#include <dspace/state/Telemetry.h>
#include <dspace/widgets/telemetry/ChannelMime.h>
#include <dspace/widgets/telemetry/TelemetryPlotWidget.h>

using dspace::session::Telemetry;
using dspace::widgets::PlotRange;
using dspace::widgets::SampleSeries;
using dspace::widgets::TelemetryPlotWidget;
namespace v1 = dspace::v1;

namespace {

const double PlotNaN = std::numeric_limits<double>::quiet_NaN();

std::shared_ptr<SampleSeries> Line(double from, double to, double first, double last, int count) {
  auto samples = std::make_shared<SampleSeries>();
  for (int i = 0; i < count; ++i) {
    const double part = double(i) / (count - 1);
    samples->Append(from + part * (to - from), first + part * (last - first));
  }
  return samples;
}

void ExpectRange(const PlotRange& range, double low, double high, double tolerance) {
  EXPECT_NEAR(range.low, low, tolerance);
  EXPECT_NEAR(range.high, high, tolerance);
}

// A line of this colour passes the place: it covers most of a pixel there.
bool Passes(const QImage& image, const QPointF& place, const QColor& color) {
  const auto distance = [](const QColor& a, const QColor& b) {
    return std::abs(a.red() - b.red()) + std::abs(a.green() - b.green()) +
           std::abs(a.blue() - b.blue());
  };
  for (int x = int(place.x()) - 1; x <= int(place.x()) + 1; ++x) {
    for (int y = int(place.y()) - 1; y <= int(place.y()) + 1; ++y) {
      if (distance(image.pixelColor(x, y), color) < distance(color, Qt::white) / 3) {
        return true;
      }
    }
  }
  return false;
}

std::string Content(const QString& path) {
  std::ostringstream all;
  all << std::ifstream(path.toStdString(), std::ios::binary).rdbuf();
  return all.str();
}

struct TelemetryPlot : ::testing::Test {
  std::unique_ptr<Telemetry> telemetry = std::make_unique<Telemetry>();
  TelemetryPlotWidget widget;
  QTemporaryDir folder;

  void SetUp() override {
    QPalette palette;
    palette.setColor(QPalette::Base, Qt::white);
    palette.setColor(QPalette::Text, Qt::black);
    palette.setColor(QPalette::Highlight, QColor(0, 0, 255));
    widget.setPalette(palette);
    widget.resize(800, 500);
    widget.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&widget));
  }
  // 0 to 100 s: a ramp of metres from 0 to 10, and one of volts from 200 to 100.
  void AddRamps() {
    widget.AddSeries("ramp", "m", Line(0.0, 100.0, 0.0, 10.0, 1001));
    widget.AddSeries("drop", "V", Line(0.0, 100.0, 200.0, 100.0, 1001));
  }
  QPointF At(double partX, double partY) const {
    const QRectF area = widget.PlotArea();
    return {std::round(area.left() + partX * area.width()),
            std::round(area.top() + partY * area.height())};
  }
  static QPointF Middle(const QRectF& area) { return QPointF(area.center().toPoint()); }
  // The time of a place, by the widget's own axis ends.
  double TimeOf(const QPointF& place) const {
    const QRectF area = widget.PlotArea();
    const PlotRange x = widget.XRange();
    return x.low + (place.x() - area.left()) / area.width() * (x.high - x.low);
  }
  void Wheel(const QPointF& place, int notches, Qt::KeyboardModifiers modifiers = {}) {
    QWheelEvent wheel(place, widget.mapToGlobal(place), QPoint(), QPoint(0, 120 * notches),
                      Qt::NoButton, modifiers, Qt::NoScrollPhase, false);
    QApplication::sendEvent(&widget, &wheel);
  }
  void Move(const QPointF& place, Qt::MouseButton button) {
    QMouseEvent move(QEvent::MouseMove, place, widget.mapToGlobal(place), Qt::NoButton, button,
                     Qt::NoModifier);
    QApplication::sendEvent(&widget, &move);
  }
  void Drag(const QPointF& from, const QPointF& to, Qt::MouseButton button = Qt::LeftButton) {
    QTest::mousePress(&widget, button, {}, from.toPoint());
    Move(0.5 * (from + to), button);
    Move(to, button);
    QTest::mouseRelease(&widget, button, {}, to.toPoint());
  }
  void Drop(const QStringList& names, const QPointF& place) {
    const std::unique_ptr<QMimeData> data(dspace::widgets::MakeChannelMime(names));
    QDragEnterEvent enter(place.toPoint(), Qt::CopyAction, data.get(), Qt::LeftButton, {});
    QApplication::sendEvent(&widget, &enter);
    EXPECT_TRUE(enter.isAccepted());
    QDropEvent drop(place, Qt::CopyAction, data.get(), Qt::LeftButton, {});
    QApplication::sendEvent(&widget, &drop);
    EXPECT_TRUE(drop.isAccepted());
  }
  std::uint64_t Number(const std::string& name, const std::string& unit = "") {
    v1::CreateTelemetry create;
    create.set_name(name);
    create.set_unit(unit);
    return telemetry->Create(create, telemetry->LastId() + 1);
  }
  void Set(std::uint64_t id, double value, double time_s) {
    v1::SetTelemetry set;
    set.add_id(id);
    set.add_value(value);
    set.add_time_s(time_s);
    telemetry->Set(set, time_s);
  }
  // Waits for the end of an export: "" or the failure.
  std::string Finish(QSignalSpy& exported, QSignalSpy& failed) {
    if (!QTest::qWaitFor([&] { return exported.count() + failed.count() > 0; }, 10000)) {
      return "it does not end";
    }
    const std::string failure = failed.isEmpty() ? "" : failed[0][0].toString().toStdString();
    exported.clear();
    failed.clear();
    return failure;
  }
};

} // namespace

TEST_F(TelemetryPlot, ShowsAllWithAnAxisForEachUnit) {
  AddRamps();
  widget.AddSeries("other", "m", Line(50.0, 120.0, -5.0, 0.0, 10));
  ExpectRange(widget.XRange(), 0.0, 120.0, 0.0);
  EXPECT_EQ(widget.Units(), (QStringList{"m", "V"}));
  ExpectRange(widget.ValueRange("m"), -5.75, 10.75, 1e-9); // 5 % of 15 on each side
  ExpectRange(widget.ValueRange("V"), 95.0, 205.0, 1e-9);
  EXPECT_LT(widget.ValueAxisArea("m").right(), widget.PlotArea().left() + 1.0);
  EXPECT_GT(widget.ValueAxisArea("V").left(), widget.PlotArea().right() - 1.0);
  // A sample's place is where the axes have its time and value.
  const std::optional<QPointF> place = widget.PlaceOf("ramp", 60.0);
  ASSERT_TRUE(place);
  const QRectF area = widget.PlotArea();
  EXPECT_NEAR(place->x(), area.left() + area.width() * 0.5, 1e-9);
  EXPECT_NEAR(place->y(), area.bottom() - area.height() * (6.0 + 5.75) / 16.5, 1e-6);
  // The line is there, in its colour, and nothing of it beside.
  const QImage image = widget.grab().toImage();
  EXPECT_TRUE(Passes(image, *place, 0x0072b2));
  EXPECT_FALSE(Passes(image, *place + QPointF(0.0, -8.0), 0x0072b2));
  // Without the series of a unit its axis goes.
  widget.RemoveSeries("drop");
  EXPECT_EQ(widget.Units(), QStringList{"m"});
  widget.RemoveAll();
  EXPECT_TRUE(widget.Units().isEmpty());
  EXPECT_TRUE(widget.Series().isEmpty());
}

TEST_F(TelemetryPlot, TheWheelZoomsAtThePointer) {
  AddRamps();
  const QPointF place = At(0.25, 0.75);
  const double time_s = TimeOf(place);
  const PlotRange before = widget.ValueRange("m");
  Wheel(place, 2);
  const double factor = 1.25 * 1.25;
  EXPECT_NEAR(TimeOf(place), time_s, 1e-9); // what is under the pointer stays there
  EXPECT_NEAR(widget.XRange().Length(), 100.0 / factor, 1e-9);
  EXPECT_NEAR(widget.ValueRange("m").Length(), before.Length() / factor, 1e-9);
  EXPECT_NEAR(widget.ValueRange("V").Length(), 110.0 / factor, 1e-9);
  EXPECT_FALSE(widget.IsFollowing());
  Wheel(place, -2);
  ExpectRange(widget.XRange(), 0.0, 100.0, 1e-9);
  ExpectRange(widget.ValueRange("m"), before.low, before.high, 1e-9);
  // Ctrl: time alone. Shift: values alone. Over an axis: that alone.
  Wheel(place, 1, Qt::ControlModifier);
  EXPECT_NEAR(widget.XRange().Length(), 80.0, 1e-9);
  EXPECT_NEAR(widget.ValueRange("m").Length(), before.Length(), 1e-9);
  Wheel(place, 1, Qt::ShiftModifier);
  EXPECT_NEAR(widget.XRange().Length(), 80.0, 1e-9);
  EXPECT_NEAR(widget.ValueRange("m").Length(), before.Length() / 1.25, 1e-9);
  Wheel(widget.ValueAxisArea("V").center(), 1);
  EXPECT_NEAR(widget.ValueRange("V").Length(), 110.0 / factor, 1e-9);
  EXPECT_NEAR(widget.ValueRange("m").Length(), before.Length() / 1.25, 1e-9);
  Wheel(widget.XAxisArea().center(), -1);
  EXPECT_NEAR(widget.XRange().Length(), 100.0, 1e-9);
  // No number of notches leads to what cannot be drawn.
  for (int i = 0; i < 100; ++i) {
    Wheel(place, 20);
  }
  widget.repaint();
  EXPECT_GT(widget.XRange().Length(), 0.0);
  for (int i = 0; i < 400; ++i) {
    Wheel(place, -20);
  }
  widget.repaint();
  EXPECT_TRUE(std::isfinite(widget.XRange().Length()));
  EXPECT_TRUE(std::isfinite(widget.ValueRange("m").Length()));
}

TEST_F(TelemetryPlot, DragsMoveAndTheRightButtonZoomsToARectangle) {
  AddRamps();
  const QRectF area = widget.PlotArea();
  const PlotRange before = widget.ValueRange("V");
  Drag(At(0.5, 0.5), At(0.5, 0.5) + QPointF(100.0, 50.0));
  const double seconds = 100.0 * 100.0 / area.width();
  ExpectRange(widget.XRange(), -seconds, 100.0 - seconds, 1e-6);
  const double volts = 50.0 * before.Length() / area.height();
  ExpectRange(widget.ValueRange("V"), before.low + volts, before.high + volts, 1e-6);
  // Of an axis: that alone.
  Drag(Middle(widget.ValueAxisArea("V")), Middle(widget.ValueAxisArea("V")) + QPointF(3.0, -50.0));
  ExpectRange(widget.ValueRange("V"), before.low, before.high, 1e-6);
  ExpectRange(widget.XRange(), -seconds, 100.0 - seconds, 1e-6);
  Drag(Middle(widget.XAxisArea()), Middle(widget.XAxisArea()) + QPointF(-100.0, 7.0));
  ExpectRange(widget.XRange(), 0.0, 100.0, 1e-6);
  widget.ShowAll();

  const QPointF from = At(0.7, 0.2);
  const QPointF to = At(0.3, 0.6);
  const double early = TimeOf(to);
  const double late = TimeOf(from);
  const double top = before.high - (from.y() - area.top()) / area.height() * before.Length();
  const double bottom = before.high - (to.y() - area.top()) / area.height() * before.Length();
  Drag(from, to, Qt::RightButton);
  ExpectRange(widget.XRange(), early, late, 1e-6);
  ExpectRange(widget.ValueRange("V"), bottom, top, 1e-6);
  // Escape gives up.
  QTest::mousePress(&widget, Qt::RightButton, {}, At(0.2, 0.2).toPoint());
  Move(At(0.6, 0.6), Qt::RightButton);
  QTest::keyClick(&widget, Qt::Key_Escape);
  QTest::mouseRelease(&widget, Qt::RightButton, {}, At(0.6, 0.6).toPoint());
  ExpectRange(widget.XRange(), early, late, 1e-6);
  // A double click shows all, and chooses no time.
  QSignalSpy chosen(&widget, &TelemetryPlotWidget::timeChosen);
  QTest::mouseClick(&widget, Qt::LeftButton, {}, At(0.5, 0.5).toPoint());
  QTest::mouseDClick(&widget, Qt::LeftButton, {}, At(0.5, 0.5).toPoint());
  ExpectRange(widget.XRange(), 0.0, 100.0, 0.0);
  ExpectRange(widget.ValueRange("V"), before.low, before.high, 1e-9);
  EXPECT_TRUE(widget.IsFollowing());
  QTest::qWait(QApplication::doubleClickInterval() + 100);
  EXPECT_EQ(chosen.count(), 0);
}

TEST_F(TelemetryPlot, AClickChoosesATimeAndTheLineFollowsTheHand) {
  AddRamps();
  QSignalSpy chosen(&widget, &TelemetryPlotWidget::timeChosen);
  QTest::mouseClick(&widget, Qt::LeftButton, {}, At(0.25, 0.5).toPoint());
  ASSERT_TRUE(QTest::qWaitFor([&] { return chosen.count() == 1; }, 3000));
  EXPECT_NEAR(chosen[0][0].toDouble(), TimeOf(At(0.25, 0.5)), 1e-9);
  EXPECT_FALSE(widget.CurrentTime()); // the timeline says what the time is
  widget.SetCurrentTime(40.0);
  const QRectF area = widget.PlotArea();
  const int x = int(std::lround(area.left() + 0.4 * area.width()));
  // The line is in the picture, from top to bottom.
  const QImage image = widget.grab().toImage();
  for (const double part : {0.02, 0.2, 0.98}) {
    int blue = 0;
    for (int i = x - 2; i <= x + 2; ++i) {
      blue += image.pixelColor(i, int(At(0.0, part).y())) == QColor(0, 0, 255) ? 1 : 0;
    }
    EXPECT_GE(blue, 1) << part;
  }
  chosen.clear();
  Drag(QPointF(x, At(0.0, 0.3).y()), At(0.8, 0.3));
  ASSERT_GE(chosen.count(), 2);
  EXPECT_NEAR(chosen.back()[0].toDouble(), TimeOf(At(0.8, 0.3)), 1e-9);
  EXPECT_NEAR(widget.CurrentTime().value_or(0.0), TimeOf(At(0.8, 0.3)), 1e-9);
  ExpectRange(widget.XRange(), 0.0, 100.0, 0.0); // nothing has moved
  widget.SetCurrentTime({});
  EXPECT_FALSE(widget.CurrentTime());
  EXPECT_THROW(widget.SetCurrentTime(PlotNaN), dspace::Error);
}

TEST_F(TelemetryPlot, CursorsReadValuesAndAreDragged) {
  AddRamps();
  QSignalSpy chosen(&widget, &TelemetryPlotWidget::timeChosen);
  const double before = widget.PlotArea().bottom();
  widget.SetCursor(0, 20.0);
  widget.SetCursor(1, 70.05);
  EXPECT_LT(widget.PlotArea().bottom(), before - 30.0); // the read-outs have room
  EXPECT_NEAR(widget.ValueAt("ramp", 70.05) - widget.ValueAt("ramp", 20.0), 5.005, 1e-9);
  EXPECT_NEAR(widget.ValueAt("drop", 70.05) - widget.ValueAt("drop", 20.0), -50.05, 1e-9);
  EXPECT_TRUE(std::isnan(widget.ValueAt("ramp", 100.5)));
  const QRectF area = widget.PlotArea();
  Drag(QPointF(area.left() + 0.2 * area.width(), At(0.0, 0.5).y()), At(0.4, 0.5));
  EXPECT_NEAR(widget.Cursor(0).value_or(0.0), TimeOf(At(0.4, 0.5)), 1e-9);
  EXPECT_EQ(widget.Cursor(1), 70.05);
  ExpectRange(widget.XRange(), 0.0, 100.0, 0.0);
  QTest::keyClick(&widget, Qt::Key_Escape);
  EXPECT_FALSE(widget.Cursor(0));
  EXPECT_FALSE(widget.Cursor(1));
  EXPECT_EQ(widget.PlotArea().bottom(), before);
  QTest::keyClick(&widget, Qt::Key_B);
  EXPECT_TRUE(widget.Cursor(1));
  EXPECT_THROW(widget.SetCursor(2, 1.0), dspace::Error);
  EXPECT_EQ(chosen.count(), 0);
}

TEST_F(TelemetryPlot, ASlidingWindowFollowsUntilTheUserZooms) {
  auto live = Line(0.0, 100.0, 0.0, 10.0, 1001);
  widget.AddSeries("live", "m", live);
  widget.SetWindow(30.0);
  ExpectRange(widget.XRange(), 70.0, 100.0, 0.0);
  ExpectRange(widget.ValueRange("m"), 7.0 - 0.15, 10.0 + 0.15, 1e-9); // of what is in view
  live->Append(110.0, 12.0);
  ASSERT_TRUE(QTest::qWaitFor([&] { return widget.XRange().high == 110.0; }, 2000));
  EXPECT_EQ(widget.XRange().low, 80.0);
  Wheel(At(0.5, 0.5), 1);
  const PlotRange zoomed = widget.XRange();
  live->Append(120.0, 12.0);
  QTest::qWait(120);
  EXPECT_EQ(widget.XRange(), zoomed);
  QTest::mouseDClick(&widget, Qt::LeftButton, {}, At(0.5, 0.5).toPoint());
  ExpectRange(widget.XRange(), 90.0, 120.0, 0.0);
  widget.SetWindow(0.0);
  ExpectRange(widget.XRange(), 0.0, 120.0, 0.0);
  EXPECT_THROW(widget.SetWindow(-1.0), dspace::Error);
  EXPECT_THROW(widget.SetWindow(PlotNaN), dspace::Error);
}

TEST_F(TelemetryPlot, DroppedChannelsAreFollowed) {
  widget.SetSource([this] { return telemetry.get(); });
  const std::uint64_t torque = Number("torque", "N.m");
  const std::uint64_t angle = Number("angle", "deg");
  QSignalSpy dropped(&widget, &TelemetryPlotWidget::channelDropped);
  QSignalSpy failed(&widget, &TelemetryPlotWidget::failed);
  Set(torque, 1.0, 10.0);
  Drop({"torque", "angle", "unknown"}, At(0.5, 0.5));
  EXPECT_EQ(widget.Series(), (QStringList{"torque", "angle"}));
  EXPECT_EQ(widget.Units(), (QStringList{"N.m", "deg"}));
  ASSERT_EQ(dropped.count(), 1);
  EXPECT_EQ(dropped[0][0].toString(), "unknown");
  const auto samples = widget.Samples("torque");
  ASSERT_EQ(samples->Size(), 1u); // the present value
  EXPECT_EQ(widget.Samples("angle")->Size(), 0u);
  Set(torque, 2.0, 11.0);
  ASSERT_TRUE(QTest::qWaitFor([&] { return samples->Size() == 2; }, 2000)); // by itself
  EXPECT_EQ(samples->Time(1), 11.0);
  EXPECT_EQ(samples->Value(1), 2.0);
  Set(angle, 5.0, 11.0); // nothing new of the torque
  widget.Refresh();
  EXPECT_EQ(samples->Size(), 2u);
  Set(torque, PlotNaN, 12.0);
  widget.Refresh();
  Set(torque, 4.0, 13.0);
  widget.Refresh();
  EXPECT_TRUE(std::isnan(samples->Value(2)));
  // Every step, where the simulation says so.
  for (int i = 0; i < 100; ++i) {
    Set(torque, i, 20.0 + 0.001 * i);
    widget.Refresh();
  }
  EXPECT_EQ(samples->Size(), 104u);
  // Time goes back: what comes later is no longer so.
  Set(torque, -1.0, 11.5);
  widget.Refresh();
  ASSERT_EQ(samples->Size(), 3u);
  EXPECT_EQ(samples->Time(2), 11.5);
  EXPECT_EQ(samples->Value(2), -1.0);
  EXPECT_EQ(failed.count(), 0);
  // The scene goes: the curves stay.
  telemetry.reset();
  widget.Refresh();
  EXPECT_EQ(samples->Size(), 3u);
}

TEST_F(TelemetryPlot, TextsAndStrangersAreNoChannels) {
  widget.SetSource([this] { return telemetry.get(); });
  v1::CreateTelemetry create;
  create.set_name("note");
  create.set_kind(v1::CreateTelemetry::TEXT);
  telemetry->Create(create, 1);
  EXPECT_THROW(widget.AddChannel("note"), dspace::Error);
  EXPECT_THROW(widget.AddChannel("nothing"), dspace::Error);
  EXPECT_THROW(widget.AddSeries("null", "", nullptr), dspace::Error);
  EXPECT_TRUE(widget.Series().isEmpty());
  QSignalSpy failed(&widget, &TelemetryPlotWidget::failed);
  Drop({"note"}, At(0.5, 0.5));
  ASSERT_EQ(failed.count(), 1);
  EXPECT_EQ(failed[0][0].toString().toStdString(),
            "telemetry 'note': it is a text; accepted: numbers and choices");
  QMimeData other;
  other.setText("torque");
  QDragEnterEvent enter(QPoint(50, 50), Qt::CopyAction, &other, Qt::LeftButton, {});
  enter.ignore();
  QApplication::sendEvent(&widget, &enter);
  EXPECT_FALSE(enter.isAccepted());
}

TEST_F(TelemetryPlot, OneChannelAgainstAnother) {
  widget.AddSeries("x", "m", Line(0.0, 10.0, 0.0, 100.0, 101));
  widget.AddSeries("y", "V", Line(0.0, 10.0, 5.0, -5.0, 41));
  widget.SetXSeries("x");
  EXPECT_EQ(widget.XSeries(), "x");
  ExpectRange(widget.XRange(), -5.0, 105.0, 1e-9);
  EXPECT_EQ(widget.Units(), QStringList{"V"}); // X has its own axis
  const std::optional<QPointF> place = widget.PlaceOf("y", 2.5);
  ASSERT_TRUE(place);
  const QRectF area = widget.PlotArea();
  EXPECT_NEAR(place->x(), area.left() + area.width() * (25.0 + 5.0) / 110.0, 1e-6);
  EXPECT_NEAR(place->y(), area.bottom() - area.height() * (2.5 + 5.5) / 11.0, 1e-6);
  EXPECT_TRUE(Passes(widget.grab().toImage(), *place, 0xc24e00));
  // A click near the curve chooses the time of its sample.
  QSignalSpy chosen(&widget, &TelemetryPlotWidget::timeChosen);
  QTest::mouseClick(&widget, Qt::LeftButton, {}, (*place + QPointF(2.0, 3.0)).toPoint());
  ASSERT_TRUE(QTest::qWaitFor([&] { return chosen.count() == 1; }, 3000));
  EXPECT_DOUBLE_EQ(chosen[0][0].toDouble(), 2.5);
  Wheel(*place, 1);
  EXPECT_NEAR(widget.XRange().Length(), 110.0 / 1.25, 1e-9);
  EXPECT_THROW(widget.SetXSeries("nothing"), dspace::Error);
  // A drop on the axis below makes it X.
  widget.SetXSeries("");
  ExpectRange(widget.XRange(), 0.0, 10.0, 0.0);
  widget.SetSource([this] { return telemetry.get(); });
  Set(Number("drive", "m"), 1.0, 0.0);
  Drop({"drive"}, widget.XAxisArea().center());
  EXPECT_EQ(widget.XSeries(), "drive");
  widget.RemoveSeries("drive"); // and time is X again
  EXPECT_EQ(widget.XSeries(), "");
}

TEST_F(TelemetryPlot, LegendAndToolTips) {
  AddRamps();
  QTest::mouseClick(&widget, Qt::LeftButton, {}, widget.LegendArea("drop").center().toPoint());
  EXPECT_FALSE(widget.IsShown("drop"));
  EXPECT_EQ(widget.Units(), QStringList{"m"});
  QTest::mouseClick(&widget, Qt::LeftButton, {}, widget.LegendArea("drop").center().toPoint());
  EXPECT_TRUE(widget.IsShown("drop"));
  const auto tip = [&](const QPointF& place) {
    QToolTip::hideText(); // which takes a moment
    EXPECT_TRUE(QTest::qWaitFor([] { return !QToolTip::isVisible(); }, 3000));
    QHelpEvent help(QEvent::ToolTip, place.toPoint(), widget.mapToGlobal(place.toPoint()));
    QApplication::sendEvent(&widget, &help);
    return QToolTip::isVisible() ? QToolTip::text().toStdString() : "";
  };
  const QPointF place = *widget.PlaceOf("ramp", 30.0);
  const std::string text = tip(place + QPointF(0.0, 2.0));
  EXPECT_EQ(text.substr(0, 5), "ramp\n") << text;
  EXPECT_NE(text.find(" m\nat "), std::string::npos) << text;
  EXPECT_NEAR(std::stod(text.substr(5)), 3.0, 0.05) << text;
  EXPECT_EQ(tip(At(0.5, 0.98)), ""); // far from all curves
  EXPECT_NE(tip(widget.LegendArea("drop").center()).find("drop [V]\n1001 samples"),
            std::string::npos);
}

TEST_F(TelemetryPlot, GapsAreLeftOut) {
  auto samples = std::make_shared<SampleSeries>();
  for (int i = 0; i <= 1000; ++i) {
    samples->Append(0.1 * i, i > 400 && i < 600 ? PlotNaN : 1.0);
  }
  widget.AddSeries("gap", "m", samples);
  const QImage image = widget.grab().toImage();
  const int y = int(widget.PlaceOf("gap", 10.0)->y());
  const auto ink = [&](double time_s) {
    const QRectF area = widget.PlotArea();
    const int x = int(area.left() + area.width() * time_s / 100.0);
    for (int row = y - 1; row <= y + 1; ++row) {
      if (image.pixelColor(x, row).blue() > image.pixelColor(x, row).red() + 60) {
        return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(ink(20.0));
  EXPECT_FALSE(ink(45.0));
  EXPECT_FALSE(ink(55.0));
  EXPECT_TRUE(ink(80.0));
}

TEST_F(TelemetryPlot, ExportsTablesAndPictures) {
  AddRamps();
  widget.SetCursor(0, 20.0);
  QSignalSpy exported(&widget, &TelemetryPlotWidget::exported);
  QSignalSpy failed(&widget, &TelemetryPlotWidget::failed);
  const QString csv = folder.filePath("t\u00e4ble.csv");
  widget.ExportCsv(csv);
  EXPECT_EQ(Finish(exported, failed), "");
  std::string text = Content(csv);
  EXPECT_EQ(text.substr(0, 47), "time [s],ramp [m],drop [V]\r\n0,0,200\r\n0.1,0.01,1");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1002);
  widget.SetXRange({10.0, 20.0});
  widget.SetShown("drop", false);
  widget.ExportCsv(csv, true);
  EXPECT_EQ(Finish(exported, failed), "");
  text = Content(csv);
  EXPECT_EQ(text.substr(0, 25), "time [s],ramp [m]\r\n10,1\r\n");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 102);

  const QString png = folder.filePath("plot.png");
  widget.ExportPng(png, 2.0);
  EXPECT_EQ(Finish(exported, failed), "");
  const QImage image(png);
  EXPECT_EQ(image.size(), 2 * widget.size());
  const QPointF place = *widget.PlaceOf("ramp", 15.0);
  EXPECT_TRUE(Passes(image, 2.0 * place, 0x0072b2));
  EXPECT_THROW(widget.ExportPng(png, 9.0), dspace::Error);

  widget.SetShown("drop", true);
  const QString svg = folder.filePath("plot.svg");
  widget.ExportSvg(svg);
  EXPECT_EQ(Finish(exported, failed), "");
  QXmlStreamReader reader(QByteArray::fromStdString(Content(svg)));
  QStringList texts;
  bool through = false; // a line of the ramp's colour passes its place
  const QPointF wanted = *widget.PlaceOf("ramp", 15.0);
  while (!reader.atEnd()) {
    reader.readNext();
    if (reader.isStartElement() && reader.name() == QLatin1String("text")) {
      texts += reader.readElementText();
    } else if (reader.isStartElement() && reader.name() == QLatin1String("polyline") &&
               reader.attributes().value("stroke") == QLatin1String("#0072b2")) {
      for (const QString& point :
           reader.attributes().value("points").toString().split(' ', Qt::SkipEmptyParts)) {
        const QStringList xy = point.split(',');
        ASSERT_EQ(xy.size(), 2);
        through =
            through || QLineF(QPointF(xy[0].toDouble(), xy[1].toDouble()), wanted).length() < 0.1;
      }
    }
  }
  EXPECT_FALSE(reader.hasError()) << reader.errorString().toStdString();
  EXPECT_TRUE(through);
  for (const char* each : {"ramp [m]", "drop [V]", "time [s]", "12", "A", "A 20 s"}) {
    EXPECT_TRUE(texts.contains(each)) << each << " of " << texts.join("|").toStdString();
  }
}

TEST_F(TelemetryPlot, AFullOrClosedDiskIsToldAndTheOldFileStays) {
  widget.AddSeries("a", "m", Line(0.0, 1e4, 0.0, 1.0, 20000));
  QSignalSpy exported(&widget, &TelemetryPlotWidget::exported);
  QSignalSpy failed(&widget, &TelemetryPlotWidget::failed);
  for (const char* name : {"a.csv", "a.png", "a.svg"}) {
    const QString path = folder.filePath(name);
    const auto write = [&] {
      name[2] == 'c'   ? widget.ExportCsv(path)
      : name[2] == 'p' ? widget.ExportPng(path)
                       : widget.ExportSvg(path);
    };
    std::ofstream(path.toStdString()) << "old";
    std::string failure;
    {
      const dspace::testing::FullDisk full(500);
      write();
      failure = Finish(exported, failed);
    }
    EXPECT_NE(failure.find(name), std::string::npos) << failure;
    EXPECT_EQ(Content(path), "old");
    if (::geteuid() != 0) { // root may write every file
      QFile::setPermissions(path, QFileDevice::ReadOwner);
      write();
      EXPECT_NE(Finish(exported, failed).find(name), std::string::npos);
    }
    EXPECT_TRUE(Content(path) == "old") << name;
  }
  for (const char* closed : {"/no/such/folder/a.svg", "/proc/a.svg"}) { // a disk for reading only
    widget.ExportSvg(closed);
    EXPECT_NE(Finish(exported, failed).find(closed), std::string::npos);
  }
  EXPECT_EQ(QDir(folder.path()).entryList(QDir::Files | QDir::Hidden).size(), 3);
}

TEST_F(TelemetryPlot, ClosingWhileATableIsWrittenLeavesTheOldOne) {
  auto plot = std::make_unique<TelemetryPlotWidget>();
  plot->AddSeries("a", "m", Line(0.0, 1e4, 0.0, 1.0, 3000000));
  const QString path = folder.filePath("a.csv");
  std::ofstream(path.toStdString()) << "old";
  plot->ExportCsv(path);
  QTest::qWait(20);
  plot.reset();
  EXPECT_TRUE(Content(path) == "old");
  EXPECT_EQ(QDir(folder.path()).entryList(QDir::Files | QDir::Hidden).size(), 1);
}

// Every size, with many long names, is painted.
TEST_F(TelemetryPlot, AnySizeAndManySeriesArePainted) {
  for (int i = 0; i < 40; ++i) {
    widget.AddSeries(QString("rover/a/long/name/of/a/channel/%1").arg(i), QString("u%1").arg(i % 5),
                     Line(8.1e8, 8.1e8 + 60.0, -i, 1e-7 * i, 50));
  }
  widget.SetCursor(0, 8.1e8 + 10.0);
  widget.SetCurrentTime(8.1e8 + 30.0);
  for (const QSize& size : {QSize(160, 120), QSize(1, 1), QSize(300, 900), QSize(2000, 130)}) {
    widget.resize(size);
    EXPECT_FALSE(widget.grab().isNull());
  }
}

TEST_F(TelemetryPlot, CursorsLeaveTheCurvesTheirHeight) {
  const char* const units[] = {"deg", "deg", "W", "W", "V", "A"};
  for (int i = 0; i < 6; ++i) {
    widget.AddSeries(QString("channel %1").arg(i), units[i], Line(0.0, 100.0, i, i + 3.0, 101));
  }
  const double line = std::ceil(QFontMetricsF(widget.font()).height());
  // As docks under views give them room: low and wide, higher, low and narrow.
  const QSize sizes[] = {{580, 118}, {580, 230}, {580, 400}, {300, 118}, {1200, 140}};
  for (const QSize& size : sizes) {
    widget.SetCursor(0, {});
    widget.SetCursor(1, {});
    widget.resize(size);
    const double before = widget.PlotArea().height();
    EXPECT_TRUE(widget.ReadoutArea().isEmpty());
    EXPECT_GT(before, 3.0 * line) << size.width() << " x " << size.height();
    widget.SetCursor(0, 20.0);
    widget.SetCursor(1, 70.0);
    const QRectF area = widget.PlotArea();
    EXPECT_GE(area.height(), std::min(before, 5.0 * line))
        << size.width() << " x " << size.height();
    EXPECT_GT(area.width(), 4.0 * line) << size.width() << " x " << size.height();
    EXPECT_FALSE(area.intersects(widget.ReadoutArea()));
    EXPECT_TRUE(QRectF(widget.rect()).contains(area));
  }
  // The read-outs are there where there is room.
  widget.resize(580, 118); // beside
  EXPECT_GT(widget.ReadoutArea().left(), widget.PlotArea().right());
  widget.resize(580, 400); // below
  EXPECT_GT(widget.ReadoutArea().top(), widget.PlotArea().bottom());
}
