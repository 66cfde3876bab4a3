// Averaged overviews of rasters that have none, kept in a folder.
#ifndef DSPACE_TERRAIN_ELEVATIONCACHE_H
#define DSPACE_TERRAIN_ELEVATIONCACHE_H

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <dspace/raster/ElevationSource.h>

namespace dspace {

struct ElevationCacheEntry {
  std::string file; // in the folder
  std::string path; // of the raster; empty where damaged
  std::uint64_t bytes = 0;
  int levels = 0;
  bool damaged = false; // its index; tiles are checked by Verify and as they are read
  // Not empty: overviews of a colour layer (RasterLayerOptions::cacheFolder), a file each, `file`
  // the first of them.
  std::vector<std::string> layerFiles;
};

// A file holds the overviews of one band of one raster: means over 2 x 2, 4 x 4, ... pixels, each
// of all pixels with data, no data where under half of them have; values before scale, offset and
// unit, floats, or doubles where the band is not exact in floats. Its name is a hash of the
// raster's path and band; inside it says of which files of which size and time it was made, and is
// not used where one differs. A checksum stands over its index and each tile, read with it. Nothing
// is ever written beside the raster. Several processes may use and build at once: what is built
// appears at once and whole, the last one stays.
class ElevationCache {
public:
  // $XDG_CACHE_HOME/dspace/terrain, else ~/.cache/dspace/terrain.
  static std::string DefaultFolder();
  // Where the overviews of a raster's band are, if they are.
  static std::string FileFor(const std::string& folder, const std::string& path, int band);

  // The folder need not exist before Build.
  explicit ElevationCache(std::string folder = DefaultFolder());
  const std::string& Folder() const { return this->Folder_; }

  // Whether drawing it from afar would read every n-th pixel only: no overviews, and over 768
  // pixels a side.
  static bool Needs(const ElevationInfo& info);

  // Makes sure that the raster's overviews are there and fit it (all tiles are checked), and gives
  // their file; nothing where the raster has overviews of its own or `progress` (the part done, 0
  // to 1) returned false. Of `options` band, crs, pixel size and network count. Throws what
  // ElevationSource throws; Error(Resource) naming the folder and the bytes written where the disk
  // is full; Io. What was there before stays then, and nothing half-made.
  std::optional<std::string> Build(const std::string& path, const ElevationOptions& options = {},
                                   const std::function<bool(double)>& progress = {}) const;

  // The file, where it is there, fits the raster as it is now and its index is whole.
  std::optional<std::string> Find(const std::string& path,
                                  const ElevationOptions& options = {}) const;

  // What the folder holds. Throws Error(Io) where it cannot be read; one that is absent is empty.
  std::vector<ElevationCacheEntry> Entries() const;
  std::uint64_t SizeBytes() const;
  // Reads all of an entry. Throws Error(Corrupt) naming it.
  static void Verify(const ElevationCacheEntry& entry);
  // Removes what is the cache's own (overviews of colour layers, too), also what a build that was
  // killed left, and nothing else.
  void Clear() const;

private:
  std::string Folder_;
};

} // namespace dspace

#endif
