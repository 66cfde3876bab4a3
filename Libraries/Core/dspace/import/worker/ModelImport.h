// Reads models and images for sessions: here, or in a process of their own where a file is not
// trusted.
#ifndef DSPACE_IMPORT_WORKER_MODEL_IMPORT_H
#define DSPACE_IMPORT_WORKER_MODEL_IMPORT_H

#include <memory>
#include <string>

#include <dspace/import/files/ModelReader.h>
#include <dspace/import/model/Model.h>
#include <dspace/import/urdf/Urdf.h>

namespace dspace {

// Whether all formats are read in processes of their own (ImportWorker.h), in this process from now
// on; default false. VRML and Inventor always are: their library ends the process at some damaged
// files. So are all files that this thread reads under a FilesGuard (FilesRead.h): those of a
// server's commands and of recordings.
void SetImportsApart(bool apart);

// As ReadModel, ReadImage and ReadUrdf. Throws as those and ImportWorker do.
Model ImportModel(const std::string& path, const ImportOptions& options = {});
std::shared_ptr<const Image> ImportImage(const std::string& path);
Urdf ImportUrdf(const std::string& path, const ImportOptions& options = {}); // an absolute path

} // namespace dspace

#endif
