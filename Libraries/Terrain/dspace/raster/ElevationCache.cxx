#include <dspace/raster/ElevationCache.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <dspace/AtomicFile.h>
#include <dspace/Error.h>

#include <dspace/raster/CachedLayers.h>
#include <dspace/raster/NetworkScope.h>
#include <dspace/raster/OverviewFile.h>
#include <dspace/raster/OverviewWriter.h>

namespace dspace {
namespace {

namespace fs = std::filesystem;
constexpr const char* Ending = ".overviews";

std::string Hash(const std::string& text) {
  // FNV-1a, twice from different starts.
  std::uint64_t a = 14695981039346656037u;
  std::uint64_t b = 1099511628211u;
  for (const char c : text) {
    a = (a ^ static_cast<unsigned char>(c)) * 1099511628211u;
    b = (b ^ static_cast<unsigned char>(c)) * 1099511628211u + 1;
  }
  char name[33];
  std::snprintf(name, sizeof(name), "%016llx%016llx", static_cast<unsigned long long>(a),
                static_cast<unsigned long long>(b));
  return name;
}

// The raster as a whole, its values as they are.
ElevationOptions Plain(const ElevationOptions& given) {
  ElevationOptions options;
  options.band = given.band;
  options.noData = given.noData;
  options.crs = given.crs;
  options.pixelSize = given.pixelSize;
  options.network = given.network;
  options.verticalScale = 1.0;
  options.verticalOffset = 0.0;
  options.verticalDatum = VerticalDatum();
  return options;
}

bool EndsWith(const std::string& name, const std::string& ending) {
  return name.size() >= ending.size() &&
         name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

// A file that a build is writing, or that a killed one has left.
bool IsUnfinished(const fs::path& path) {
  const std::string target = AtomicFile::TargetName(path.filename().string());
  return EndsWith(target, Ending) || IsLayerFile(target);
}

// What no build can still be writing to.
void RemoveAbandoned(const std::string& folder) {
  std::error_code ignored;
  const auto yesterday = fs::file_time_type::clock::now() - std::chrono::hours(24);
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (IsUnfinished(entry.path()) && entry.last_write_time(ignored) < yesterday) {
      fs::remove(entry.path(), ignored);
    }
  }
}

} // namespace

std::string ElevationCache::DefaultFolder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache && *cache == '/') { // others are to be ignored, says the XDG specification
    return std::string(cache) + "/dspace/terrain";
  }
  const char* home = std::getenv("HOME");
  return (home && *home ? std::string(home) : fs::temp_directory_path().string()) +
         "/.cache/dspace/terrain";
}

std::string ElevationCache::FileFor(const std::string& folder, const std::string& path, int band) {
  std::error_code ignored;
  const fs::path whole = fs::exists(path, ignored) ? fs::canonical(path, ignored) : fs::path();
  const std::string name = whole.empty() ? GdalPath(path) : whole.string();
  return folder + "/" + Hash(name + "\n" + std::to_string(band)) + Ending;
}

ElevationCache::ElevationCache(std::string folder) : Folder_(std::move(folder)) {
  while (this->Folder_.size() > 1 && this->Folder_.back() == '/') {
    this->Folder_.pop_back();
  }
  if (this->Folder_.empty()) {
    throw Error(Error::Kind::InvalidArgument, "cache folder ''", "a folder's path is needed");
  }
}

bool ElevationCache::Needs(const ElevationInfo& info) {
  return (info.overviews == 0 || info.overviewsAreCached) &&
         std::max(info.window.width, info.window.height) > 768;
}

std::optional<std::string> ElevationCache::Find(const std::string& path,
                                                const ElevationOptions& options) const {
  const std::string file = FileFor(this->Folder_, path, options.band);
  try {
    const OverviewFile overviews(file);
    if (overviews.Header().identity == ElevationSource(path, Plain(options)).Identity()) {
      return file;
    }
  } catch (const Error& error) {
    if (error.GetObjectName().find(file) == std::string::npos) {
      throw; // the raster's
    }
  }
  return std::nullopt;
}

