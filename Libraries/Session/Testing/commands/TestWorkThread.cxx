// A piece of work in a thread of its own.
#include <atomic>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/state/WorkThread.h>

namespace dspace::testing {
namespace {

using session::WorkThread;

TEST(WorkThread, TellsItsProgressUntilItIsCancelled) {
  std::atomic<bool> seen{false};
  WorkThread work([&](WorkThread& self) {
    self.Tell({0.25, 3.0});
    while (!self.IsCancelled()) {
      std::this_thread::yield();
    }
    seen = true;
  });
  EXPECT_FALSE(work.Wait(0.0));
  while (work.Told().fraction == 0.0) {
    std::this_thread::yield();
  }
  EXPECT_EQ(work.Told().fraction, 0.25);
  EXPECT_EQ(work.Told().left, 3.0);
  work.Cancel();
  EXPECT_TRUE(seen); // Cancel() waits
  EXPECT_TRUE(work.Wait(0.0));
  work.Check();
}

TEST(WorkThread, WhatItThrowsIsThrownByCheck) {
  WorkThread work([](WorkThread&) { throw std::runtime_error("no"); });
  EXPECT_TRUE(work.Wait({}));
  EXPECT_THROW(work.Check(), std::runtime_error);
}

TEST(WorkThread, TheDestructorEndsIt) {
  std::atomic<bool> ended{false};
  {
    const WorkThread work([&](WorkThread& self) {
      while (!self.IsCancelled()) {
        std::this_thread::yield();
      }
      ended = true;
    });
  }
  EXPECT_TRUE(ended);
}

} // namespace
} // namespace dspace::testing
