// The table shows every channel, touches only what changes, and is searched, sorted and dragged.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>

#include <QDrag>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QTableView>
#include <QtTest>

#include "OneApplication.h"

#include <dspace/state/Telemetry.h>
#include <dspace/widgets/telemetry/ChannelMime.h>
#include <dspace/widgets/telemetry/TelemetryModel.h>
#include <dspace/widgets/telemetry/TelemetryTableWidget.h>

using dspace::session::Telemetry;
using dspace::widgets::TelemetryModel;
using dspace::widgets::TelemetryTableWidget;
namespace v1 = dspace::v1;

namespace {

struct TelemetryTable : ::testing::Test {
  std::unique_ptr<Telemetry> telemetry = std::make_unique<Telemetry>();
  TelemetryTableWidget widget;

  void SetUp() override {
    widget.SetSource([this] { return telemetry.get(); });
    widget.resize(800, 300);
    widget.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&widget));
  }
  std::uint64_t Number(const std::string& name, const std::string& unit = "",
                       const std::string& description = "") {
    v1::CreateTelemetry create;
    create.set_name(name);
    create.set_unit(unit);
    create.set_description(description);
    return telemetry->Create(create, telemetry->LastId() + 1);
  }
  void Limits(std::uint64_t id, double alarmLow, double low, double high, double alarmHigh) {
    v1::SetTelemetryLimits set;
    set.set_id(id);
    set.mutable_limits()->set_alarm_low(alarmLow);
    set.mutable_limits()->set_warning_low(low);
    set.mutable_limits()->set_warning_high(high);
    set.mutable_limits()->set_alarm_high(alarmHigh);
    telemetry->SetLimits(set);
  }
  void Set(std::uint64_t id, double value, double time_s = 0.0) {
    v1::SetTelemetry set;
    set.add_id(id);
    set.add_value(value);
    set.add_time_s(time_s);
    telemetry->Set(set, time_s);
  }
  void Remove(std::uint64_t id) {
    v1::RemoveTelemetry remove;
    remove.add_id(id);
    telemetry->Remove(remove);
  }
  // What the view shows, rows by '\n', the first columns by '|'.
  std::string Shown(int columns = 1) {
    std::string all;
    const QAbstractItemModel& model = *widget.View()->model();
    for (int row = 0; row < model.rowCount(); ++row) {
      for (int column = 0; column < columns; ++column) {
        all += (column ? "|"
                : row  ? "\n"
                       : "") +
               model.index(row, column).data().toString().toStdString();
      }
    }
    return all;
  }
  QVariant Cell(const QString& name, int column, int role = Qt::DisplayRole) {
    const int row = widget.Model()->RowOf(name);
    EXPECT_GE(row, 0) << name.toStdString();
    return widget.Model()->index(row, column).data(role);
  }
};

} // namespace

TEST_F(TelemetryTable, ShowsNamesValuesUnitsAndLimits) {
  const std::uint64_t torque = Number("wheel/torque", "N.m", "of the left wheel");
  Limits(torque, -20, -10, 40, 60.5);
  Set(torque, 1.0 / 3.0, 12.5);
  Number("empty", "V");
  v1::CreateTelemetry mode;
  mode.set_name("mode");
  mode.set_kind(v1::CreateTelemetry::CHOICE);
  auto* label = mode.add_label();
  label->set_value(2);
  label->set_label("DRIVE");
  Set(telemetry->Create(mode, telemetry->LastId() + 1), 2.0);
  v1::CreateTelemetry text;
  text.set_name("note");
  text.set_kind(v1::CreateTelemetry::TEXT);
  v1::SetTelemetryTexts set;
  set.add_id(telemetry->Create(text, telemetry->LastId() + 1));
  set.add_text("h\u00e9llo");
  telemetry->SetTexts(set, 1.0);
  widget.Refresh();
  EXPECT_EQ(Shown(7), "empty|\u2013|V||||\n"
                      "mode|DRIVE|||||\n"
                      "note|h\u00e9llo|||||\n"
                      "wheel/torque|0.333333333|N.m|-20|-10|40|60.5");
  const QString tip = Cell("wheel/torque", 1, Qt::ToolTipRole).toString();
  EXPECT_TRUE(tip.contains("of the left wheel")) << tip.toStdString();
  EXPECT_TRUE(tip.contains("0.3333333333333333 N.m")) << tip.toStdString(); // all digits
  EXPECT_TRUE(tip.contains("12.5 s")) << tip.toStdString();
}

