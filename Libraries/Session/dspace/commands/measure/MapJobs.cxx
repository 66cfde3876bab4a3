#include <dspace/commands/measure/MapJobs.h>

#include <utility>

#include <dspace/Error.h>

namespace dspace::session {

struct MapJobs::Running {
  std::string key;
  Shape shape;
  bool complete = false;              // of the thread until its end
  std::unique_ptr<WorkThread> thread; // last: it uses the others
};

MapJobs::MapJobs() = default;
MapJobs::~MapJobs() = default;

MapJobs::Status MapJobs::Run(const std::string& path, const std::string& key,
                             const MapControl& control, const std::function<Job()>& begin,
                             const std::optional<double>& seconds) {
  auto found = this->Jobs_.find(path);
  if (found != this->Jobs_.end() && found->second->key != key) {
    if (!found->second->thread->Wait(0.0)) {
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
    job->thread = std::make_unique<WorkThread>(
        [&job = *job, work = std::move(begun.work), own = control](WorkThread& thread) mutable {
          own.progress = [&thread](const MapProgress& progress) {
            thread.Tell({progress.fraction, progress.left});
            return !thread.IsCancelled();
          };
          job.complete = work(own);
        });
    found = this->Jobs_.emplace(path, std::move(job)).first;
  }
  WorkThread& thread = *found->second->thread;
  if (!thread.Wait(seconds)) {
    return {false, thread.Told(), found->second->shape};
  }
  const std::unique_ptr<Running> ended = std::move(found->second);
  this->Jobs_.erase(found);
  thread.Check();
  return {ended->complete, thread.Told(), ended->shape};
}

MapJobs::Status MapJobs::Cancel(const std::string& path) {
  const auto found = this->Jobs_.find(path);
  if (found == this->Jobs_.end()) {
    return {};
  }
  Running& job = *found->second;
  job.thread->Cancel();
  const Status status = {job.complete, job.thread->Told(), job.shape};
  this->Jobs_.erase(found);
  return status;
}

} // namespace dspace::session
