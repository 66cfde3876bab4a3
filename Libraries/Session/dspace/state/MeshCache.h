// Meshes that commands made of arrays, shared by all objects with equal arrays.
#ifndef DSPACE_SESSION_MESH_CACHE_H
#define DSPACE_SESSION_MESH_CACHE_H

#include <functional>
#include <map>
#include <memory>
#include <string>

#include <dspace/import/model/Model.h>

namespace dspace::session {

// The key is the digest of the arrays (MeshMessages.h). An entry lives as long as its mesh is in
// use, so that memory and GPU hold equal arrays once.
class MeshCache {
public:
  // The mesh of a digest, or that of `make` if there is none. Passes the exceptions of `make` on.
  std::shared_ptr<const Mesh> Get(const std::string& digest,
                                  const std::function<std::shared_ptr<const Mesh>()>& make);

private:
  std::map<std::string, std::weak_ptr<const Mesh>> Meshes_;
  std::size_t PruneAt_ = 64;
};

} // namespace dspace::session

#endif
