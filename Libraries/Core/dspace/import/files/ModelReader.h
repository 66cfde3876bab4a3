// Reads a model from a file of any format that Dspace knows.
#ifndef DSPACE_IMPORT_MODEL_READER_H
#define DSPACE_IMPORT_MODEL_READER_H

#include <cstddef>
#include <string>

#include <dspace/import/model/Model.h>

namespace dspace {

// How a file is read.
struct ImportOptions {
  // Warnings (missing textures, repaired damage, ...) become errors; Model::leftOut does not.
  bool strict = false;
  std::size_t maximumTriangles = 50000000; // a file that expands beyond this is rejected
  bool pointCloud = false; // points alone are drawn; else a file without faces or lines is rejected
};

// Reads `path` by its content (magic bytes) and, where that is silent, its extension:
// .gltf .glb .wrl .wrz .iv .obj .stl .ply. Triangles that the file gives no normals get them from
// ComputeNormals with its default crease angle. A file without faces and lines is rejected unless
// options.pointCloud, with which the vertices of a PLY or OBJ become points. Damage that can be
// repaired (MeshRepair.h) is, with one warning a mesh that counts it. URDF is read by
// ReadUrdf (Urdf.h), since it has joints. Throws Error: NotFound, Io, Unsupported (type), Corrupt
// (with what is wrong and where).
Model ReadModel(const std::string& path, const ImportOptions& options = {});

} // namespace dspace

#endif
