// Clients that do not read, for seconds, or for an hour with DSPACE_LONG: memory stays bounded and
// nobody else is slowed down.
#include "LinkTestSupport.h"
#include "Sanitized.h"

#include <algorithm>
#include <chrono>
#include <fstream>

namespace dspace::testing {
namespace {

using session::RemoteClient;
using session::Watcher;
using Clock = std::chrono::steady_clock;

std::chrono::seconds Duration() {
  const char* given = std::getenv("DSPACE_LONG");
  return std::chrono::seconds(given && *given ? 3600 : 4);
}

// Resident memory of this process, in bytes.
std::size_t Resident() {
  std::ifstream in("/proc/self/statm");
  std::size_t total = 0;
  std::size_t resident = 0;
  in >> total >> resident;
  return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

TEST_F(LinkTest, StalledViewersCostBoundedMemoryHoweverLong) {
  constexpr std::size_t Unread = 4 << 20;
  this->Options.unreadBytes = Unread;
  this->StartServer();
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  std::vector<std::uint64_t> frames;
  for (std::uint64_t id = 2; id < 202; ++id) {
    frames.push_back(id);
    Accept(client.Execute(MakeFrame(id)));
  }
  session::WatcherOptions options;
  options.address = this->Server->Address();
  options.waitingBytes = 1; // never taken
  Watcher first(options);
  Watcher second(options);
  options.waitingBytes = 64 << 20;
  Watcher reader(options);
  const auto began = Clock::now();
  const auto end = began + Duration();
  std::size_t waiting = 0;
  std::size_t before = 0;
  std::size_t after = 0;
  int steps = 0;
  std::uint64_t heard = 0;
  v1::WatchReply message;
  while (Clock::now() < end || steps < 2000) {
    for (int i = 0; i < 100; ++i) {
      Accept(client.Send(MakeStep(frames, ++steps)));
    }
    Accept(client.Flush());
    while (reader.Take(message, 0)) {
      heard = message.sequence();
    }
    waiting = std::max(waiting, this->Server->GetCounts().waitingBytes);
    after = Resident();
    if (steps <= 500 || Clock::now() < began + Duration() / 4) {
      before = after; // by then everything that waits is as full as it gets
    }
  }
  const std::uint64_t commands = 201 + std::uint64_t(steps);
  while (heard < commands && reader.Take(message, 20)) { // it has fallen behind nowhere
    heard = message.sequence();
  }
  EXPECT_EQ(heard, commands);
  EXPECT_EQ(client.GetCounts().reconnections, 0u);
  EXPECT_GT(std::size_t(steps) * 14400, 4 * Unread); // far more was sent than may wait
  EXPECT_LT(waiting, 4 * Unread);
  if (!testing::Sanitized()) { // the address sanitizer keeps freed memory
    EXPECT_LT(after, before + (64 << 20)) << "at a quarter " << before << ", at the end " << after;
  }
  RecordProperty("steps", steps);
  RecordProperty("resident_growth_kB", int((double(after) - double(before)) / 1024));
}

} // namespace
} // namespace dspace::testing
