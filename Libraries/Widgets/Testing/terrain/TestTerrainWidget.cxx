// The terrains of a scene, with a stand-in for its session.
#include <dspace/widgets/terrain/TerrainWidget.h>

#include <QComboBox>
#include <QSignalSpy>
#include <QSlider>
#include <QStackedWidget>
#include <QToolButton>
#include <QtTest>
#include <gtest/gtest.h>

#include "OneApplication.h"

#include <dspace/widgets/terrain/LayerList.h>
#include <dspace/widgets/terrain/RampLegend.h>
#include <dspace/widgets/terrain/StyleEditor.h>

using dspace::widgets::TerrainWidget;

namespace {

class TerrainWidgetTest : public ::testing::Test {
protected:
  void SetUp() override {
    this->names = {"ground", "other"};
    auto* ramp = this->style.mutable_ramp();
    ramp->set_by(dspace::v1::StyleTerrain::Ramp::SLOPE);
    ramp->set_low(1.0);
    ramp->set_high(25.0);
    ramp->set_opacity(1.0);
    for (const double level : {0.0, 1.0}) {
      auto* color = ramp->add_color();
      color->set_r(level);
      color->set_g(level);
      color->set_b(level);
    }
    auto* photo = this->layers.add_layer();
    photo->set_name("photo");
    photo->set_visible(true);
    photo->set_opacity(1.0);
    auto* rocks = this->layers.add_layer();
    rocks->set_name("rocks");
    rocks->set_kind(dspace::v1::TerrainLayerReply::FALSE_COLOR);
    rocks->set_visible(true);
    rocks->set_opacity(0.5);
    rocks->set_position(1);
    rocks->set_unit("%");
    rocks->set_high(30.0);
    *rocks->add_color() = ramp->color(0);
    *rocks->add_color() = ramp->color(1);
    this->widget.SetSource([this] {
      TerrainWidget::Shown shown;
      if (this->present) {
        shown.execute = [this](const std::string& bytes) { return this->Reply(bytes); };
      }
      shown.scene = "scene";
      shown.canChange = this->canChange;
      shown.busy = this->busy;
      return shown;
    });
    this->widget.resize(320, 700);
    this->widget.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&this->widget));
  }
  std::string Reply(const std::string& bytes) {
    dspace::v1::Command command;
    EXPECT_TRUE(command.ParseFromString(bytes));
    EXPECT_EQ(command.scene(), "scene");
    dspace::v1::Reply reply;
    using C = dspace::v1::Command;
    switch (command.command_case()) {
    case C::kListTerrains:
      reply.mutable_terrains();
      for (const std::string& name : this->names) {
        reply.mutable_terrains()->add_name(name);
      }
      break;
    case C::kDescribeTerrain:
      reply.mutable_terrain()->set_mode(command.describe_terrain().terrain() == "ground"
                                            ? dspace::v1::OpenTerrain::CLIPMAP
                                            : dspace::v1::OpenTerrain::TRIANGLES);
      break;
    case C::kListTerrainLayers:
      if (command.list_terrain_layers().terrain() == "ground") {
        *reply.mutable_terrain_layers() = this->layers;
      }
      break;
    case C::kDescribeTerrainStyle:
      *reply.mutable_terrain_style()->mutable_ramp() = this->style.ramp();
      *reply.mutable_terrain_style()->mutable_given() = this->style;
      break;
    default:
      break;
    }
    return reply.SerializeAsString();
  }
  bool Told(const QString& change) {
    QTest::qWait(0);
    return !this->changes.isEmpty() && this->changes.takeLast()[0].toString() == change;
  }
  int Page() { return this->widget.findChild<QStackedWidget*>()->currentIndex(); }

  std::vector<std::string> names;
  dspace::v1::StyleTerrain style;
  dspace::v1::TerrainLayerList layers;
  bool present = true;
  bool canChange = true;
  bool busy = false;
  TerrainWidget widget;
  QSignalSpy changes{&widget, &TerrainWidget::changeWanted};
};

} // namespace

