// The trees of triangles that rays search, from one request to the next.
#ifndef DSPACE_SESSION_RAY_TREES_H
#define DSPACE_SESSION_RAY_TREES_H

#include <map>
#include <memory>
#include <utility>

#include <dspace/measure/MeshRays.h>

namespace dspace::session {

// A scan comes in many requests on the same meshes, whose trees take longer than the rays of one.
// Used by one thread.
class RayTrees {
public:
  // Since the last Begin() only: what is not asked for until the next one goes.
  void Begin() {
    this->Before_ = std::move(this->Now_);
    this->Now_.clear();
  }
  std::shared_ptr<const MeshRays> Of(const std::shared_ptr<const Mesh>& mesh) {
    std::shared_ptr<const MeshRays>& tree = this->Now_[mesh.get()];
    if (!tree) {
      const auto found = this->Before_.find(mesh.get());
      // A tree keeps its mesh, so that no other one has its address.
      tree = found != this->Before_.end() ? found->second : std::make_shared<MeshRays>(mesh);
    }
    return tree;
  }

private:
  std::map<const Mesh*, std::shared_ptr<const MeshRays>> Now_;
  std::map<const Mesh*, std::shared_ptr<const MeshRays>> Before_;
};

} // namespace dspace::session

#endif
