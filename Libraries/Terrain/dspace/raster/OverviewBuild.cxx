#include <dspace/raster/OverviewBuild.h>

#include <atomic>
#include <mutex>
#include <thread>

#include <sys/resource.h>

#include <dspace/FilesRead.h>
#include <dspace/raster/ElevationCache.h>

namespace dspace {
namespace {

constexpr std::int64_t LeastPixels = 4000000; // smaller rasters lose little

// One thread's own on Linux, where each has a number; elsewhere nothing happens.
void LowerPriority() {
#ifdef __linux__
  ::setpriority(PRIO_PROCESS, 0, 10);
#endif
}

} // namespace

struct OverviewBuild::Implementation {
  std::atomic<bool> stopping{false};
  std::atomic<double> progress{0.0};
  mutable std::mutex mutex; // of what follows
  State state = State::Building;
  std::string failure;
  std::thread thread;

  void End(State how, const std::string& why = {}) {
    const std::lock_guard<std::mutex> lock(this->mutex);
    this->state = how;
    this->failure = why;
  }

  void Run(const std::string& folder, const std::string& path, const ElevationOptions& options,
           const std::function<void()>& built) {
    LowerPriority();
    try {
      const auto goOn = [this](double part) {
        this->progress = part;
        return !this->stopping;
      };
      const auto file = ElevationCache(folder).Build(path, options, goOn);
      if (this->stopping) {
        return;
      }
      if (file) {
        built();
      }
      this->progress = 1.0;
      this->End(State::Built);
    } catch (const std::exception& error) {
      this->End(State::Failed, error.what());
    }
  }

  void Stop() {
    this->stopping = true;
    if (this->thread.joinable()) {
      this->thread.join();
    }
  }
};

bool OverviewBuild::Wanted(const ElevationInfo& info) {
  return ElevationCache::Needs(info) && !info.overviewsAreCached && !info.remote &&
         std::int64_t(info.window.width) * info.window.height > LeastPixels;
}

OverviewBuild::OverviewBuild(std::string folder, std::string path, const ElevationOptions& options,
                             std::function<void()> built)
    : Impl_(std::make_unique<Implementation>()) {
  Implementation* impl = this->Impl_.get();
  try {
    impl->thread = std::thread([impl, folder = std::move(folder), path = std::move(path), options,
                                built = std::move(built), look = FilesGuard::Current()] {
      const FilesGuard guard(look);
      impl->Run(folder, path, options, built);
    });
  } catch (const std::exception& error) {
    impl->End(State::Failed, std::string("a thread for it could not be started: ") + error.what());
  }
}

OverviewBuild::~OverviewBuild() {
  this->Impl_->Stop();
}

OverviewBuild::State OverviewBuild::GetState() const {
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  return this->Impl_->state;
}

double OverviewBuild::Progress() const {
  return this->Impl_->progress;
}

std::string OverviewBuild::Failure() const {
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  return this->Impl_->failure;
}

} // namespace dspace
