// Builds overviews of a raster in the background.
#ifndef DSPACE_TERRAIN_OVERVIEWBUILD_H
#define DSPACE_TERRAIN_OVERVIEWBUILD_H

#include <functional>
#include <memory>
#include <string>

#include <dspace/raster/ElevationSource.h>

namespace dspace {

// Runs ElevationCache::Build in a thread of its own with low priority. The destructor cancels it:
// the build stops between two reads of some million pixels, and no partial file stays. The owner
// must destroy it before the process ends, because GDAL is then cleaned up.
class OverviewBuild {
public:
  enum class State {
    Building,
    Built,  // the overviews exist, and `built` has been called
    Failed, // see Failure(); drawing continues without overviews
  };

  // Whether a build is useful: ElevationCache::Needs(), none in the cache, over four million
  // pixels, and no part on a server.
  static bool Wanted(const ElevationInfo& info);

  // Starts a build for the raster `path` into `folder`; `options` as for ElevationCache::Build.
  // Calls `built` in the thread, once the overviews can be read; an exception of `built` is a
  // failure, as is a thread that cannot be started. Returns at once.
  OverviewBuild(std::string folder, std::string path, const ElevationOptions& options,
                std::function<void()> built);
  OverviewBuild(const OverviewBuild&) = delete;
  OverviewBuild& operator=(const OverviewBuild&) = delete;
  ~OverviewBuild();

  State GetState() const;
  double Progress() const;     // the part read, 0 to 1
  std::string Failure() const; // the message; empty without one

private:
  struct Implementation;
  std::unique_ptr<Implementation> Impl_;
};

} // namespace dspace

#endif
