#include <gtest/gtest.h>

#include <dspace/render/DrawKey.h>

#include <memory>

namespace dspace {
namespace {

DrawKey KeyOf(double value) {
  DrawKey key;
  key.Add(value);
  return key;
}

TEST(DrawKey, EqualWhereTheBytesAre) {
  EXPECT_TRUE(DrawKey() == DrawKey());
  EXPECT_TRUE(KeyOf(1.5) == KeyOf(1.5));
  EXPECT_FALSE(KeyOf(1.5) == KeyOf(1.5 + 1e-15));
  EXPECT_FALSE(KeyOf(0.0) == KeyOf(-0.0)); // their pictures may differ
  EXPECT_FALSE(KeyOf(1.5) == DrawKey());
}

TEST(DrawKey, OrderCounts) {
  DrawKey forward = KeyOf(1.0);
  forward.Add(2.0);
  DrawKey backward = KeyOf(2.0);
  backward.Add(1.0);
  EXPECT_FALSE(forward == backward);
}

TEST(DrawKey, MatricesByTheirEntries) {
  const Eigen::Matrix2d m = (Eigen::Matrix2d() << 1, 2, 3, 4).finished();
  DrawKey a, b, c;
  a.AddMatrix(m);
  b.AddMatrix(m + Eigen::Matrix2d::Zero()); // an expression, not a matrix
  c.AddMatrix(m.transpose());
  EXPECT_TRUE(a == b);
  EXPECT_FALSE(a == c);
}

TEST(DrawKey, SharedDataByTheirIdentity) {
  const auto one = std::make_shared<const int>(7);
  const auto other = std::make_shared<const int>(7);
  DrawKey a, b, c;
  a.AddShared(one);
  b.AddShared(std::shared_ptr<const void>(one));
  c.AddShared(other);
  EXPECT_TRUE(a == b);
  EXPECT_FALSE(a == c);
  EXPECT_FALSE(a == DrawKey());
}

TEST(DrawKey, LaterDataAtTheSameAddressAreNotEqual) {
  // Two owners of one address stand for data that were freed and others that took their place.
  static const int place = 0;
  DrawKey before, after;
  {
    const std::shared_ptr<const int> first(&place, [](const int*) {});
    before.AddShared(first);
  }
  const std::shared_ptr<const int> second(&place, [](const int*) {});
  after.AddShared(second);
  EXPECT_FALSE(before == after);
  EXPECT_TRUE(before == before); // of data that have ended
}

} // namespace
} // namespace dspace