TEST_F(TerrainWidgetTest, ShowsTheChosenTerrainWithItsLegend) {
  EXPECT_EQ(this->widget.Terrain(), "ground");
  EXPECT_EQ(this->widget.Layers()->topLevelItemCount(), 2);
  const auto& entries = this->widget.Legend()->Entries();
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].title, "Slope [deg]");
  EXPECT_EQ(entries[0].low, 1.0);
  EXPECT_EQ(entries[0].high, 25.0);
  EXPECT_EQ(entries[1].title, "rocks [%], 50 % opaque");
  EXPECT_EQ(entries[1].high, 30.0);
  this->style.mutable_ramp()->set_high(12.0);
  this->layers.mutable_layer(1)->set_visible(false);
  EXPECT_TRUE(QTest::qWaitFor([&] { return this->widget.Legend()->Entries().size() == 1; },
                              5000)); // by itself
  EXPECT_EQ(this->widget.Legend()->Entries()[0].high, 12.0);
  this->widget.findChild<QComboBox*>("terrains")->setCurrentIndex(1);
  EXPECT_EQ(this->widget.Terrain(), "other");
  EXPECT_EQ(this->widget.Layers()->topLevelItemCount(), 0);
  EXPECT_FALSE(this->widget.Style()->findChild<QComboBox*>("ramp")->isEnabled()); // triangles
  EXPECT_TRUE(this->widget.Legend()->Entries().empty());
  EXPECT_EQ(this->changes.size(), 0);
}

TEST_F(TerrainWidgetTest, TellsChangesOfTheSelectedLayer) {
  this->widget.Layers()->Select("rocks");
  auto* opacity = this->widget.findChild<QSlider*>("opacity");
  EXPECT_EQ(opacity->value(), 50);
  QTest::keyClick(opacity, Qt::Key_Right);
  EXPECT_TRUE(this->Told(R"(terrains["ground"].layer("rocks").opacity = 0.51)"));
  EXPECT_TRUE(QTest::qWaitFor([&] { return opacity->value() == 50; }, 5000)); // nobody did it
  QTest::mouseClick(this->widget.findChild<QToolButton*>("down"), Qt::LeftButton);
  EXPECT_TRUE(this->Told(R"(terrains["ground"].layer("rocks").position = 0)"));
  EXPECT_FALSE(this->widget.findChild<QToolButton*>("up")->isEnabled()); // it is the top
  QTest::mouseClick(this->widget.findChild<QToolButton*>("remove"), Qt::LeftButton);
  EXPECT_TRUE(this->Told(R"(terrains["ground"].layer("rocks").remove())"));
  emit this->widget.Layers()->visibleWanted("photo", false);
  EXPECT_TRUE(this->Told(R"(terrains["ground"].layer("photo").visible = False)"));
  emit this->widget.Style()->styleWanted("levels=0.5");
  EXPECT_TRUE(this->Told(R"(terrains["ground"].change_style(levels=0.5))"));
  this->widget.AddLayer("image", "/a \"b\".tif");
  EXPECT_TRUE(this->Told(R"(terrains["ground"].add_image("/a \"b\".tif"))"));
  this->widget.AddLayer("field", "ice");
  EXPECT_TRUE(this->Told(R"(terrains["ground"].add_false_color(field="ice"))"));
}

TEST_F(TerrainWidgetTest, ShowsThatThereIsNoTerrainAndChangesNothingOfARecording) {
  EXPECT_EQ(this->Page(), 1);
  this->canChange = false;
  this->widget.Refresh();
  for (const char* name : {"add", "remove", "up", "down"}) {
    EXPECT_FALSE(this->widget.findChild<QToolButton*>(name)->isEnabled()) << name;
  }
  EXPECT_FALSE(this->widget.findChild<QSlider*>("opacity")->isEnabled());
  EXPECT_FALSE(this->widget.Style()->findChild<QComboBox*>("ramp")->isEnabled());
  EXPECT_EQ(this->widget.Legend()->Entries().size(), 2u);
  this->busy = true; // between two steps
  this->present = false;
  this->widget.Refresh();
  EXPECT_EQ(this->Page(), 1);
  this->busy = false;
  this->widget.Refresh();
  EXPECT_EQ(this->Page(), 0);
  this->present = true;
  this->names.clear();
  this->widget.Refresh();
  EXPECT_EQ(this->Page(), 0);
}
