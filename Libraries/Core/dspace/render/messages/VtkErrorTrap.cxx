#include <dspace/render/messages/VtkErrorTrap.h>

#include <dspace/Error.h>
#include <dspace/render/messages/VtkMessages.h>

namespace dspace {

VtkErrorTrap::VtkErrorTrap(VtkMessages& messages) : Messages_(messages) {
  this->Messages_.Add(*this);
}

VtkErrorTrap::~VtkErrorTrap() {
  this->Messages_.Remove(*this);
}

std::string VtkErrorTrap::FirstError() const {
  return this->Messages_.FirstErrorOf(*this);
}

void VtkErrorTrap::Check(const std::string& object) const {
  const std::string error = this->FirstError();
  if (!error.empty()) {
    throw Error(Error::Kind::Internal, object, "VTK reported: " + error);
  }
}

} // namespace dspace
