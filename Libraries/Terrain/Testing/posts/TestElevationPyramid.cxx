// The pyramid against its source: any block, any order, failures and limits.
#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/pyramid/ElevationPyramid.h>

#include "Gate.h"

namespace {

using dspace::ElevationPyramid;
using dspace::ElevationPyramidOptions;
using dspace::Error;
using dspace::PostBlock;
using dspace::PostLattice;
using dspace::testing::Gate;

// Each post tells where it stands.
class NumberedPosts : public dspace::PostSource {
public:
  explicit NumberedPosts(const PostLattice& lattice) : Lattice_(lattice) {}
  const std::string& GetName() const override { return this->Name_; }
  const PostLattice& GetLattice() const override { return this->Lattice_; }
  void Read(const PostBlock& block, float* heights) const override {
    {
      const std::lock_guard<std::mutex> lock(this->Mutex_);
      this->Threads_.insert(std::this_thread::get_id());
      ++this->Reads_;
    }
    if (this->failing) {
      throw Error(Error::Kind::Io, this->Name_, "the line is cut");
    }
    if (this->before) {
      this->before(block);
    }
    for (int j = 0; j < block.height; ++j) {
      for (int i = 0; i < block.width; ++i) {
        heights[std::size_t(j) * block.width + i] =
            this->Value(block.level, block.column + i, block.row + j);
      }
    }
  }
  float Value(int level, std::int64_t c, std::int64_t r) const {
    const std::int64_t column = this->Lattice_.Wrapped(level, c);
    if (column < 0 || column >= this->Lattice_.ColumnsAt(level) || r < 0 ||
        r >= this->Lattice_.RowsAt(level)) {
      return std::numeric_limits<float>::quiet_NaN();
    }
    return float(level * 1000000 + (column % 1000) * 1000 + r % 1000);
  }
  std::set<std::thread::id> Threads() const {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    return this->Threads_;
  }
  int Reads() const {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    return this->Reads_;
  }

