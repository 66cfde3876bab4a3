#include <dspace/maps/MapWork.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>

#include <dspace/Error.h>

namespace dspace {

bool FillTiles(TileFile& file, std::size_t bands, const MapControl& control, const MakeTile& make) {
  using Clock = std::chrono::steady_clock;
  constexpr int MostThreads = 256;
  if (control.threads < 0 || control.threads > MostThreads) {
    throw Error(Error::Kind::InvalidArgument, "map",
                std::to_string(control.threads) + " threads are rejected; accepted: 0 to 256");
  }
  std::vector<std::pair<int, int>> todo;
  for (int row = 0; row < file.TileRows(); ++row) {
    for (int column = 0; column < file.TileColumns(); ++column) {
      if (!file.Has(column, row)) {
        todo.emplace_back(column, row);
      }
    }
  }
  const std::uint64_t all = std::uint64_t(file.TileRows()) * std::uint64_t(file.TileColumns());
  const Clock::time_point begin = Clock::now();
  std::mutex mutex;
  std::condition_variable changed;
  std::atomic<bool> stop = false;
  std::size_t next = 0;
  std::size_t done = 0;
  int running = 0;
  std::exception_ptr error;
  const auto report = [&](std::size_t finished) {
    MapProgress progress;
    progress.resumed = all - todo.size();
    progress.fraction = double(progress.resumed + finished) / double(all);
    progress.elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
    progress.left = finished > 0
                        ? progress.elapsed / double(finished) * double(todo.size() - finished)
                    : todo.empty() ? 0.0
                                   : std::numeric_limits<double>::infinity();
    return !control.progress || control.progress(progress);
  };
  const auto fill = [&] {
    std::vector<float> cells(bands * TileFile::Side * TileFile::Side);
    for (;;) {
      std::pair<int, int> tile;
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (stop || next == todo.size()) {
          return;
        }
        tile = todo[next++];
      }
      make(tile.first, tile.second, cells, stop);
      if (stop) {
        return;
      }
      file.Write(tile.first, tile.second, cells);
      const std::lock_guard<std::mutex> lock(mutex);
      ++done;
    }
  };
  const auto work = [&] {
    try {
      fill();
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      error = error ? error : std::current_exception();
      stop = true;
    }
    const std::lock_guard<std::mutex> lock(mutex);
    --running;
    changed.notify_all();
  };
  const int wanted = control.threads > 0 ? control.threads
                                         : int(std::max(1u, std::thread::hardware_concurrency()));
  const int threads = int(std::min<std::size_t>(std::size_t(wanted), todo.size()));
  std::vector<std::thread> workers;
  workers.reserve(std::size_t(threads));
  {
    const std::lock_guard<std::mutex> lock(mutex); // they begin together
    try {
      for (; running < threads; ++running) {
        workers.emplace_back(work);
      }
    } catch (const std::exception&) { // the system has no more threads
      if (running == 0) {
        throw;
      }
    }
  }
  std::exception_ptr own;
  {
    std::unique_lock<std::mutex> lock(mutex);
    while (running > 0) {
      changed.wait_for(lock, std::chrono::milliseconds(100), [&] { return running == 0; });
      const std::size_t finished = done;
      lock.unlock();
      try {
        if (!stop && !report(finished)) {
          stop = true;
        }
      } catch (...) {
        own = std::current_exception();
        stop = true;
      }
      lock.lock();
    }
  }
  for (std::thread& worker : workers) {
    worker.join();
  }
  if (own || error) {
    std::rethrow_exception(own ? own : error);
  }
  if (done < todo.size()) {
    return false;
  }
  file.Finish();
  report(done);
  return true;
}

} // namespace dspace