TEST_F(TelemetryTable, ValuesBeyondLimitsHaveTheColoursOfTextTables) {
  const std::uint64_t id = Number("t", "Cel");
  Limits(id, -20, -10, 40, 60);
  const auto ground = [&](double value) {
    Set(id, value);
    widget.Refresh();
    return Cell("t", TelemetryModel::Value, Qt::BackgroundRole)
        .value<QColor>()
        .name()
        .toStdString();
  };
  EXPECT_EQ(ground(40.0), "#000000"); // on a limit is within it: no colour of its own
  EXPECT_FALSE(Cell("t", TelemetryModel::Value, Qt::BackgroundRole).isValid());
  EXPECT_EQ(ground(40.5), "#ffbf33"); // amber 1, 0.75, 0.2
  EXPECT_EQ(ground(-20.0), "#ffbf33");
  EXPECT_EQ(ground(61.0), "#ff594d"); // red 1, 0.35, 0.3
  EXPECT_EQ(ground(-21.0), "#ff594d");
  EXPECT_FALSE(Cell("t", TelemetryModel::Name, Qt::BackgroundRole).isValid());
  // New limits are enough.
  Limits(id, -100, -50, 40, 60);
  widget.Refresh();
  EXPECT_FALSE(Cell("t", TelemetryModel::Value, Qt::BackgroundRole).isValid());
  // And it is seen: the pixel beside the value's text.
  Set(id, 1000.0);
  widget.Refresh();
  const QRect cell =
      widget.View()->visualRect(widget.View()->model()->index(0, TelemetryModel::Value));
  const QImage image = widget.View()->viewport()->grab().toImage();
  EXPECT_EQ(image.pixelColor(cell.left() + 3, cell.center().y()).name().toStdString(), "#ff594d");
}

TEST_F(TelemetryTable, FollowsByItselfAndTouchesOnlyWhatChanged) {
  std::vector<std::uint64_t> ids;
  for (int i = 0; i < 100; ++i) {
    ids.push_back(Number("c" + std::to_string(100 + i)));
    Set(ids.back(), i);
  }
  ASSERT_TRUE(QTest::qWaitFor([&] { return widget.Model()->rowCount() == 100; }, 3000));
  QSignalSpy changed(widget.Model(), &QAbstractItemModel::dataChanged);
  QSignalSpy reset(widget.Model(), &QAbstractItemModel::modelReset);
  // Many changes of three rows in a second: at most 30 looks.
  QElapsedTimer clock;
  clock.start();
  double value = 0.5;
  while (clock.elapsed() < 1000) {
    for (const int i : {10, 11, 50}) {
      Set(ids[std::size_t(i)], value);
    }
    value += 1.0;
    QTest::qWait(2);
  }
  widget.hide();
  widget.Refresh(); // what came after the last look
  std::set<int> rows;
  for (const auto& each : changed) {
    for (int row = each[0].toModelIndex().row(); row <= each[1].toModelIndex().row(); ++row) {
      rows.insert(row);
    }
  }
  EXPECT_EQ(rows, (std::set<int>{10, 11, 50}));
  EXPECT_GE(changed.count(), 2 * 2); // two runs a look
  EXPECT_LE(changed.count(), 2 * 32);
  EXPECT_EQ(reset.count(), 0);
  // Hidden it does not look; what did not change is not told again.
  changed.clear();
  Set(ids[0], 77.0);
  QTest::qWait(120);
  EXPECT_EQ(changed.count(), 0);
  widget.show();
  EXPECT_EQ(changed.count(), 1);
  Set(ids[0], 77.0, 5.0); // the same value, later
  widget.Refresh();
  EXPECT_EQ(changed.count(), 1);
}

TEST_F(TelemetryTable, ChannelsComeAndGoAndSelectionsStay) {
  std::vector<std::uint64_t> ids;
  for (const char* name : {"b", "d", "f", "h"}) {
    ids.push_back(Number(name));
  }
  widget.Refresh();
  widget.View()->selectRow(2);
  EXPECT_EQ(widget.Selected(), QStringList{"f"});
  QSignalSpy reset(widget.Model(), &QAbstractItemModel::modelReset);
  Number("a");
  Number("c");
  Number("e");
  Number("z");
  Remove(ids[1]); // d
  Remove(ids[0]); // b, which comes again
  Set(Number("b", "new"), 4.0);
  widget.Refresh();
  EXPECT_EQ(Shown(3), "a|\u2013|\nb|4|new\nc|\u2013|\ne|\u2013|\nf|\u2013|\nh|\u2013|\nz|\u2013|");
  EXPECT_EQ(widget.Selected(), QStringList{"f"});
  EXPECT_EQ(reset.count(), 0);
  // Removing alone, another scene, none.
  Remove(ids[3]);
  widget.Refresh();
  EXPECT_EQ(Shown(), "a\nb\nc\ne\nf\nz");
  telemetry = std::make_unique<Telemetry>();
  Number("other");
  widget.Refresh();
  EXPECT_EQ(Shown(), "other");
  telemetry.reset();
  widget.Refresh();
  EXPECT_EQ(Shown(), "");
  const auto* empty = widget.View()->findChild<QLabel*>();
  ASSERT_NE(empty, nullptr);
  EXPECT_TRUE(empty->isVisible());
  EXPECT_EQ(empty->text(), "No telemetry channels");
}

