// The folder of averaged overviews: built, listed, cleared, verified. No scene takes part.
#include <algorithm>
#include <filesystem>
#include <tuple>

#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/commands/terrain/TerrainLook.h>
#include <dspace/commands/terrain/TerrainTools.h>
#include <dspace/raster/ElevationCache.h>
#include <dspace/state/ModelCache.h>

namespace dspace::session {
namespace {

namespace fs = std::filesystem;
using Entries = std::vector<ElevationCacheEntry>;

ElevationCache CacheIn(const Context& context, const std::string& folder) {
  ElevationCache cache(folder.empty() ? ElevationCache::DefaultFolder() : AbsolutePath(folder));
  context.reply.mutable_terrain_cache()->set_folder(cache.Folder());
  return cache;
}

Entries Sorted(const ElevationCache& cache) {
  Entries entries = cache.Entries();
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return std::tie(a.path, a.file) < std::tie(b.path, b.file);
  });
  return entries;
}

v1::TerrainCacheReply::Entry* AddEntry(const Context& context, const ElevationCacheEntry& from) {
  v1::TerrainCacheReply::Entry* entry = context.reply.mutable_terrain_cache()->add_entry();
  entry->set_file(from.file);
  entry->set_path(from.path);
  entry->set_bytes(from.bytes);
  entry->set_levels(std::uint32_t(from.levels));
  if (from.damaged) {
    entry->set_problem("its index is damaged");
  }
  return entry;
}

void BuildTerrainCache(const Context& context, v1::BuildTerrainCache& command) {
  const ElevationCache cache = CacheIn(context, command.folder());
  ElevationOptions options;
  if (command.band() != 0) {
    options.band = int(std::min<std::uint32_t>(command.band(), 1u << 30));
  }
  if (!command.crs().empty()) {
    options.crs = command.crs();
  }
  if (command.has_pixel_size()) {
    options.pixelSize = command.pixel_size();
  }
  const auto file = cache.Build(AbsoluteRaster(command.path()), options);
  for (const ElevationCacheEntry& entry : file ? Sorted(cache) : Entries()) {
    if (entry.file == *file) {
      AddEntry(context, entry);
    }
  }
}

void ListTerrainCache(const Context& context, v1::ListTerrainCache& command) {
  for (const ElevationCacheEntry& entry : Sorted(CacheIn(context, command.folder()))) {
    AddEntry(context, entry);
  }
}

// Two spellings of one file are the same.
bool SameRaster(const std::string& a, const std::string& b) {
  std::error_code absent;
  return a == b || fs::weakly_canonical(a, absent) == fs::weakly_canonical(b, absent);
}

void ClearTerrainCache(const Context& context, v1::ClearTerrainCache& command) {
  const ElevationCache cache = CacheIn(context, command.folder());
  const Entries entries = Sorted(cache);
  if (command.path().empty()) {
    cache.Clear(); // and what builds that were killed left
  }
  for (const ElevationCacheEntry& entry : entries) {
    if (!command.path().empty()) {
      if (entry.path.empty() || !SameRaster(entry.path, AbsoluteRaster(command.path()))) {
        continue;
      }
      std::vector<std::string> files = entry.layerFiles;
      files.push_back(entry.file);
      for (const std::string& file : files) { // the first of a layer's twice
        std::error_code failure;
        if (!fs::remove(file, failure) && failure) {
          throw Error(Error::Kind::Io, "cache file '" + file + "'",
                      "cannot be removed: " + failure.message());
        }
      }
    }
    AddEntry(context, entry);
  }
}

void VerifyTerrainCache(const Context& context, v1::VerifyTerrainCache& command) {
  for (const ElevationCacheEntry& entry : Sorted(CacheIn(context, command.folder()))) {
    v1::TerrainCacheReply::Entry* added = AddEntry(context, entry);
    try {
      ElevationCache::Verify(entry);
    } catch (const Error& error) {
      added->set_problem(error.what());
    }
  }
}

} // namespace

void AddTerrainCacheCommands(Registry& registry) {
  using C = v1::Command;
  const auto none = Needs::Nothing;
  registry.Add(C::kBuildTerrainCache, &C::mutable_build_terrain_cache, BuildTerrainCache, none);
  registry.Add(C::kListTerrainCache, &C::mutable_list_terrain_cache, ListTerrainCache, none);
  registry.Add(C::kClearTerrainCache, &C::mutable_clear_terrain_cache, ClearTerrainCache, none);
  registry.Add(C::kVerifyTerrainCache, &C::mutable_verify_terrain_cache, VerifyTerrainCache, none);
}

} // namespace dspace::session