  std::atomic<bool> failing{false};
  std::function<void(const PostBlock&)> before; // may wait or throw

private:
  std::string Name_ = "numbered posts";
  PostLattice Lattice_;
  mutable std::mutex Mutex_;
  mutable std::set<std::thread::id> Threads_;
  mutable int Reads_ = 0;
};

PostLattice Lattice(std::int64_t columns, std::int64_t rows, bool periodic, int levels) {
  PostLattice lattice;
  lattice.columns = columns;
  lattice.rows = rows;
  lattice.periodic = periodic;
  lattice.levels = levels;
  return lattice;
}

void ExpectBlock(const NumberedPosts& source, const PostBlock& block,
                 const std::vector<float>& heights) {
  for (int j = 0; j < block.height; ++j) {
    for (int i = 0; i < block.width; ++i) {
      const float expected = source.Value(block.level, block.column + i, block.row + j);
      const float got = heights[std::size_t(j) * block.width + i];
      ASSERT_TRUE(expected == got || (std::isnan(expected) && std::isnan(got)))
          << "level " << block.level << " post " << block.column + i << ", " << block.row + j
          << ": " << got << " instead of " << expected;
    }
  }
}

TEST(ElevationPyramid, AnyBlockIsTheSources) {
  std::mt19937 random(3);
  for (const bool periodic : {false, true}) {
    const auto source = std::make_shared<NumberedPosts>(Lattice(720, 361, periodic, 4));
    ElevationPyramid pyramid(source);
    for (int n = 0; n < 200; ++n) {
      PostBlock block;
      block.level = int(random() % 4);
      block.column = std::int64_t(random() % 1600) - 800;
      block.row = std::int64_t(random() % 500) - 100;
      block.width = 1 + int(random() % 300);
      block.height = 1 + int(random() % 300);
      std::vector<float> heights(std::size_t(block.width) * block.height);
      pyramid.Read(block, heights.data(), 60.0);
      ExpectBlock(*source, block, heights);
    }
  }
}

TEST(ElevationPyramid, TryingNeverReadsOnTheCallingThread) {
  const auto source = std::make_shared<NumberedPosts>(Lattice(10000, 10000, false, 7));
  Gate gate;
  source->before = [&gate](const PostBlock&) { gate.Wait(); };
  ElevationPyramid pyramid(source);
  const PostBlock block{0, 200, 300, 127, 127};
  std::vector<float> heights(127 * 127, -1.0f);
  EXPECT_FALSE(pyramid.TryRead(block, heights.data())); // and it returns, though every read waits
  EXPECT_EQ(heights, std::vector<float>(127 * 127, -1.0f)); // nothing half-written
  EXPECT_EQ(pyramid.Statistics().pending, 4u);
  gate.Open();
  while (!pyramid.TryRead(block, heights.data())) {
    std::this_thread::yield();
  }
  ExpectBlock(*source, block, heights);
  EXPECT_EQ(pyramid.Arrivals(), 4u);
  EXPECT_EQ(source->Reads(), 4); // each tile once, however often it was asked for
  EXPECT_EQ(source->Threads().count(std::this_thread::get_id()), 0u);
}

TEST(ElevationPyramid, StaysWithinItsBudget) {
  const auto source = std::make_shared<NumberedPosts>(Lattice(100000, 100000, false, 1));
  ElevationPyramidOptions options;
  options.byteBudget = std::size_t(4) << 20; // 64 tiles
  ElevationPyramid pyramid(source, options);
  std::mt19937 random(5);
  std::vector<float> heights(200 * 200);
  for (int n = 0; n < 60; ++n) {
    const PostBlock block{0, std::int64_t(random() % 90000), std::int64_t(random() % 90000), 200,
                          200};
    pyramid.Read(block, heights.data(), 60.0);
    ExpectBlock(*source, block, heights);
    ASSERT_LE(pyramid.Statistics().bytes, options.byteBudget);
  }
  EXPECT_GT(pyramid.Statistics().evictions, 0u);
  // More than the budget at once is served all the same.
  std::vector<float> large(1500 * 1500);
  pyramid.Read({0, 64, 64, 1500, 1500}, large.data(), 60.0);
  ExpectBlock(*source, {0, 64, 64, 1500, 1500}, large);
  EXPECT_LE(pyramid.Statistics().bytes, options.byteBudget);
}

TEST(ElevationPyramid, FailuresAreToldAndTriedAgain) {
  const auto source = std::make_shared<NumberedPosts>(Lattice(1000, 1000, false, 3));
  source->failing = true;
  ElevationPyramidOptions options;
  options.retryDelay = 0.001;
  ElevationPyramid pyramid(source, options);
  std::vector<float> heights(100 * 100, -1.0f);
  const PostBlock block{0, 10, 10, 100, 100};
  try {
    pyramid.Read(block, heights.data(), 60.0);
    FAIL() << "a read that failed was passed over";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::Io);
    EXPECT_NE(std::string(error.what()).find("the line is cut"), std::string::npos);
  }
  EXPECT_EQ(heights, std::vector<float>(100 * 100, -1.0f));
  EXPECT_GE(pyramid.Statistics().failures, 3u);
  EXPECT_NE(pyramid.Statistics().lastFailure.find("the line is cut"), std::string::npos);
  source->failing = false;
  pyramid.Read(block, heights.data(), 60.0);
  ExpectBlock(*source, block, heights);
}

// What drawing failed to read long ago is not held against a picture that waits.
TEST(ElevationPyramid, AWaitingReadMakesItsOwnAttempts) {
  const auto source = std::make_shared<NumberedPosts>(Lattice(2000, 2000, false, 3));
  source->failing = true;
  ElevationPyramidOptions options;
  options.retryDelay = 0.001;
  ElevationPyramid pyramid(source, options);
  const PostBlock block{0, 0, 0, 600, 600};
  std::vector<float> heights(600 * 600);
  while (pyramid.Statistics().failures < 200) { // each of 25 tiles failed more than thrice
    ASSERT_FALSE(pyramid.TryRead(block, heights.data()));
    std::this_thread::yield();
  }
  source->failing = false;
  pyramid.Read(block, heights.data(), 60.0); // the pauses have grown to many seconds by now
  ExpectBlock(*source, block, heights);
}

