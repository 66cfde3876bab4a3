// Blocks of horizons that are swept in threads of their own.
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/horizon/HorizonBlocks.h>

#include "FormulaPosts.h"

namespace {

using namespace dspace;
using namespace dspace::testing;

// Posts that wait until they may be read, that may fail, and that a bump may change.
class TestPosts : public FormulaPosts {
public:
  explicit TestPosts(std::int64_t side)
      : FormulaPosts(side, side, false, [this](double c, double r) {
          return 5.0 * std::sin(0.1 * c) + (c == 300.0 && r == 40.0 ? this->bump.load() : 0.0);
        }) {}
  void Read(const PostBlock& block, float* heights) const override {
    std::unique_lock<std::mutex> lock(this->mutex);
    this->changed.wait(lock, [this] { return this->open; });
    if (this->failing) {
      throw Error(Error::Kind::Resource, "posts", "the disk is gone");
    }
    lock.unlock();
    FormulaPosts::Read(block, heights);
  }
  void Set(bool isOpen, bool fails) {
    const std::lock_guard<std::mutex> lock(this->mutex);
    this->open = isOpen;
    this->failing = fails;
    this->changed.notify_all();
  }
  std::atomic<double> bump{0.0};

private:
  mutable std::mutex mutex;
  mutable std::condition_variable changed;
  bool open = true;
  bool failing = false;
};

struct HorizonBlocksTest : ::testing::Test {
  std::shared_ptr<TestPosts> posts = std::make_shared<TestPosts>(600);
  std::shared_ptr<ElevationPyramid> pyramid;
  std::unique_ptr<HorizonBlocks> blocks;

  void SetUp() override {
    ElevationPyramidOptions options;
    options.attempts = 1;
    pyramid = std::make_shared<ElevationPyramid>(posts, options);
    Eigen::Affine2d map = Eigen::Affine2d::Identity();
    map.linear() << 2.0, 0.0, 0.0, -2.0;
    HorizonOptions heights;
    heights.heights = {-5.0, 60.0};
    blocks = std::make_unique<HorizonBlocks>(
        HorizonSweep(pyramid, PostPlacement::OnPlane(map), heights));
  }
};

using HorizonBlocksRun = HorizonBlocksTest;

TEST_F(HorizonBlocksRun, TheyAreTheSweeps) {
  const std::vector<HorizonBlocks::Key> keys = {{0, 3, 2, 177}, {1, 0, 0, 1439}, {0, -1, 18, 5}};
  const auto found = blocks->Get(keys, 60.0);
  ASSERT_EQ(found.size(), keys.size());
  for (std::size_t k = 0; k < keys.size(); ++k) {
    std::vector<float> all(32 * 32);
    std::vector<float> distant(all.size());
    blocks->Sweep().Sweep({int(keys[k][0]), keys[k][1] * 32, keys[k][2] * 32, 32, 32},
                          0.25 * double(keys[k][3]), all.data(), distant.data());
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (std::isnan(all[i])) {
        EXPECT_TRUE(std::isnan(found[k]->all[i]));
        continue;
      }
      EXPECT_NEAR(std::tan(double(found[k]->all[i])), all[i], all[i] < -1e5 ? 1e9 : 1e-5);
      EXPECT_EQ(found[k]->distant[i] < -1.57f, distant[i] == HorizonSweep::None);
    }
  }
  EXPECT_EQ(blocks->Sweeps(), 3u);
  EXPECT_EQ(blocks->Get(keys, 60.0), found);
  EXPECT_EQ(blocks->Sweeps(), 3u);
}

TEST_F(HorizonBlocksRun, TryingNeverWaitsAndAWaitEndsAtItsDeadline) {
  posts->Set(false, false);
  const std::vector<HorizonBlocks::Key> keys = {{0, 3, 2, 177}, {0, 4, 2, 177}};
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 100; ++i) {
    for (const auto& block : blocks->TryGet(keys)) {
      EXPECT_EQ(block, nullptr);
    }
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
  try {
    blocks->Get(keys, 0.2);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.GetKind(), Error::Kind::DeadlineExceeded);
  }
  posts->Set(true, false);
  const std::uint64_t before = blocks->Arrivals();
  EXPECT_NE(blocks->Get(keys, 60.0)[1], nullptr);
  EXPECT_GE(blocks->Arrivals(), before);
  EXPECT_NE(blocks->TryGet(keys)[0], nullptr);
}

TEST_F(HorizonBlocksRun, WhatCannotBeReadIsTheWaitersError) {
  posts->Set(true, true);
  try {
    blocks->Get({{0, 3, 2, 177}}, 60.0);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("the disk is gone"), std::string::npos) << e.what();
  }
  posts->Set(true, false);
  EXPECT_NE(blocks->Get({{0, 3, 2, 177}}, 60.0)[0], nullptr);
}

// A bump at post (300, 40) is east of one block and outside what the other ones have read.
TEST_F(HorizonBlocksRun, OnlyWhatReadChangedPostsIsSweptAgain) {
  const HorizonBlocks::Key west = {0, 7, 1, 360}; // looks east
  const HorizonBlocks::Key away = {0, 7, 1, 1080};
  const HorizonBlocks::Key south = {0, 7, 12, 360};
  const auto before = blocks->Get({west, away, south}, 60.0);
  EXPECT_EQ(blocks->Sweeps(), 3u);
  posts->bump = 50.0;
  PostRectangle changed{300, 40, 1, 1};
  changed.levels = 1;
  pyramid->Invalidate({changed});
  const auto after = blocks->Get({west, away, south}, 60.0);
  EXPECT_EQ(blocks->Sweeps(), 4u);
  EXPECT_EQ(after[1], before[1]);
  EXPECT_EQ(after[2], before[2]);
  const std::size_t at = 8 * 32 + 31; // row 40, column 255
  EXPECT_NEAR(after[0]->all[at],
              std::atan((50.0 + 5.0 * std::sin(30.0) - 5.0 * std::sin(25.5)) / 90.0), 1e-4);
  EXPECT_LT(before[0]->all[at], after[0]->all[at]);
}

TEST_F(HorizonBlocksRun, RejectsWhatIsNotAccepted) {
  EXPECT_THROW(HorizonBlocks(blocks->Sweep(), 0), Error);
  EXPECT_THROW(HorizonBlocks(blocks->Sweep(), 65), Error);
  EXPECT_THROW(HorizonBlocks(blocks->Sweep(), 2, 1), Error);
}

} // namespace
