// The longest time of a command.
#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/messages/Deadline.h>

namespace {

using dspace::Error;
using dspace::session::Deadline;

TEST(Deadline, PastItTheCommandAndTheTimeAreNamed) {
  const Deadline none({}, "command map", "fewer cells");
  const Deadline early(0.001, "command map", "fewer cells");
  const Deadline late(3600.0, "command map", "fewer cells");
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  none.Check();
  late.Check();
  try {
    early.Check();
    FAIL() << "it is past";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::DeadlineExceeded);
    EXPECT_EQ(std::string(error.what()),
              "command map: it takes longer than its deadline of 0.001 s; accepted: a later "
              "deadline, fewer cells, or none");
  }
}

} // namespace
