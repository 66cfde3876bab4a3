// The cache that evicts the least recently used value.
#include <dspace/raster/LruCache.h>

#include <string>

#include <gtest/gtest.h>

using dspace::LruCache;

TEST(LruCache, EvictsTheLeastRecentlyUsed) {
  LruCache<int, std::string> cache(2);
  cache.Insert(1, "one");
  cache.Insert(2, "two");
  ASSERT_NE(cache.Find(1), nullptr); // 2 is now the older one
  cache.Insert(3, "three");
  EXPECT_EQ(cache.Find(2), nullptr);
  ASSERT_NE(cache.Find(1), nullptr);
  EXPECT_EQ(*cache.Find(1), "one");
  ASSERT_NE(cache.Find(3), nullptr);
  EXPECT_EQ(*cache.Find(3), "three");
}

TEST(LruCache, KeepsAnExistingValueAndMarksItAsUsed) {
  LruCache<int, std::string> cache(2);
  cache.Insert(1, "one");
  cache.Insert(2, "two");
  cache.Insert(1, "another");
  cache.Insert(3, "three");
  ASSERT_NE(cache.Find(1), nullptr);
  EXPECT_EQ(*cache.Find(1), "one");
  EXPECT_EQ(cache.Find(2), nullptr);
}

TEST(LruCache, ErasesByKeyAndFreesTheirPlaces) {
  LruCache<int, std::string> cache(3);
  for (const int key : {1, 2, 3}) {
    cache.Insert(key, std::to_string(key));
  }
  cache.EraseIf([](int key) { return key % 2 == 1; });
  EXPECT_EQ(cache.Find(1), nullptr);
  EXPECT_EQ(cache.Find(3), nullptr);
  ASSERT_NE(cache.Find(2), nullptr);
  cache.Insert(4, "4"); // 2 stays: there is room for three again
  cache.Insert(5, "5");
  ASSERT_NE(cache.Find(2), nullptr);
  EXPECT_EQ(*cache.Find(2), "2");
}
