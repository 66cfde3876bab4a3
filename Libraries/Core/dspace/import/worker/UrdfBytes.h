// Descriptions of robots as bytes: internal, not installed.
#ifndef DSPACE_IMPORT_WORKER_URDF_BYTES_H
#define DSPACE_IMPORT_WORKER_URDF_BYTES_H

#include <string>

#include <dspace/import/urdf/Urdf.h>
#include <dspace/import/worker/Bytes.h>

namespace dspace {

void WriteUrdf(const Urdf& urdf, ByteWriter& into);

// The robot, whose path is `path`. Its indices are in range, its links a tree with parents first,
// and its numbers finite, whatever the bytes are. Throws Error(Corrupt).
Urdf ReadUrdfBytes(ByteReader& from, const std::string& path);

} // namespace dspace

#endif
