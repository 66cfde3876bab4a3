// Builds averaged overviews of a large raster that has none, and adds them to open handles. Each
// level is a TIFF of its own. Not for public headers.
#ifndef DSPACE_LAYERS_RASTEROVERVIEWS_H
#define DSPACE_LAYERS_RASTEROVERVIEWS_H

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include <dspace/layers/raster/RasterContent.h>

namespace dspace {

// Safe to call from several threads after Plan(). Each thread passes its own handle.
class RasterOverviews {
public:
  // How to open another handle of the raster, and how to read cells with it (RasterLevels::Read).
  struct Access {
    std::function<std::unique_ptr<RasterHandle>()> open;
    std::function<void(RasterHandle&, const LevelWindow&, float*)> read;
    double bias = 0.0; // [the raster's unit] that `read` has subtracted from values
  };

  // `content` must outlive this. `state` detects a change of the file.
  RasterOverviews(std::string object, std::string path, FileState state,
                  const RasterContent& content, RasterShown shown);
  ~RasterOverviews(); // removes overviews that are in memory
  RasterOverviews(const RasterOverviews&) = delete;
  RasterOverviews& operator=(const RasterOverviews&) = delete;

  // Chooses the place of the overviews, if the raster is large enough to need them: `folder`, or
  // memory if it is empty. Without a call there are no overviews.
  void Plan(GDALDataset& file, const std::string& folder);
  // Builds missing overviews, if `window` is coarse enough to use them. The first caller builds;
  // concurrent callers wait. Throws Error(Io, Corrupt).
  void Make(const LevelWindow& window, const Access& access);
  // Appends the levels to a handle, once they are ready.
  void Add(RasterHandle& handle);
  // Removes the files. The next call of Make() builds them again.
  void Remove();

private:
  bool AddLevel(RasterHandle& handle, int level);
  void WriteLevel(RasterHandle& handle, int level, const Access& access);
  bool IsCoarsest(int level) const;
  std::string FileOf(int level) const;

  std::string Object_;
  std::string Path_;
  FileState File_;
  const RasterContent& Content_;
  RasterShown Shown_;
  std::string Stem_; // of the files' names; empty: no overviews are needed
  std::string Folder_;
  std::string Identity_; // of the source
  bool InMemory_ = false;
  std::mutex Mutex_; // held while building
  std::atomic<bool> Ready_{false};
};

} // namespace dspace

#endif