// Thousands of other questions do not make a waiting call's tile be forgotten.
TEST(ElevationPyramid, WhatSomebodyWaitsForIsNotDropped) {
  const auto source = std::make_shared<NumberedPosts>(Lattice(5000, 5000, false, 3));
  ElevationPyramidOptions options;
  options.threads = 2;
  options.retryDelay = 0.5;
  Gate gate;
  ElevationPyramid pyramid(source, options);
  std::vector<float> near(100);
  pyramid.Read({0, 0, 0, 10, 10}, near.data(), 60.0);
  std::atomic<bool> first{true};
  source->before = [&](const PostBlock& block) {
    if (block.level == 1) {
      gate.Wait();
    } else if (first.exchange(false)) {
      throw Error(Error::Kind::Io, "numbered posts", "the line is cut");
    }
  };
  std::thread waiting([&pyramid, &source] {
    std::vector<float> far(100);
    try {
      pyramid.Read({0, 3000, 3000, 10, 10}, far.data(), 60.0);
      ExpectBlock(*source, {0, 3000, 3000, 10, 10}, far);
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
    }
  });
  while (pyramid.Statistics().failures < 1) {
    std::this_thread::yield();
  }
  // It is tried again in half a second. Nothing comes in the meantime that would wake the call, so
  // that it would not ask again for what is dropped.
  std::vector<float> other(100);
  for (int i = 0; i < 3000; ++i) { // resident, and not
    EXPECT_TRUE(pyramid.TryRead({0, 0, 0, 10, 10}, near.data()));
    EXPECT_FALSE(pyramid.TryRead({1, 260, 900, 10, 10}, other.data()));
  }
  waiting.join();
  gate.Open();
}

TEST(ElevationPyramid, AWaitEndsAtItsDeadline) {
  const auto source = std::make_shared<NumberedPosts>(Lattice(1000, 1000, false, 3));
  Gate gate;
  source->before = [&gate](const PostBlock&) { gate.Wait(); };
  ElevationPyramid pyramid(source);
  std::vector<float> heights(100 * 100);
  try {
    pyramid.Read({0, 0, 0, 100, 100}, heights.data(), 0.02);
    ADD_FAILURE() << "the deadline passed unnoticed";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::DeadlineExceeded);
    EXPECT_NE(std::string(error.what()).find("within 0.02 s"), std::string::npos) << error.what();
  }
  try { // a caller whose time is used up
    pyramid.Read({0, 0, 0, 100, 100}, heights.data(), 0.0);
    ADD_FAILURE() << "the deadline passed unnoticed";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("before the deadline"), std::string::npos)
        << error.what();
  }
  gate.Open();
  pyramid.Read({0, 0, 0, 100, 100}, heights.data(), 60.0); // it came all the same
  ExpectBlock(*source, {0, 0, 0, 100, 100}, heights);
}

