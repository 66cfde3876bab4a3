// Planets at the barycentres of their systems. Real kernels: Testing/Python/sky/test_fallbacks.py.
#include <gtest/gtest.h>

#include <dspace/ephemeris/BarycenterSource.h>

namespace dspace {
namespace {

TEST(BarycenterSource, StandsForFivePlanets) {
  const BarycenterSource source;
  ASSERT_EQ(source.Coverages().size(), 5u);
  for (const StateSource::Coverage& coverage : source.Coverages()) {
    const auto link = source.Find(coverage.body, 8e8);
    ASSERT_TRUE(link) << coverage.body;
    EXPECT_EQ(link->center, coverage.body / 100);
    EXPECT_EQ(link->center, coverage.center);
    EXPECT_EQ(source.Coverages()[std::size_t(link->part)].body, coverage.body);
    EXPECT_TRUE(link->state.position.isZero() && link->state.velocity.isZero());
    EXPECT_NE(source.Warning(coverage.body).find(source.Accuracy(coverage.body)),
              std::string::npos);
    EXPECT_FALSE(source.Find(coverage.body, 1e13));
  }
  for (const int other : {5, 399, 301, 501, 10}) {
    EXPECT_FALSE(source.Find(other, 8e8)) << other;
    EXPECT_TRUE(source.Warning(other).empty());
  }
}

} // namespace
} // namespace dspace
