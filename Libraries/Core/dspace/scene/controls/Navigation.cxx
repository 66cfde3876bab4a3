#include <dspace/scene/controls/Navigation.h>

#include <dspace/Checks.h>

namespace dspace {

void Navigation::Check(const std::string& object) const {
  Require(this->eyeHeight >= 0.01 && this->eyeHeight <= 1e6, object, "eye height", this->eyeHeight,
          "0.01 to 1e6 metres");
  Require(this->walkSpeed >= 0.001 && this->walkSpeed <= 1e6, object, "walking speed",
          this->walkSpeed, "0.001 to 1e6 metres a second");
}

} // namespace dspace
