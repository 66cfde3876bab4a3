#include <dspace/state/MeshCache.h>

namespace dspace::session {

std::shared_ptr<const Mesh>
MeshCache::Get(const std::string& digest,
               const std::function<std::shared_ptr<const Mesh>()>& make) {
  const auto found = this->Meshes_.find(digest);
  if (found != this->Meshes_.end()) {
    if (auto mesh = found->second.lock()) {
      return mesh;
    }
  }
  std::shared_ptr<const Mesh> mesh = make();
  if (this->Meshes_.size() >= this->PruneAt_) {
    for (auto it = this->Meshes_.begin(); it != this->Meshes_.end();) {
      it = it->second.expired() ? this->Meshes_.erase(it) : std::next(it);
    }
    this->PruneAt_ = 2 * this->Meshes_.size() + 64;
  }
  this->Meshes_[digest] = mesh;
  return mesh;
}

} // namespace dspace::session
