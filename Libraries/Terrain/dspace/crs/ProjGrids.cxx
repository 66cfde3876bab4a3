#include <dspace/crs/ProjGrids.h>

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <ogr_spatialref.h>
#include <ogr_srs_api.h>
#include <proj.h>

#include <dspace/SystemFiles.h>

namespace dspace {
namespace {

using Paths = std::set<std::string>;
template<class T, T* (*Destroy)(T*)> struct Ends {
  void operator()(T* each) const { Destroy(each); }
};
using Object = std::unique_ptr<PJ, Ends<PJ, proj_destroy>>;
using Context = std::unique_ptr<PJ_CONTEXT, Ends<PJ_CONTEXT, proj_context_destroy>>;

std::string WktOf(const OGRSpatialReference& srs) {
  char* wkt = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  srs.exportToWkt(&wkt, options);
  const std::string text = wkt ? wkt : "";
  CPLFree(wkt);
  return text;
}

// As GDAL asks PROJ: all operations that meet the area of use, also those whose grids are absent.
Paths GridsOf(const std::string& from, const std::string& to,
              const std::vector<std::string>& folders) {
  const Context context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  std::vector<const char*> names;
  for (const std::string& folder : folders) {
    names.push_back(folder.c_str());
  }
  if (!names.empty()) {
    proj_context_set_search_paths(context.get(), int(names.size()), names.data());
  }
  const char* database = proj_context_get_database_path(context.get());
  const std::filesystem::path data = std::filesystem::path(database ? database : "").parent_path();
  const Object a(proj_create(context.get(), from.c_str()));
  const Object b(proj_create(context.get(), to.c_str()));
  Paths paths;
  if (!a || !b) {
    return paths;
  }
  PJ_OPERATION_FACTORY_CONTEXT* how = proj_create_operation_factory_context(context.get(), nullptr);
  proj_operation_factory_context_set_spatial_criterion(context.get(), how,
                                                       PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
  proj_operation_factory_context_set_grid_availability_use(context.get(), how,
                                                           PROJ_GRID_AVAILABILITY_USED_FOR_SORTING);
  PJ_OBJ_LIST* operations = proj_create_operations(context.get(), a.get(), b.get(), how);
  for (int i = 0; operations && i < proj_list_get_count(operations); ++i) {
    const Object operation(proj_list_get(context.get(), operations, i));
    const int count = proj_coordoperation_get_grid_used_count(context.get(), operation.get());
    for (int k = 0; k < count; ++k) {
      const char* name = nullptr;
      const char* path = nullptr;
      int available = 0;
      proj_coordoperation_get_grid_used(context.get(), operation.get(), k, &name, &path, nullptr,
                                        nullptr, nullptr, nullptr, &available);
      if (path && *path) {
        paths.insert(path);
      } else if (name && *name && !data.empty()) {
        paths.insert((data / name).string());
      }
    }
  }
  proj_list_destroy(operations);
  proj_operation_factory_context_destroy(how);
  return paths;
}

} // namespace

void NoteGrids(const OGRSpatialReference& from, const OGRSpatialReference& to) {
  if (from.IsSameGeogCS(&to)) {
    return;
  }
  const CPLStringList list(OSRGetPROJSearchPaths());
  const std::vector<std::string> folders(list.List(), list.List() + list.size());
  static std::mutex mutex;
  static std::map<std::pair<std::pair<std::string, std::string>, std::vector<std::string>>, Paths>
      known; // which takes 30 ms and more to find out
  const std::lock_guard<std::mutex> lock(mutex);
  const auto key = std::make_pair(std::make_pair(WktOf(from), WktOf(to)), folders);
  auto found = known.find(key);
  if (found == known.end()) {
    if (known.size() >= 256) {
      known.clear();
    }
    found = known.emplace(key, GridsOf(key.first.first, key.first.second, folders)).first;
  }
  for (const std::string& path : found->second) {
    NoteSystemFile(path);
  }
}

} // namespace dspace
