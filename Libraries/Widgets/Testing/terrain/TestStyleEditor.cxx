// The controls of a style: what they show, and what they tell.
#include <dspace/widgets/terrain/StyleEditor.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QPushButton>
#include <QSignalSpy>
#include <QtTest>
#include <gtest/gtest.h>

#include "OneApplication.h"

using dspace::widgets::StyleEditor;
using dspace::widgets::TerrainState;

namespace {

class StyleEditorTest : public ::testing::Test {
protected:
  void SetUp() override {
    this->state.layered = true;
    auto* ramp = this->state.style.mutable_ramp();
    ramp->set_by(dspace::v1::StyleTerrain::Ramp::HEIGHT);
    ramp->set_low(-10.0004);
    ramp->set_high(20.0);
    ramp->set_opacity(0.5);
    auto* grid = this->state.style.mutable_grid();
    grid->set_interval(50.0);
    grid->mutable_color()->set_r(1.0);
    this->editor.Show(this->state);
    this->editor.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&this->editor));
  }
  QDoubleSpinBox* Number(const QString& name) {
    return this->editor.findChild<QDoubleSpinBox*>(name);
  }
  void Enter(const QString& name, const QString& text) {
    this->Number(name)->selectAll();
    QTest::keyClicks(this->Number(name), text);
    QTest::keyClick(this->Number(name), Qt::Key_Return);
  }
  std::string Told() {
    return this->told.isEmpty() ? "" : this->told.takeLast()[0].toString().toStdString();
  }

  TerrainState state;
  StyleEditor editor;
  QSignalSpy told{&editor, &StyleEditor::styleWanted};
};

} // namespace

TEST_F(StyleEditorTest, ShowsTheStyleAndTellsNothing) {
  EXPECT_EQ(this->editor.findChild<QComboBox*>("ramp")->currentText(), "height [m]");
  EXPECT_NEAR(this->Number("low")->value(), -10.0, 1e-9);
  EXPECT_EQ(this->Number("high")->value(), 20.0);
  EXPECT_EQ(this->Number("ramp opacity")->value(), 0.5);
  EXPECT_TRUE(this->editor.findChild<QCheckBox*>("grid")->isChecked());
  EXPECT_EQ(this->Number("grid interval")->value(), 50.0);
  EXPECT_FALSE(this->editor.findChild<QCheckBox*>("contours")->isChecked());
  EXPECT_TRUE(this->editor.findChild<QCheckBox*>("grid labels")->isEnabled());
  EXPECT_EQ(this->told.size(), 0);
}

TEST_F(StyleEditorTest, TellsEachChange) {
  this->Enter("high", "30");
  EXPECT_EQ(this->Told(), "range=(-10.0004, 30)"); // the other end is not rounded
  this->Enter("ramp opacity", "0.75");
  EXPECT_EQ(this->Told(), "opacity=0.75");
  this->Enter("contours interval", "2.5");
  EXPECT_EQ(this->told.size(), 0); // they are not shown
  QTest::mouseClick(this->editor.findChild<QCheckBox*>("contours"), Qt::LeftButton, {}, {8, 8});
  EXPECT_EQ(this->Told(), R"(contours={"interval": 2.5, "color": "#000000"})");
  this->Enter("grid interval", "100");
  EXPECT_EQ(this->Told(), R"(grid={"interval": 100, "color": "#ff0000"})");
  QTest::mouseClick(this->editor.findChild<QCheckBox*>("grid"), Qt::LeftButton, {}, {8, 8});
  EXPECT_EQ(this->Told(), "grid=None");
  QTest::mouseClick(this->editor.findChild<QCheckBox*>("levels"), Qt::LeftButton, {}, {8, 8});
  EXPECT_EQ(this->Told(), "levels=0.5");
  auto* by = this->editor.findChild<QComboBox*>("ramp");
  QTest::keyClick(by, Qt::Key_Down);
  EXPECT_EQ(this->Told(), R"(color_by="slope", opacity=0.75)");
  QTest::keyClick(by, Qt::Key_Home);
  EXPECT_EQ(this->Told(), "color_by=None");
  EXPECT_EQ(this->told.size(), 0);
  QSignalSpy sun(&this->editor, &StyleEditor::sunWanted);
  QTest::mouseClick(this->editor.findChild<QPushButton*>("sun"), Qt::LeftButton);
  ASSERT_EQ(sun.size(), 1);
  EXPECT_EQ(sun[0][0].toDouble(), 315.0);
  EXPECT_EQ(sun[0][1].toDouble(), 45.0);
}

TEST_F(StyleEditorTest, IsDisabledWhereNothingCanBeChanged) {
  this->state.canChange = false;
  this->editor.Show(this->state);
  const auto disabled = [this](bool sun) {
    for (const QWidget* each : this->editor.findChildren<QWidget*>()) {
      const bool ofSun = each->objectName() == "azimuth" || each->objectName() == "elevation" ||
                         each->objectName() == "sun";
      if (each->parentWidget() == &this->editor && !each->inherits("QLabel") &&
          each->isEnabled() != (ofSun && sun)) {
        ADD_FAILURE() << each->objectName().toStdString();
      }
    }
  };
  disabled(false);
  this->state.canChange = true;
  this->state.layered = false;
  this->editor.Show(this->state);
  disabled(true); // triangles, which the Sun shades
  EXPECT_TRUE(this->editor.toolTip().contains("clipmap"));
}
