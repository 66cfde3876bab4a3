// Files that are loaded once, however many objects show them.
#ifndef DSPACE_SESSION_MODEL_CACHE_H
#define DSPACE_SESSION_MODEL_CACHE_H

#include <map>
#include <memory>
#include <string>

#include <dspace/FilesRead.h>
#include <dspace/import/files/ModelReader.h>
#include <dspace/import/model/Model.h>

namespace dspace::session {

// A file counts as the same while its path, size, time of change and options do; it is kept for as
// long as somebody holds what it gave. Errors are those of ReadModel and ReadImage. What was read
// is noted (FilesRead.h), from the cache too.
class ModelCache {
public:
  std::shared_ptr<const Model> LoadModel(const std::string& path, const ImportOptions& options);
  std::shared_ptr<const Image> LoadImage(const std::string& path);

private:
  template<class T> struct Kept {
    std::weak_ptr<const T> value;
    FilesRead files;
  };
  template<class T, class Read>
  static std::shared_ptr<const T> Load(std::map<std::string, Kept<T>>& cache,
                                       const std::string& key, const Read& read);
  std::map<std::string, Kept<Model>> Models_;
  std::map<std::string, Kept<Image>> Images_;
};

// The path made absolute, without "." and ".."; links are not followed.
std::string AbsolutePath(const std::string& path);

} // namespace dspace::session

#endif
