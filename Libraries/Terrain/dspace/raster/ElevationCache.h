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

// A file holds the overviews of one band of one raster: means over 2 x 2, 4 x 4, ... pixels. Each
// is the mean of all pixels with data, or no data if under half of them have data. Values are
// stored before scale, offset and unit, as floats, or as doubles if floats are not exact for the
// band. The file's name is a hash of the raster's path and band. The file stores which source
// files, of which size and time, it was made from; it is not used if one differs. The index and
// each tile have a checksum. Nothing is written beside the raster. Several processes may use and
// build a cache at the same time: a new file appears atomically, and the last one remains.
class ElevationCache {
public:
  // $XDG_CACHE_HOME/dspace/terrain, else ~/.cache/dspace/terrain.
  static std::string DefaultFolder();
  // The path of the overviews of a raster's band. The file need not exist.
  static std::string FileFor(const std::string& folder, const std::string& path, int band);

  // The folder need not exist before Build.
  explicit ElevationCache(std::string folder = DefaultFolder());
  const std::string& Folder() const { return this->Folder_; }

  // Whether a distant view would read every n-th pixel only: no overviews, and over 768 pixels a
  // side.
  static bool Needs(const ElevationInfo& info);

  // Builds the raster's overviews unless valid ones exist (all tiles are checked). Returns their
  // file; nothing if the raster has overviews of its own or if `progress` (the part done, 0 to 1)
  // returned false. Uses band, crs, pixel size and network of `options`. Throws what
  // ElevationSource throws; Error(Resource) naming the folder and the bytes written if the disk is
  // full; Error(Io). After an error the earlier file remains, and no partial file.
  std::optional<std::string> Build(const std::string& path, const ElevationOptions& options = {},
                                   const std::function<bool(double)>& progress = {}) const;

  // The file, if it exists, fits the current raster and has an undamaged index.
  std::optional<std::string> Find(const std::string& path,
                                  const ElevationOptions& options = {}) const;

  // The entries of the folder. Throws Error(Io) if it cannot be read; an absent folder is empty.
  std::vector<ElevationCacheEntry> Entries() const;
  std::uint64_t SizeBytes() const;
  // Reads all of an entry. Throws Error(Corrupt) naming it.
  static void Verify(const ElevationCacheEntry& entry);
  // Removes all files of the cache, including overviews of colour layers and remains of a killed
  // build, and no other file.
  void Clear() const;

private:
  std::string Folder_;
};

} // namespace dspace

#endif
