// Poses of many frames at once, as rows of numbers, against poses of one frame at a time.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "FrameTestSupport.h"

#include <dspace/FrameRules.h>

namespace {

using namespace dspace;

} // namespace

// Many at once are one at a time, to the bit: also quaternions around the edge of what is stored as
// it is, and whatever the call before was about.
TEST(FrameRows, PosesOfManyAreThoseOfEachByItself) {
  FrameTree many;
  FrameTree each;
  std::vector<FrameId> ids;
  for (int i = 0; i < 60; ++i) {
    const FrameId parent = i % 3 == 0 ? RootFrame : ids.back();
    ids.push_back(many.Create(parent, "f" + std::to_string(i)));
    ASSERT_EQ(each.Create(parent, "f" + std::to_string(i)), ids.back());
  }
  std::mt19937 random(7);
  std::uniform_real_distribution<double> side(-1, 1);
  int kept = 0;
  for (int call = 0; call < 300; ++call) {
    if (call % 50 == 49) { // slots move
      const FrameId moved = ids[std::size_t(call / 50)];
      many.Reparent(moved, ids[45], false);
      each.Reparent(moved, ids[45], false);
    }
    if (call == 120) {
      std::vector<FrameId> removed = many.Remove(ids[57]);
      EXPECT_EQ(each.Remove(ids[57]), removed);
      ids.resize(57);
    }
    std::vector<FrameId> some = ids;
    if (call % 3 > 0) { // else the same again and again
      std::shuffle(some.begin(), some.end(), random);
      some.resize(1 + random() % some.size());
    }
    std::vector<double> rows;
    for (std::size_t i = 0; i < some.size(); ++i) {
      Eigen::Vector4d q(side(random), side(random), side(random), side(random));
      q.normalize();
      // Off by up to 16 roundings, or by up to 0.9 of what is accepted.
      q *= 1.0 + side(random) * (random() % 2 ? 16 * 0x1p-53 : 0.9e-6);
      const double row[8] = {1e3 * side(random), 0, 0, q[0], q[1], q[2], q[3], double(1 + i)};
      rows.insert(rows.end(), row, row + 8);
      each.SetLocalPose(some[i], PoseFromRow(row));
    }
    many.SetLocalPoses(some.data(), rows.data(), some.size());
    for (std::size_t i = 0; i < some.size(); ++i) {
      const Pose& stored = many.LocalPose(some[i]);
      ASSERT_EQ(stored, each.LocalPose(some[i])) << "call " << call << ", row " << i;
      kept += stored == PoseFromRow(&rows[8 * i]) ? 1 : 0;
    }
    ASSERT_EQ(many.WorldPose(ids.back()), each.WorldPose(ids.back()));
  }
  EXPECT_GT(kept, 1000); // and as many others
}

// Where the tolerance ends is the same for both, to the last bit.
TEST(FrameRows, TheToleranceOfManyIsThatOfOne) {
  FrameTree tree;
  const FrameId a = tree.Create(RootFrame, "a");
  int rejected = 0;
  for (int i = -50; i < 50; ++i) {
    for (const double edge : {1.0 + UnitQuaternionTolerance, 1.0 - UnitQuaternionTolerance,
                              1.0 + UnitQuaternionTolerance / 2}) {
      const double row[8] = {0, 0, 0, 0.6 * (edge + i * 0x1p-53), 0, 0.8 * edge, 0, 1};
      const bool valid = IsValidPose(PoseFromRow(row));
      rejected += valid ? 0 : 1;
      if (valid) {
        EXPECT_NO_THROW(tree.SetLocalPoses(&a, row, 1));
      } else {
        EXPECT_THROW(tree.SetLocalPoses(&a, row, 1), Error);
      }
    }
  }
  EXPECT_GT(rejected, 20);
  EXPECT_LT(rejected, 180);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double most = MaximumCoordinate;
  const double over = std::nextafter(most, 2 * most);
  for (int column = 0; column < 8; ++column) {
    for (const double bad : {nan, over, -over, HUGE_VAL}) {
      double row[8] = {most, -most, most, 1, 0, 0, 0, MaximumScale};
      EXPECT_NO_THROW(tree.SetLocalPoses(&a, row, 1));
      row[column] = bad;
      EXPECT_THROW(tree.SetLocalPoses(&a, row, 1), Error) << "column " << column;
    }
  }
}
