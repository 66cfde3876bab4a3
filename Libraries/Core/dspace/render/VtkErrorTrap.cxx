#include <dspace/render/VtkErrorTrap.h>

#include <dspace/Error.h>
#include <dspace/render/VtkMessages.h>

namespace dspace {

VtkErrorTrap::VtkErrorTrap(VtkMessages& messages) : Messages_(messages) {
  this->Messages_.Add(*this);
}

VtkErrorTrap::~VtkErrorTrap() {
  this->Messages_.Remove(*this);
}

void VtkErrorTrap::Check(const std::string& object) const {
  const std::string error = this->Messages_.FirstErrorOf(*this);
  if (!error.empty()) {
    throw Error(Error::Kind::Internal, object, "VTK reported: " + error);
  }
}

} // namespace dspace
