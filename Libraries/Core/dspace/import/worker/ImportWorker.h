// Reads models and images in processes of their own: the session's side.
#ifndef DSPACE_IMPORT_WORKER_IMPORT_WORKER_H
#define DSPACE_IMPORT_WORKER_IMPORT_WORKER_H

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include <dspace/import/files/ModelReader.h>
#include <dspace/import/model/Model.h>
#include <dspace/import/urdf/Urdf.h>

namespace dspace {

class Descriptor;
struct WorkerRequest;

// Starts a worker program at the first document, and again when it has ended. Any thread may call
// it; several documents are read at the same time. Files that the document refers to are noted and
// checked in the calling thread (FilesRead.h), as if they were read here.
class ImportWorker {
public:
  // That of this process, with dspace-import-worker in the folder "dspace" beside this library.
  static ImportWorker& OfProcess();
  explicit ImportWorker(std::string program);
  ~ImportWorker();
  ImportWorker(const ImportWorker&) = delete;
  ImportWorker& operator=(const ImportWorker&) = delete;

  // Starts the program now, so that the first document does not wait for it.
  void Start();

  // As dspace::ReadModel, ReadImage and ReadUrdf. Also throws Error: Corrupt where the process that
  // reads the file ends by a signal, Resource where it needs more than Budget::ImportMemory or
  // Budget::ImportSeconds (Budgets.h), Internal where the program cannot be started.
  Model ReadModel(const std::string& path, const ImportOptions& options = {});
  std::shared_ptr<const Image> ReadImage(const std::string& path);
  Urdf ReadUrdf(const std::string& path, const ImportOptions& options = {});

  // The process that forks; -1: it is not started. For tests.
  int Process() const;
  // Documents that were asked for. For tests.
  std::uint64_t Documents() const { return this->Documents_; }

private:
  struct Link;
  std::shared_ptr<Link> Started();
  void Drop(const std::shared_ptr<Link>& link);
  Descriptor Ask(const WorkerRequest& request); // returns the file of the result

  const std::string Program_;
  mutable std::mutex Mutex_;
  std::shared_ptr<Link> Link_;
  std::atomic<std::uint64_t> Documents_ = 0;
};

} // namespace dspace

#endif