TEST(ElevationPyramid, ManyThreadsReadAtOnce) {
  const auto source = std::make_shared<NumberedPosts>(Lattice(5000, 5000, true, 2));
  ElevationPyramidOptions options;
  options.byteBudget = std::size_t(4) << 20;
  ElevationPyramid pyramid(source, options);
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 4; ++t) {
    threads.emplace_back([&pyramid, &source, t] {
      std::mt19937 random(t);
      std::vector<float> heights(150 * 150);
      for (int n = 0; n < 40; ++n) {
        const PostBlock block{int(random() % 2), std::int64_t(random() % 9000) - 4000,
                              std::int64_t(random() % 5000), 150, 150};
        if (n % 2 == 0 || !pyramid.TryRead(block, heights.data())) {
          pyramid.Read(block, heights.data(), 60.0);
        }
        ExpectBlock(*source, block, heights);
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
}

// Posts of any level that hold what was last set, and how often each was read.
class ChangingPosts : public dspace::PostSource {
public:
  explicit ChangingPosts(const PostLattice& lattice) : Lattice_(lattice) {}
  const std::string& GetName() const override { return this->Name_; }
  const PostLattice& GetLattice() const override { return this->Lattice_; }
  void Read(const PostBlock& block, float* heights) const override {
    this->posts += std::size_t(block.width) * block.height;
    for (int j = 0; j < block.height; ++j) {
      for (int i = 0; i < block.width; ++i) {
        heights[std::size_t(j) * block.width + i] =
            this->Value(block.level, block.column + i, block.row + j);
      }
    }
    if (this->during) { // between reading and handing over
      std::function<void()> once;
      std::swap(once, this->during);
      once();
    }
  }
  bool ReadWithTracks(const PostBlock& block, float* heights, float* tracks) const override {
    this->Read(block, heights);
    for (std::size_t i = 0; i < std::size_t(block.width) * block.height; ++i) {
      tracks[i] = heights[i] >= 1e6f ? 1.0f : 0.0f;
    }
    return !this->values.empty();
  }
  // A post of a coarser level is the greatest value in the posts it reaches to either side.
  float Value(int level, std::int64_t c, std::int64_t r) const {
    const std::int64_t column = this->Lattice_.Wrapped(level, c);
    if (column < 0 || column >= this->Lattice_.ColumnsAt(level) || r < 0 ||
        r >= this->Lattice_.RowsAt(level)) {
      return std::numeric_limits<float>::quiet_NaN();
    }
    float value = float(level * 1000 + column + r);
    const std::int64_t reach = level == 0 ? 0 : std::int64_t(1) << (level - 1);
    const std::int64_t x = this->Lattice_.ColumnPlace(level, column);
    const std::int64_t y = this->Lattice_.RowPlace(level, r);
    for (const auto& [place, high] : this->values) {
      std::int64_t away = std::abs(place.first - x);
      if (this->Lattice_.periodic) {
        away = std::min(away, this->Lattice_.columns - away);
      }
      if (away <= reach && std::abs(place.second - y) <= reach) {
        value = std::max(value, high);
      }
    }
    return value;
  }

  std::map<std::pair<std::int64_t, std::int64_t>, float> values; // of level-0 posts
  mutable std::function<void()> during;
  mutable std::atomic<std::size_t> posts{0};

private:
  std::string Name_ = "changing posts";
  PostLattice Lattice_;
};

void ExpectSource(ElevationPyramid& pyramid, const ChangingPosts& source, const PostBlock& block) {
  std::vector<float> heights(std::size_t(block.width) * block.height);
  std::vector<float> tracks(heights.size(), -1.0f);
  pyramid.Read(block, heights.data(), tracks.data(), 60.0);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const std::int64_t c = block.column + std::int64_t(i) % block.width;
    const std::int64_t r = block.row + std::int64_t(i) / block.width;
    const float expected = source.Value(block.level, c, r);
    ASSERT_TRUE(expected == heights[i] || (std::isnan(expected) && std::isnan(heights[i])))
        << "level " << block.level << ", post " << c << ", " << r << ": " << heights[i]
        << " instead of " << expected;
    ASSERT_EQ(tracks[i], expected >= 1e6f ? 1.0f : 0.0f) << c << ", " << r;
  }
}

TEST(ElevationPyramid, WhatChangesIsReadAgainAtEveryLevelAndNothingElse) {
  for (const bool periodic : {false, true}) {
    const auto source = std::make_shared<ChangingPosts>(Lattice(1024, 700, periodic, 4));
    ElevationPyramid pyramid(source);
    const auto all = [&] {
      for (int level = 0; level < 4; ++level) {
        ExpectSource(pyramid, *source, {level, -9, -9, (1024 >> level) + 20, (700 >> level) + 20});
      }
    };
    all();
    const std::uint64_t loads = pyramid.Statistics().loads;
    const std::uint64_t arrivals = pyramid.Arrivals();
    std::mt19937 random(12);
    for (int n = 0; n < 12; ++n) {
      const std::int64_t c = n == 0 ? 0 : n == 1 ? 1023 : std::int64_t(random() % 1020);
      const std::int64_t r = n == 0 ? 0 : n == 1 ? 699 : std::int64_t(random() % 690);
      source->values[{c, r}] = 1e6f + float(n);
      // The same rectangle, in another turn around the body.
      pyramid.Invalidate({{c + (periodic ? 1024 * (n - 5) : 0), r, 1, 1}});
      const std::size_t before = source->posts;
      all();
      // At each level the posts that the change may reach, not whole tiles; across a border, where
      // one tile goes all around, up to its whole rows.
      EXPECT_LE(source->posts - before, 1u + 3u * 25u + (periodic && n < 2 ? 5u * 128u : 0u))
          << "change " << n;
    }
    source->values.clear();
    pyramid.Invalidate({{0, 0, 1024, 700}});
    all();
    EXPECT_EQ(pyramid.Statistics().loads, loads); // patched, not dropped
    EXPECT_GT(pyramid.Arrivals(), arrivals);
  }
}

TEST(ElevationPyramid, ATileThatChangesWhileItIsReadDoesNotComeBackStale) {
  const auto source = std::make_shared<ChangingPosts>(Lattice(512, 512, false, 3));
  ElevationPyramidOptions options;
  options.threads = 1;
  ElevationPyramid pyramid(source, options);
  for (int n = 0; n < 6; ++n) { // of a tile that is new, and of a part that is read again
    source->during = [&] {
      source->values[{40 + n, 50}] = 2e6f + float(n);
      pyramid.Invalidate({{40 + n, 50, 1, 1}});
    };
    ExpectSource(pyramid, *source, {0, 0, 0, 100, 100});
    source->values[{41, 52}] = 3e6f + float(n);
    pyramid.Invalidate({{41, 52, 1, 1}});
  }
  ExpectSource(pyramid, *source, {0, 0, 0, 100, 100});
}

TEST(ElevationPyramid, WhatDidNotChangeIsThereMeanwhile) {
  const auto source = std::make_shared<ChangingPosts>(Lattice(512, 512, false, 3));
  ElevationPyramid pyramid(source);
  ExpectSource(pyramid, *source, {0, 0, 0, 100, 100});
  source->values[{40, 50}] = 5e6f;
  pyramid.Invalidate({{40, 50, 1, 1}});
  std::vector<float> heights(100 * 100);
  EXPECT_TRUE(pyramid.TryRead({0, 0, 0, 100, 50}, heights.data()));
  EXPECT_TRUE(pyramid.TryRead({0, 41, 0, 50, 100}, heights.data()));
  // The change alone is missing, and then comes.
  while (!pyramid.TryRead({0, 40, 50, 1, 1}, heights.data())) {
    std::this_thread::yield();
  }
  EXPECT_EQ(heights[0], 5e6f);
}

TEST(ElevationPyramid, ChangesAreToldSinceAMoment) {
  const auto source = std::make_shared<ChangingPosts>(Lattice(512, 300, false, 3));
  ElevationPyramid pyramid(source);
  EXPECT_EQ(pyramid.Changes(0).stamp, 0u);
  EXPECT_TRUE(pyramid.Changes(0).rectangles.empty());
  pyramid.Invalidate({{1, 2, 3, 4}, {5, 6, 7, 8}});
  const dspace::PyramidChanges two = pyramid.Changes(0);
  ASSERT_EQ(two.rectangles.size(), 2u);
  EXPECT_EQ(two.rectangles[1].column, 5);
  EXPECT_TRUE(pyramid.Changes(two.stamp).rectangles.empty());
  pyramid.Invalidate({{9, 9, 1, 1}});
  ASSERT_EQ(pyramid.Changes(two.stamp).rectangles.size(), 1u);
  EXPECT_EQ(pyramid.Changes(two.stamp).rectangles[0].column, 9);
  for (int n = 0; n < 10000; ++n) { // more than are kept: then all of it
    pyramid.Invalidate({{n % 500, 9, 1, 1}});
  }
  ASSERT_EQ(pyramid.Changes(two.stamp).rectangles.size(), 1u);
  EXPECT_EQ(pyramid.Changes(two.stamp).rectangles[0].width, 512);
  EXPECT_EQ(pyramid.Changes(two.stamp).rectangles[0].height, 300);
  EXPECT_TRUE(pyramid.Changes(pyramid.Changes(0).stamp).rectangles.empty());
}

TEST(ElevationPyramid, OptionsOutOfRangeAreRejected) {
  const auto source = std::make_shared<NumberedPosts>(Lattice(1000, 1000, false, 3));
  ElevationPyramidOptions small;
  small.byteBudget = 1000;
  EXPECT_THROW(ElevationPyramid(source, small), Error);
  ElevationPyramidOptions idle;
  idle.threads = 0;
  EXPECT_THROW(ElevationPyramid(source, idle), Error);
}

} // namespace
