// Threads that read files.
#include <atomic>
#include <future>
#include <memory>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/commands/beforehand/ReadApart.h>

namespace dspace::testing {
namespace {

using session::ReadApart;

constexpr double LongestWait = 60.0; // [s]

TEST(ReadApart, GivesTheReply) {
  const ReadApart thread([] {
    v1::Reply reply;
    reply.add_warning("read");
    return reply;
  });
  ASSERT_TRUE(thread.IsDone(LongestWait));
  EXPECT_EQ(thread.Reply().warning(0), "read");
}

TEST(ReadApart, AnExceptionIsTheErrorOfTheReply) {
  const ReadApart thread([]() -> v1::Reply {
    throw Error(Error::Kind::NotFound, "file 'a'", "there is no such file");
  });
  ASSERT_TRUE(thread.IsDone(LongestWait));
  EXPECT_EQ(thread.Reply().error().kind(), v1::Error::NOT_FOUND);
  EXPECT_EQ(thread.Reply().error().object(), "file 'a'");
}

// The thread goes on without its object, owns what it uses, and counts until that is gone.
TEST(ReadApart, MayBeDestroyedBeforeItsThreadEnds) {
  std::promise<void> release;
  std::atomic<bool> gone{false};
  auto used = std::shared_ptr<int>(new int(7), [&gone](const int* value) {
    delete value;
    gone = true;
  });
  int seen = 0;
  {
    auto owned = used;
    const ReadApart thread([owned = std::move(owned), wait = release.get_future().share(), &seen] {
      wait.wait();
      seen = *owned;
      return v1::Reply();
    });
    EXPECT_FALSE(thread.IsDone(0.0));
  }
  EXPECT_FALSE(ReadApart::WaitForAll(0.01));
  used.reset(); // the thread has the last one
  EXPECT_FALSE(gone);
  release.set_value();
  EXPECT_TRUE(ReadApart::WaitForAll(LongestWait));
  EXPECT_TRUE(gone);
  EXPECT_EQ(seen, 7);
}

} // namespace
} // namespace dspace::testing
