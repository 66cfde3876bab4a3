// The pyramid against its source: any block, any order, failures and limits.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <mutex>
#include <random>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/terrain/ElevationPyramid.h>

namespace {

using dspace::ElevationPyramid;
using dspace::ElevationPyramidOptions;
using dspace::Error;
using dspace::PostBlock;
using dspace::PostLattice;

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
    if (this->delay.count() > 0) {
      std::this_thread::sleep_for(this->delay);
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
  std::chrono::milliseconds delay{0};

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
  source->delay = std::chrono::milliseconds(5);
  ElevationPyramid pyramid(source);
  const PostBlock block{0, 200, 300, 127, 127};
  std::vector<float> heights(127 * 127, -1.0f);
  ASSERT_FALSE(pyramid.TryRead(block, heights.data()));
  EXPECT_EQ(heights, std::vector<float>(127 * 127, -1.0f)); // nothing half-written
  EXPECT_GT(pyramid.Statistics().pending, 0u);
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

TEST(ElevationPyramid, AWaitEndsAtItsDeadline) {
  const auto source = std::make_shared<NumberedPosts>(Lattice(1000, 1000, false, 3));
  source->delay = std::chrono::milliseconds(300);
  ElevationPyramid pyramid(source);
  std::vector<float> heights(100 * 100);
  try {
    pyramid.Read({0, 0, 0, 100, 100}, heights.data(), 0.02);
    FAIL() << "the deadline passed unnoticed";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::DeadlineExceeded);
  }
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

TEST(ElevationPyramid, OptionsOutOfRangeAreRefused) {
  const auto source = std::make_shared<NumberedPosts>(Lattice(1000, 1000, false, 3));
  ElevationPyramidOptions small;
  small.byteBudget = 1000;
  EXPECT_THROW(ElevationPyramid(source, small), Error);
  ElevationPyramidOptions idle;
  idle.threads = 0;
  EXPECT_THROW(ElevationPyramid(source, idle), Error);
}

} // namespace
