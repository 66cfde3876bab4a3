#include <dspace/commands/beforehand/ReadApart.h>

#include <atomic>
#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

#include <dspace/Error.h>

namespace dspace::session {
namespace {

std::atomic<int> Running{0}; // of the process, as its end is

} // namespace

void ReadApart(std::function<void()> read) {
  ++Running;
  try {
    std::thread([read = std::move(read)]() mutable {
      read();
      read = nullptr; // what it owns goes first
      --Running;
    }).detach();
  } catch (const std::system_error& error) {
    --Running;
    throw Error(Error::Kind::Resource, "a thread that reads files",
                std::string("cannot be started: ") + error.what());
  }
}

bool WaitForReaders(double seconds) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (Running > 0) {
    if (std::chrono::steady_clock::now() >= until) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

} // namespace dspace::session
