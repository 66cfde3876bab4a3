// A cache of model and image files that several objects share.
#ifndef DSPACE_SESSION_MODEL_CACHE_H
#define DSPACE_SESSION_MODEL_CACHE_H

#include <map>
#include <memory>
#include <string>

#include <dspace/FilesRead.h>
#include <dspace/import/files/ModelReader.h>
#include <dspace/import/model/Model.h>

namespace dspace::session {

// The key is the path, size, modification time and options. An entry lives as long as its result is
// in use. Errors are those of ReadModel and ReadImage. The files of an entry are noted as read
// (FilesRead.h), also on a cache hit.
class ModelCache {
public:
  std::shared_ptr<const Model> LoadModel(const std::string& path, const ImportOptions& options);
  std::shared_ptr<const Image> LoadImage(const std::string& path);
  // Whether LoadModel would read nothing.
  bool Has(const std::string& path, const ImportOptions& options) const;

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
