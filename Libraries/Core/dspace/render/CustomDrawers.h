// Registry of the drawers of custom geometry.
#ifndef DSPACE_RENDER_CUSTOM_DRAWERS_H
#define DSPACE_RENDER_CUSTOM_DRAWERS_H

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <typeindex>

#include <dspace/render/CustomDrawer.h>
#include <dspace/scene/CustomGeometry.h>

namespace dspace {

// A render context has one. Its functions may be called from several threads at once.
class CustomDrawers {
public:
  // Makes the drawer of a geometry of the class that it is registered for. The geometry outlives
  // the drawer.
  using Maker = std::function<std::unique_ptr<CustomDrawer>(std::shared_ptr<const CustomGeometry>)>;

  // Registers the maker for geometry of exactly this class. A later registration replaces it.
  void Register(std::type_index geometry, Maker maker);
  // Throws Error(Unsupported) for a class without a registered drawer.
  std::unique_ptr<CustomDrawer> Make(const std::shared_ptr<const CustomGeometry>& geometry) const;

private:
  mutable std::mutex Mutex_; // of what follows
  std::map<std::type_index, Maker> Makers_;
};

} // namespace dspace

#endif
