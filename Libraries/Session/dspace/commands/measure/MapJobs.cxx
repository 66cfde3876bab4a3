#include <dspace/commands/measure/MapJobs.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include <dspace/Error.h>

namespace dspace::session {

struct MapJobs::Running {
  ~Running() {
    this->cancel = true;
    if (this->thread.joinable()) {
      this->thread.join();
    }
  }
  std::string key;
  Shape shape;
  std::thread thread;
  std::atomic<bool> cancel = false;
  std::mutex mutex; // of what follows
  std::condition_variable changed;
  bool ended = false;
  bool complete = false;
  MapProgress progress;
  std::exception_ptr error;
};

MapJobs::MapJobs() = default;
MapJobs::~MapJobs() = default;

MapJobs::Status MapJobs::Run(const std::string& path, const std::string& key,
                             const MapControl& control, const std::function<Job()>& begin,
                             const std::optional<double>& seconds) {
  auto found = this->Jobs_.find(path);
  if (found != this->Jobs_.end() && found->second->key != key) {
    bool ended = false;
    {
      const std::lock_guard<std::mutex> lock(found->second->mutex);
      ended = found->second->ended;
    }
    if (!ended) {
      throw Error(Error::Kind::AlreadyExists, "file '" + path + "'",
                  "another map is being written to it; accepted: another path, or cancel that work "
                  "first");
    }
    this->Jobs_.erase(found);
    found = this->Jobs_.end();
  }
  if (found == this->Jobs_.end()) {
    Job begun = begin();
    auto job = std::make_unique<Running>();
    job->key = key;
    job->shape = begun.shape;
    MapControl own = control;
    own.progress = [&job = *job](const MapProgress& progress) {
      const std::lock_guard<std::mutex> lock(job.mutex);
      job.progress = progress;
      return !job.cancel;
    };
    job->thread = std::thread([&job = *job, work = std::move(begun.work), own] {
      bool complete = false;
      std::exception_ptr error;
      try {
        complete = work(own);
      } catch (...) {
        error = std::current_exception();
      }
      const std::lock_guard<std::mutex> lock(job.mutex);
      job.complete = complete;
      job.error = error;
      job.ended = true;
      job.changed.notify_all();
    });
    found = this->Jobs_.emplace(path, std::move(job)).first;
  }
  Running& job = *found->second;
  Status status;
  bool ended = false;
  std::exception_ptr error;
  {
    std::unique_lock<std::mutex> lock(job.mutex);
    const auto over = [&] { return job.ended; };
    if (seconds) {
      job.changed.wait_for(lock, std::chrono::duration<double>(std::min(*seconds, 1e6)), over);
    } else {
      job.changed.wait(lock, over);
    }
    ended = job.ended;
    error = job.error;
    status = {job.complete, job.progress, job.shape};
  }
  if (ended) {
    this->Jobs_.erase(found);
  }
  if (error) {
    std::rethrow_exception(error);
  }
  return status;
}

MapJobs::Status MapJobs::Cancel(const std::string& path) {
  const auto found = this->Jobs_.find(path);
  if (found == this->Jobs_.end()) {
    return {};
  }
  Running& job = *found->second;
  job.cancel = true;
  job.thread.join();
  const Status status = {job.complete, job.progress, job.shape};
  this->Jobs_.erase(found);
  return status;
}

} // namespace dspace::session
