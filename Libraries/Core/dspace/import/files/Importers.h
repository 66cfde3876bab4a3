// The reader of each format, for ReadModel: internal, not installed.
#ifndef DSPACE_IMPORT_IMPORTERS_H
#define DSPACE_IMPORT_IMPORTERS_H

#include <string>

#include <dspace/import/files/ModelReader.h>

namespace dspace {

// Each reads one file of its own format and ignores the file's extension. It may leave CheckModel,
// ImportOptions::strict and the naming of Model::path to ReadModel; it honours maximumTriangles.
// Throws Error as ReadModel does.
Model ReadGltf(const std::string& path, const ImportOptions& options); // glTF 2.0 text and binary
Model ReadObj(const std::string& path, const ImportOptions& options);  // Wavefront OBJ and MTL
Model ReadVrml(const std::string& path, const ImportOptions& options); // VRML 1, 2, gzip, Inventor
Model ReadStl(const std::string& path, const ImportOptions& options);  // text and binary
Model ReadPly(const std::string& path, const ImportOptions& options);  // text and binary

// Whether ReadModel takes the file for VRML or Inventor; false where it cannot be read.
bool IsVrmlFile(const std::string& path);

} // namespace dspace

#endif