std::optional<std::string>
ElevationCache::Build(const std::string& path, const ElevationOptions& options,
                      const std::function<bool(double)>& progress) const {
  const ElevationSource source(path, Plain(options));
  if (source.Info().overviews > 0) {
    return std::nullopt;
  }
  const std::string identity = source.Identity();
  const std::string file = FileFor(this->Folder_, path, options.band);
  try {
    const OverviewFile present(file);
    if (present.Header().identity == identity) {
      present.Verify();
      return file;
    }
  } catch (const Error&) {
    // Absent or damaged: built below, which reports an unusable folder.
  }
  std::error_code failure;
  fs::create_directories(this->Folder_, failure);
  if (failure) {
    throw Error(Error::Kind::Io, "cache folder '" + this->Folder_ + "'",
                "cannot be made: " + failure.message());
  }
  RemoveAbandoned(this->Folder_);
  AtomicFile overviews(file);
  if (!WriteOverviews(source, identity, overviews, progress)) {
    return std::nullopt;
  }
  if (source.Identity() != identity) {
    throw Error(Error::Kind::Io, "raster '" + path + "'",
                "it has changed while its overviews were built; build them again");
  }
  overviews.Commit();
  return file;
}

std::vector<ElevationCacheEntry> ElevationCache::Entries() const {
  std::vector<ElevationCacheEntry> entries;
  std::vector<std::string> layers;
  std::error_code failure;
  fs::directory_iterator files(this->Folder_, failure);
  if (failure && failure != std::errc::no_such_file_or_directory) {
    throw Error(Error::Kind::Io, "cache folder '" + this->Folder_ + "'", failure.message());
  }
  for (const auto& found : files) {
    ElevationCacheEntry entry;
    entry.file = found.path().string();
    if (IsLayerFile(entry.file)) {
      layers.push_back(entry.file);
    }
    if (!EndsWith(entry.file, Ending)) {
      continue;
    }
    try {
      const OverviewFile overviews(entry.file);
      entry.path = overviews.Header().path;
      entry.levels = overviews.Header().levels;
      entry.bytes = overviews.Bytes();
    } catch (const Error& error) {
      if (error.GetKind() == Error::Kind::NotFound) { // removed just now
        continue;
      }
      entry.damaged = true;
      const auto bytes = found.file_size(failure);
      entry.bytes = failure ? 0 : bytes;
    }
    entries.push_back(std::move(entry));
  }
  for (ElevationCacheEntry& entry : LayerEntries(layers)) {
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::uint64_t ElevationCache::SizeBytes() const {
  std::uint64_t bytes = 0;
  for (const ElevationCacheEntry& entry : this->Entries()) {
    bytes += entry.bytes;
  }
  return bytes;
}

void ElevationCache::Verify(const ElevationCacheEntry& entry) {
  if (entry.layerFiles.empty()) {
    OverviewFile(entry.file).Verify();
  }
  std::for_each(entry.layerFiles.begin(), entry.layerFiles.end(), VerifyLayerFile);
}

void ElevationCache::Clear() const {
  std::error_code failure;
  fs::directory_iterator files(this->Folder_, failure);
  if (failure && failure != std::errc::no_such_file_or_directory) {
    throw Error(Error::Kind::Io, "cache folder '" + this->Folder_ + "'", failure.message());
  }
  for (const auto& found : files) {
    const std::string name = found.path().string();
    if (!EndsWith(name, Ending) && !IsLayerFile(name) && !IsUnfinished(found.path())) {
      continue;
    }
    if (!fs::remove(found.path(), failure) && failure) {
      throw Error(Error::Kind::Io, "cache file '" + name + "'",
                  "cannot be removed: " + failure.message());
    }
  }
}

} // namespace dspace
