#include <dspace/render/CustomDrawers.h>

#include <typeinfo>
#include <utility>

#include <dspace/Error.h>

namespace dspace {

void CustomDrawers::Register(std::type_index geometry, Maker maker) {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->Makers_[geometry] = std::move(maker);
}

std::unique_ptr<CustomDrawer>
CustomDrawers::Make(const std::shared_ptr<const CustomGeometry>& geometry) const {
  const CustomGeometry& shape = *geometry;
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  const auto found = this->Makers_.find(std::type_index(typeid(shape)));
  if (found == this->Makers_.end()) {
    throw Error(Error::Kind::Unsupported, std::string("geometry of class ") + typeid(shape).name(),
                "no drawer is registered for it");
  }
  return found->second(geometry);
}

} // namespace dspace
