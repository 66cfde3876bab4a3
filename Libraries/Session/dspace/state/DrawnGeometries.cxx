#include <dspace/state/DrawnGeometries.h>

#include <utility>

#include <dspace/Error.h>

namespace dspace::session {

void DrawnGeometries::Register(const std::string& name, Maker maker) {
  const std::string label = "drawer '" + name + "'";
  if (name.empty() || name.size() > 256 || name.find(':') != std::string::npos || !maker) {
    throw Error(Error::Kind::InvalidArgument, label,
                "accepted: a name of 1 to 256 characters without a colon, and a function that "
                "makes its geometry");
  }
  if (!this->Makers_.emplace(name, std::move(maker)).second) {
    throw Error(Error::Kind::AlreadyExists, label, "the session has a drawer of this name already");
  }
}

const DrawnGeometries::Maker* DrawnGeometries::Find(const std::string& drawer) const {
  const auto found = this->Makers_.find(drawer.substr(0, drawer.find(':')));
  return found == this->Makers_.end() ? nullptr : &found->second;
}

std::vector<std::string> DrawnGeometries::Names() const {
  std::vector<std::string> names;
  for (const auto& [name, maker] : this->Makers_) {
    names.push_back(name);
  }
  return names;
}

} // namespace dspace::session
