// Overviews of a raster, built in the background.
#ifndef DSPACE_TERRAIN_OVERVIEWBUILD_H
#define DSPACE_TERRAIN_OVERVIEWBUILD_H

#include <functional>
#include <memory>
#include <string>

#include <dspace/raster/ElevationSource.h>

namespace dspace {

// ElevationCache::Build in a thread of its own, of low priority. It ends when this does: what is
// under way is then given up between two reads of some million pixels, and nothing half-made stays.
// Its owner ends it before the process ends, which takes down GDAL.
class OverviewBuild {
public:
  enum class State {
    Building,
    Built,  // there, and `built` has been called
    Failed, // Failure() says why; drawing goes on without
  };

  // Whether it would be worth it: ElevationCache::Needs(), none in the cache, over four million
  // pixels, and none of it on a server.
  static bool Wanted(const ElevationInfo& info);

  // Of the raster `path` into `folder`; `options` as for ElevationCache::Build. `built` is called
  // in the thread, once the overviews can be read; what it throws is a failure, as
  // is a thread that cannot be started. Returns at once.
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
