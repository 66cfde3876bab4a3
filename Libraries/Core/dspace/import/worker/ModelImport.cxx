#include <dspace/import/worker/ModelImport.h>

#include <atomic>

#include <dspace/FilesRead.h>
#include <dspace/import/files/ImageReader.h>
#include <dspace/import/files/Importers.h>
#include <dspace/import/worker/ImportWorker.h>

namespace dspace {
namespace {

std::atomic<bool> Apart = false;

} // namespace

void SetImportsApart(bool apart) {
  Apart = apart;
}

Model ImportModel(const std::string& path, const ImportOptions& options) {
  return Apart || FilesGuard::IsActive() || IsVrmlFile(path)
             ? ImportWorker::OfProcess().ReadModel(path, options)
             : ReadModel(path, options);
}

std::shared_ptr<const Image> ImportImage(const std::string& path) {
  return Apart || FilesGuard::IsActive() ? ImportWorker::OfProcess().ReadImage(path)
                                         : ReadImage(path);
}

Urdf ImportUrdf(const std::string& path, const ImportOptions& options) {
  return Apart || FilesGuard::IsActive() ? ImportWorker::OfProcess().ReadUrdf(path, options)
                                         : ReadUrdf(path, options);
}

} // namespace dspace