TEST_F(TelemetryTable, SearchTakesAllWordsInAnyCase) {
  Number("rover/wheel_fl/torque", "N.m", "of the Motor");
  Number("rover/wheel_fr/torque", "N.m");
  Number("rover/battery", "V");
  widget.Refresh();
  QTest::keyClicks(widget.SearchField(), "TORQUE fl");
  EXPECT_EQ(Shown(), "rover/wheel_fl/torque");
  widget.SetSearch("n.m");
  EXPECT_EQ(Shown(), "rover/wheel_fl/torque\nrover/wheel_fr/torque");
  widget.SetSearch("motor");
  EXPECT_EQ(Shown(), "rover/wheel_fl/torque");
  widget.SetSearch("nothing");
  EXPECT_EQ(Shown(), "");
  EXPECT_TRUE(widget.View()->findChild<QLabel*>()->text().contains("nothing"));
  Number("nothing/else"); // a new channel that has it
  widget.Refresh();
  EXPECT_EQ(Shown(), "nothing/else");
  QTest::keyClick(widget.SearchField(), Qt::Key_Escape);
  EXPECT_EQ(widget.View()->model()->rowCount(), 4);
}

TEST_F(TelemetryTable, AClickOnATitleSortsNumbersBySize) {
  Set(Number("a"), 100.0);
  Set(Number("b"), -3.0);
  Number("c"); // no value: least
  Set(Number("d"), 20.0);
  widget.Refresh();
  const auto click = [&](int column) {
    const QHeaderView& header = *widget.View()->horizontalHeader();
    const QPoint place(header.sectionViewportPosition(column) + header.sectionSize(column) / 2,
                       header.height() / 2);
    QTest::mouseClick(header.viewport(), Qt::LeftButton, {}, place);
  };
  click(TelemetryModel::Value);
  const bool up = Shown() == "c\nb\nd\na";
  EXPECT_TRUE(up || Shown() == "a\nd\nb\nc") << Shown();
  click(TelemetryModel::Value);
  EXPECT_EQ(Shown(), up ? "a\nd\nb\nc" : "c\nb\nd\na");
  // Rows go to their new places.
  widget.View()->sortByColumn(TelemetryModel::Value, Qt::AscendingOrder);
  Set(telemetry->Get("a").about.id(), -50.0);
  widget.Refresh();
  EXPECT_EQ(Shown(), "c\na\nb\nd");
}

TEST_F(TelemetryTable, RowsAreDraggedAsChannelsAndActivated) {
  Number("x/a");
  Number("x/\u00e4");
  widget.Refresh();
  widget.View()->selectAll();
  const std::unique_ptr<QMimeData> data(
      widget.View()->model()->mimeData(widget.View()->selectionModel()->selectedIndexes()));
  ASSERT_NE(data, nullptr);
  EXPECT_TRUE(data->hasFormat("application/x-dspace-telemetry"));
  EXPECT_EQ(dspace::widgets::ChannelsOf(data.get()), (QStringList{"x/a", "x/\u00e4"}));
  EXPECT_EQ(data->text().toStdString(), "x/a\nx/\u00e4");
  EXPECT_TRUE(widget.View()->dragEnabled());
  EXPECT_TRUE(dspace::widgets::ChannelsOf(nullptr).isEmpty());
  QMimeData other;
  other.setText("x/a");
  EXPECT_TRUE(dspace::widgets::ChannelsOf(&other).isEmpty());

  QSignalSpy activated(&widget, &TelemetryTableWidget::activated);
  const QRect cell = widget.View()->visualRect(widget.View()->model()->index(1, 2));
  QTest::mouseClick(widget.View()->viewport(), Qt::LeftButton, {}, cell.center());
  QTest::mouseDClick(widget.View()->viewport(), Qt::LeftButton, {}, cell.center());
  ASSERT_EQ(activated.count(), 1);
  EXPECT_EQ(activated[0][0].toString(), "x/\u00e4");
  QTest::keyClick(widget.View(), Qt::Key_Return);
  EXPECT_EQ(activated.count(), 2);
}
