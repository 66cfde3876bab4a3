// The process that forks a child for each document: internal, not installed.
#ifndef DSPACE_IMPORT_WORKER_PROCESS_H
#define DSPACE_IMPORT_WORKER_PROCESS_H

#include <memory>
#include <string>

#include <dspace/confine/FileRules.h>
#include <dspace/import/files/ModelReader.h>
#include <dspace/import/model/Model.h>
#include <dspace/import/urdf/Urdf.h>

namespace dspace {

// What a child calls: ReadModel, ReadImage and ReadUrdf, or a test's own.
struct WorkerReaders {
  Model (*model)(const std::string& path, const ImportOptions& options);
  std::shared_ptr<const Image> (*image)(const std::string& path);
  Urdf (*urdf)(const std::string& path, const ImportOptions& options);
};

// The main function of dspace-import-worker: takes requests from the socket on descriptor 3, whose
// other end is ImportWorker's, until it is closed. `warm` is called first, so that no child does
// that work. Each child gives up its rights before it reads (ReaderRules.h), with Landlock as of
// version `landlock`; by default that of the kernel, 0: without. Returns the exit status.
int RunImportWorker(const WorkerReaders& readers, void (*warm)(),
                    int landlock = confine::FileRules::KernelAbi());

} // namespace dspace

#endif
