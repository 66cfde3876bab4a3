// The work on maps, off the session's thread.
#ifndef DSPACE_SESSION_MAP_JOBS_H
#define DSPACE_SESSION_MAP_JOBS_H

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <dspace/maps/MapWork.h>
#include <dspace/state/WorkThread.h>

namespace dspace::session {

// One job a path. Used by one thread. The destructor cancels all jobs and waits for them.
class MapJobs {
public:
  // A map's cells and bands, and the spacing of its cells [map units].
  struct Shape {
    int columns = 0;
    int rows = 0;
    int bands = 0;
    double cellSize = 0.0;
  };
  struct Job {
    std::function<bool(const MapControl&)> work; // returns whether it came to its end
    Shape shape;
  };
  struct Status {
    bool complete = false;
    WorkThread::Progress progress;
    Shape shape;
  };

  MapJobs();
  MapJobs(const MapJobs&) = delete;
  MapJobs& operator=(const MapJobs&) = delete;
  ~MapJobs();

  // Waits for the job on a path; begins it with `begin()` if there is none. `key` distinguishes
  // jobs of different inputs. `seconds`: returns the status after that; absent: waits to its end.
  // Throws what the work threw, and Error(AlreadyExists) if a job of another key works on the path.
  Status Run(const std::string& path, const std::string& key, const MapControl& control,
             const std::function<Job()>& begin, const std::optional<double>& seconds);
  // Ends the job on a path and waits for that; without a job does nothing.
  Status Cancel(const std::string& path);

private:
  struct Running;
  std::map<std::string, std::unique_ptr<Running>> Jobs_; // by path
};

} // namespace dspace::session

#endif
