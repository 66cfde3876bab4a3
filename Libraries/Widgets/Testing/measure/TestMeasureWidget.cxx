// The Measure dock's widget and its chart: which points are asked for, and what is shown of
// results.
#include <cmath>

#include <QApplication>
#include <QClipboard>
#include <QJsonArray>
#include <QLabel>
#include <QPushButton>
#include <QSignalSpy>
#include <QTableWidget>
#include <QToolButton>
#include <QtTest>
#include <gtest/gtest.h>

#include "OneApplication.h"

#include <dspace/widgets/measure/MeasureWidget.h>
#include <dspace/widgets/measure/ProfileChart.h>
#include <dspace/widgets/settings/DisplayUnits.h>

using dspace::widgets::DisplayUnits;
using dspace::widgets::MeasureWidget;
using dspace::widgets::ProfileChart;
using dspace::widgets::UnitChoice;

namespace {

class MeasureWidgetTest : public ::testing::Test {
protected:
  void SetUp() override {
    this->widget.resize(320, 520);
    this->widget.show();
  }
  void TearDown() override { DisplayUnits::The().Set({}); }
  QString Asked(int i) const { return this->asked.at(i).at(0).toString(); }
  static QJsonObject Result() {
    return {{"kind", "line"},
            {"points", QJsonArray{QJsonArray{0, 0, 0}, QJsonArray{30, 0, 0}}},
            {"rows", QJsonArray{QJsonArray{"Distance", 1234.5, "length"},
                                QJsonArray{"Azimuth", 90, "angle"},
                                QJsonArray{"Rise", QJsonValue(), "length"},
                                QJsonArray{"Area", 2e6, "area"}, QJsonArray{"Data", 0.5, "share"}}},
            {"profile", QJsonObject{{"distance", QJsonArray{0, 10, 20, 30}},
                                    {"height", QJsonArray{1, 2, QJsonValue(), 3}},
                                    {"point", QJsonArray{QJsonArray{0, 0, 1}, QJsonArray{10, 0, 2},
                                                         QJsonArray{20, 0, QJsonValue()},
                                                         QJsonArray{30, 0, 3}}}}}};
  }

  MeasureWidget widget;
  QSignalSpy asked{&widget, &MeasureWidget::measureWanted};
};

} // namespace

TEST_F(MeasureWidgetTest, PointsOfAToolAreMeasuredOnceThereAreEnough) {
  this->widget.Add({1, 2, 3}, "ground");
  EXPECT_TRUE(this->widget.Points().empty()); // no tool
  this->widget.findChild<QToolButton*>("tool line")->click();
  EXPECT_EQ(this->widget.Used(), "line");
  this->widget.Add({1, 2, 3}, "");
  EXPECT_EQ(this->asked.count(), 0);
  this->widget.Add({4, 5, 0.1}, "ground");
  ASSERT_EQ(this->asked.count(), 1);
  EXPECT_EQ(this->Asked(0).toStdString(),
            R"(app.measure("line", [(1, 2, 3), (4, 5, 0.1)], terrain="ground"))");
  this->widget.Add({7, 8, 9}, "other");
  EXPECT_TRUE(this->Asked(1).endsWith(R"((7, 8, 9)], terrain="ground"))"));
  this->widget.findChild<QPushButton*>("last")->click();
  EXPECT_EQ(this->Asked(2), this->Asked(0));
  this->widget.findChild<QPushButton*>("clear")->click();
  EXPECT_TRUE(this->widget.Points().empty());
  // An angle takes three points, and the fourth starts anew.
  this->widget.Use("angle");
  for (double x = 0; x < 4; ++x) {
    this->widget.Add({x, x * x, 0}, "ground");
  }
  ASSERT_EQ(this->asked.count(), 4);
  EXPECT_EQ(this->Asked(3).toStdString(),
            R"(app.measure("angle", [(0, 0, 0), (1, 1, 0), (2, 4, 0)]))");
  EXPECT_EQ(this->widget.Points().size(), 1u);
  this->widget.findChild<QToolButton*>("tool angle")->click(); // put down
  EXPECT_EQ(this->widget.Used(), "");
}

TEST_F(MeasureWidgetTest, ResultsAreInTheUnitsOfThePreferences) {
  this->widget.Show(Result());
  EXPECT_EQ(this->widget.Text().toStdString(),
            "Distance\t1234.500 m\nAzimuth\t90.0000\u00b0\nRise\tno data\nArea\t2000000 m\u00b2\n"
            "Data\t50.0 %");
  UnitChoice units;
  units.length = UnitChoice::Length::Kilometre;
  units.angle = UnitChoice::Angle::Radian;
  DisplayUnits::The().Set(units);
  EXPECT_TRUE(this->widget.Text().startsWith("Distance\t1.234500 km\nAzimuth\t1.5707"));
  EXPECT_TRUE(this->widget.Text().contains("Area\t2 km\u00b2"));
  EXPECT_EQ(this->widget.findChild<QTableWidget*>("results")->item(0, 1)->text(), "1.234500 km");
  this->widget.findChild<QPushButton*>("copy")->click();
  EXPECT_EQ(QApplication::clipboard()->text(), this->widget.Text());
}

TEST_F(MeasureWidgetTest, ThePointerOverTheChartMarksAPlace) {
  this->widget.Show(Result());
  ProfileChart* chart = this->widget.Chart();
  EXPECT_EQ(chart->SampleCount(), 4);
  EXPECT_EQ(this->widget.Path().size(), 4u);
  EXPECT_FALSE(this->widget.IsClosed());
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&this->widget));
  EXPECT_FALSE(this->widget.Pointed());
  QSignalSpy marks(&this->widget, &MeasureWidget::marksChanged);
  QTest::mouseMove(chart, QPoint(chart->width() - 10, chart->height() / 2));
  QCoreApplication::processEvents();
  ASSERT_TRUE(this->widget.Pointed());
  EXPECT_EQ((*this->widget.Pointed())[0], 30.0);
  EXPECT_GE(marks.count(), 1);
  // The curve is drawn over more than half of the chart's width: data left of the gap.
  const QImage picture = chart->grab().toImage();
  int brown = 0;
  for (int x = 0; x < picture.width(); ++x) {
    bool any = false;
    for (int y = 0; y < picture.height(); ++y) {
      const QColor color = picture.pixelColor(x, y);
      any = any || (std::abs(color.red() - 0x8a) < 12 && std::abs(color.green() - 0x6d) < 12 &&
                    std::abs(color.blue() - 0x4b) < 12);
    }
    brown += any ? 1 : 0;
  }
  EXPECT_GT(brown, picture.width() / 5);
  EXPECT_LT(brown, picture.width() / 2);
  this->widget.Clear();
  EXPECT_EQ(chart->SampleCount(), 0);
  EXPECT_EQ(chart->Exaggeration(), 0.0);
}
