#include <dspace/session/ModelCache.h>

#include <filesystem>

#include <dspace/import/ImageReader.h>

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

template<class T> void DropExpired(std::map<std::string, std::weak_ptr<const T>>& cache) {
  for (auto it = cache.begin(); it != cache.end();) {
    it = it->second.expired() ? cache.erase(it) : std::next(it);
  }
}

} // namespace

std::shared_ptr<const Model> ModelCache::LoadModel(const std::string& path,
                                                   const ImportOptions& options) {
  const std::string key = FileKey(path) + "\n" + std::to_string(options.strict) + "\n" +
                          std::to_string(options.maximumTriangles) + "\n" +
                          std::to_string(options.pointCloud);
  const auto found = this->Models_.find(key);
  if (found != this->Models_.end()) {
    if (auto model = found->second.lock()) {
      return model;
    }
  }
  auto model = std::make_shared<const Model>(ReadModel(path, options));
  DropExpired(this->Models_);
  this->Models_[key] = model;
  return model;
}

std::shared_ptr<const Image> ModelCache::LoadImage(const std::string& path) {
  const std::string key = FileKey(path);
  const auto found = this->Images_.find(key);
  if (found != this->Images_.end()) {
    if (auto image = found->second.lock()) {
      return image;
    }
  }
  std::shared_ptr<const Image> image = ReadImage(path);
  DropExpired(this->Images_);
  this->Images_[key] = image;
  return image;
}

std::string AbsolutePath(const std::string& path) {
  return path.empty() ? path : std::filesystem::absolute(path).lexically_normal().string();
}

} // namespace dspace::session
