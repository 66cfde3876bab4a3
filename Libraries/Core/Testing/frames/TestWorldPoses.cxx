// Root-relative poses by slot, and the reordering of slots that they use.
#include <dspace/WorldPoses.h>

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/Rearrange.h>

using namespace dspace;

namespace {

Pose At(double x) {
  Pose pose;
  pose.position = Eigen::Vector3d(x, 0, 0);
  return pose;
}

} // namespace

TEST(Rearrange, PermutesAndErasesWithinTheRange) {
  std::vector<int> values = {10, 11, 12, 13, 14, 15};
  Rearrange(values, 1, 4, {3, 1, 2});
  EXPECT_EQ(values, (std::vector<int>{10, 13, 11, 12, 14, 15}));
  Rearrange(values, 2, 6, {5, 3}); // 11 and 14 are erased
  EXPECT_EQ(values, (std::vector<int>{10, 13, 15, 12}));
  Rearrange(values, 0, 2, {});
  EXPECT_EQ(values, (std::vector<int>{15, 12}));
}

TEST(Rearrange, MovesValuesThatCannotBeCopied) {
  std::vector<std::unique_ptr<int>> values;
  for (const int i : {0, 1, 2}) {
    values.push_back(std::make_unique<int>(i));
  }
  Rearrange(values, 0, 3, {2, 0});
  ASSERT_EQ(values.size(), 2u);
  EXPECT_EQ(*values[0], 2);
  EXPECT_EQ(*values[1], 0);
}

// Slots: root 0, a 1, b 2 (child of a), c 3 (child of the root).
class WorldPosesOfFour : public testing::Test {
protected:
  WorldPosesOfFour() {
    for (const WorldPoses::SlotIndex slot : {1u, 2u, 3u}) {
      this->World_.Append();
      this->World_.Mark(slot);
    }
    this->World_.Evaluate(this->Parents_, this->Local_, 1);
  }

  WorldPoses World_;
  std::vector<WorldPoses::SlotIndex> Parents_ = {0, 0, 1, 0};
  std::vector<Pose> Local_ = {Pose(), At(1), At(10), At(100)};
};

TEST_F(WorldPosesOfFour, EvaluatesMarkedSlotsAndTheirDescendantsOnly) {
  EXPECT_EQ(this->World_.Get(2).position.x(), 11.0);
  EXPECT_EQ(this->World_.Get(3).position.x(), 100.0);
  EXPECT_EQ(this->World_.Evaluations(), 3u);

  this->Local_[1] = At(2);
  this->World_.Mark(1);
  this->World_.Evaluate(this->Parents_, this->Local_, 2);
  EXPECT_EQ(this->World_.Get(1).position.x(), 2.0);
  EXPECT_EQ(this->World_.Get(2).position.x(), 12.0);
  EXPECT_EQ(this->World_.ChangedAt(1), 2u);
  EXPECT_EQ(this->World_.ChangedAt(2), 2u);
  EXPECT_EQ(this->World_.ChangedAt(3), 1u); // not below the marked slot
  EXPECT_EQ(this->World_.ChangedAt(0), 0u);
  EXPECT_EQ(this->World_.Evaluations(), 5u);

  this->World_.Evaluate(this->Parents_, this->Local_, 3); // nothing is marked
  EXPECT_EQ(this->World_.Evaluations(), 5u);
}

TEST_F(WorldPosesOfFour, KeepsMarksAndPosesWhenSlotsMove) {
  this->Local_[3] = At(200);
  this->World_.Mark(3);
  this->World_.Reorder(1, 4, {3, 1, 2}); // c, a, b
  this->Parents_ = {0, 0, 0, 2};
  this->Local_ = {Pose(), At(200), At(1), At(10)};
  EXPECT_EQ(this->World_.Get(3).position.x(), 11.0); // b
  this->World_.Evaluate(this->Parents_, this->Local_, 2);
  EXPECT_EQ(this->World_.Get(1).position.x(), 200.0);
  EXPECT_EQ(this->World_.ChangedAt(1), 2u);
  EXPECT_EQ(this->World_.ChangedAt(2), 1u);
  EXPECT_EQ(this->World_.Evaluations(), 4u);
}
