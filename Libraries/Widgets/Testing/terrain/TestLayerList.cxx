// The rows of layers, and what the user asks for by mouse and keyboard.
#include <dspace/widgets/terrain/LayerList.h>

#include <QSignalSpy>
#include <QtTest>
#include <gtest/gtest.h>

#include "OneApplication.h"

using dspace::widgets::LayerList;

namespace {

class LayerListTest : public ::testing::Test {
protected:
  void SetUp() override {
    for (const char* name : {"photo", "slope", "craters"}) { // from the bottom
      auto* layer = this->layers.add_layer();
      layer->set_name(name);
      layer->set_kind(dspace::v1::TerrainLayerReply::IMAGE);
      layer->set_visible(true);
      layer->set_opacity(0.25);
      layer->set_position(this->layers.layer_size() - 1);
    }
    this->list.resize(300, 160);
    this->list.Show(this->layers);
    this->list.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&this->list));
  }

  dspace::v1::TerrainLayerList layers;
  LayerList list;
};

} // namespace

TEST_F(LayerListTest, ShowsTheTopLayerFirstAndKeepsTheSelection) {
  ASSERT_EQ(this->list.topLevelItemCount(), 3);
  EXPECT_EQ(this->list.topLevelItem(0)->text(0), "craters");
  EXPECT_EQ(this->list.topLevelItem(2)->text(0), "photo");
  EXPECT_EQ(this->list.topLevelItem(2)->text(1), "image");
  EXPECT_EQ(this->list.topLevelItem(2)->text(2), "25 %");
  EXPECT_EQ(this->list.Selected(), "craters");
  this->list.Select("slope");
  this->layers.mutable_layer()->SwapElements(0, 2);
  this->list.Show(this->layers);
  EXPECT_EQ(this->list.topLevelItem(0)->text(0), "photo");
  EXPECT_EQ(this->list.Selected(), "slope");
}

TEST_F(LayerListTest, TellsWhatTheUserAsksFor) {
  QSignalSpy visible(&this->list, &LayerList::visibleWanted);
  QSignalSpy position(&this->list, &LayerList::positionWanted);
  QSignalSpy removed(&this->list, &LayerList::removeWanted);
  this->list.Select("slope");
  QTest::keyClick(&this->list, Qt::Key_Space); // the check box
  ASSERT_EQ(visible.size(), 1);
  EXPECT_EQ(visible[0][0].toString(), "slope");
  EXPECT_FALSE(visible[0][1].toBool());
  QTest::keyClick(&this->list, Qt::Key_Up, Qt::AltModifier);
  ASSERT_EQ(position.size(), 1);
  EXPECT_EQ(position[0][0].toString(), "slope");
  EXPECT_EQ(position[0][1].toInt(), 2); // the top, counted from the bottom
  QTest::keyClick(&this->list, Qt::Key_Delete);
  ASSERT_EQ(removed.size(), 1);
  EXPECT_EQ(removed[0][0].toString(), "slope");
}

TEST_F(LayerListTest, OnlyShowsWhatCannotBeChanged) {
  this->list.Show(this->layers, false);
  QSignalSpy visible(&this->list, &LayerList::visibleWanted);
  QSignalSpy position(&this->list, &LayerList::positionWanted);
  QSignalSpy removed(&this->list, &LayerList::removeWanted);
  this->list.Select("slope");
  QTest::keyClick(&this->list, Qt::Key_Space);
  QTest::keyClick(&this->list, Qt::Key_Up, Qt::AltModifier);
  QTest::keyClick(&this->list, Qt::Key_Delete);
  EXPECT_EQ(visible.size() + position.size() + removed.size(), 0);
}
