#include <dspace/state/ModelCache.h>

#include <filesystem>

#include <dspace/import/worker/ModelImport.h>
#include <dspace/state/ReadBeforehand.h>

namespace dspace::session {
namespace {

// Empty where the file cannot be asked: the reader then says why.
std::string FileKey(const std::string& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) {
    return {};
  }
  const auto time = std::filesystem::last_write_time(path, error);
  return path + "\n" + std::to_string(size) + "\n" +
         std::to_string(error ? 0 : time.time_since_epoch().count());
}

std::string ModelKey(const std::string& path, const ImportOptions& options) {
  return FileKey(path) + "\n" + std::to_string(options.strict) + "\n" +
         std::to_string(options.maximumTriangles) + "\n" + std::to_string(options.pointCloud);
}

} // namespace

template<class T, class Read>
std::shared_ptr<const T> ModelCache::Load(std::map<std::string, Kept<T>>& cache,
                                          const std::string& key, const Read& read) {
  const auto found = cache.find(key);
  if (found != cache.end()) {
    if (auto value = found->second.value.lock()) {
      NoteFilesRead(found->second.files);
      return value;
    }
  }
  const FilesReadScope scope;
  const std::shared_ptr<const T> value = read();
  for (auto it = cache.begin(); it != cache.end();) {
    it = it->second.value.expired() ? cache.erase(it) : std::next(it);
  }
  cache[key] = {value, scope.Files()};
  return value;
}

std::shared_ptr<const Model> ModelCache::LoadModel(const std::string& path,
                                                   const ImportOptions& options) {
  return Load(this->Models_, ModelKey(path, options), [&] {
    ReadBeforehand* before = ReadBeforehand::Current();
    return before && &before->models != this
               ? before->models.LoadModel(path, options)
               : std::make_shared<const Model>(ImportModel(path, options));
  });
}

bool ModelCache::Has(const std::string& path, const ImportOptions& options) const {
  const auto found = this->Models_.find(ModelKey(path, options));
  return found != this->Models_.end() && !found->second.value.expired();
}

std::shared_ptr<const Image> ModelCache::LoadImage(const std::string& path) {
  return Load(this->Images_, FileKey(path), [&] { return ImportImage(path); });
}

std::string AbsolutePath(const std::string& path) {
  if (path.empty()) {
    return path;
  }
  std::string absolute = std::filesystem::absolute(path).lexically_normal().string();
  RequireUtf8Path(absolute);
  return absolute;
}

} // namespace dspace::session
