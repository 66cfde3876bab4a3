#include <dspace/render/CustomDrawer.h>

#include <map>
#include <mutex>
#include <typeinfo>

#include <dspace/Error.h>

namespace dspace {
namespace {

struct Makers {
  std::mutex mutex;
  std::map<std::type_index, CustomDrawerMaker> of;
};

Makers& AllMakers() {
  static Makers makers;
  return makers;
}

} // namespace

void RegisterCustomDrawer(std::type_index geometry, CustomDrawerMaker maker) {
  Makers& makers = AllMakers();
  const std::lock_guard<std::mutex> lock(makers.mutex);
  makers.of[geometry] = std::move(maker);
}

std::unique_ptr<CustomDrawer>
MakeCustomDrawer(const std::shared_ptr<const CustomGeometry>& geometry) {
  const CustomGeometry& shape = *geometry;
  Makers& makers = AllMakers();
  const std::lock_guard<std::mutex> lock(makers.mutex);
  const auto found = makers.of.find(std::type_index(typeid(shape)));
  if (found == makers.of.end()) {
    throw Error(Error::Kind::Unsupported, std::string("geometry of class ") + typeid(shape).name(),
                "nothing is registered that draws it");
  }
  return found->second(geometry);
}

} // namespace dspace
