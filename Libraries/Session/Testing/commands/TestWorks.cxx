// Requests in threads of their own, apart from what they compute.
#include <atomic>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/state/SkyMotions.h>
#include <dspace/state/Works.h>

namespace dspace::testing {
namespace {

// Work that nobody waits for ends, and only such.
TEST(Works, EndWhereNobodyWaits) {
  constexpr double Soon = 2.0; // [s]
  session::Works works(Soon);
  const session::Works::Terms terms{0.0, session::Deadline({}, "work", ""),
                                    session::SkyMotions::Standard()};
  std::atomic<int> ended{0};
  std::atomic<bool> finish{false};
  const session::Works::Compute compute = [&](v1::Reply& reply,
                                              const session::Works::Proceed& proceed) {
    try {
      while (!finish) {
        proceed(0.5);
      }
      reply.mutable_horizon()->add_elevation_deg(1.0);
    } catch (...) {
      ++ended;
      throw;
    }
  };
  v1::Reply reply;
  works.Run(reply, terms, compute);
  v1::AwaitWork await;
  await.set_work(reply.work().work());
  await.set_wait_s(3.0 * Soon); // longer than it may be without a client
  reply.Clear();
  works.Await(reply, await);
  EXPECT_EQ(reply.work().fraction(), 0.5);
  EXPECT_EQ(ended, 0);
  while (ended == 0) { // nobody waits
    std::this_thread::yield();
  }
  reply.Clear();
  works.Run(reply, terms, compute);
  v1::AwaitWork other;
  other.set_work(reply.work().work());
  EXPECT_THROW(works.Await(reply, await), Error); // its result is that it ended, or it is gone
  finish = true;
  reply.Clear();
  works.Await(reply, other);
  EXPECT_EQ(reply.horizon().elevation_deg_size(), 1);
}

} // namespace
} // namespace dspace::testing
