#include <dspace/RowThreads.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace dspace {

void ForRows(int rows, int columns, const std::function<void(int first, int last)>& work) {
  constexpr std::int64_t Least = 32768; // posts that are worth a thread
  const std::int64_t posts = std::int64_t(rows) * columns;
  const int parts = int(std::clamp<std::int64_t>(
      posts / Least, 1, std::max(1u, std::thread::hardware_concurrency())));
  std::mutex mutex;
  std::exception_ptr error;
  const auto part = [&](int first, int last) {
    try {
      work(first, last);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      error = error ? error : std::current_exception();
    }
  };
  const auto end = [&](int k) { return int(std::int64_t(rows) * k / parts); };
  std::vector<std::thread> threads;
  threads.reserve(std::size_t(parts));
  int next = 0;
  try {
    for (; next < parts - 1; ++next) {
      threads.emplace_back(part, end(next), end(next + 1));
    }
  } catch (const std::system_error&) { // the system has no more threads
  }
  part(end(next), rows);
  for (std::thread& thread : threads) {
    thread.join();
  }
  if (error) {
    std::rethrow_exception(error);
  }
}

} // namespace dspace
