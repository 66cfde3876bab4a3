#include <dspace/scene/Overlay.h>

#include <dspace/scene/Checks.h>

namespace dspace {

void TextTable::Check() const {
  RequireName("text table", this->name);
  const std::string object = "text table '" + this->name + "'";
  Require(this->margin >= 0, object, "margin", this->margin, "0 pixels and more");
  Require(this->fontSize >= 4 && this->fontSize <= 200, object, "font size", this->fontSize,
          "4 to 200 pixels");
  for (std::size_t i = 0; i < 4; ++i) {
    RequireFraction(object, "text colour", this->textColor[i]);
    RequireFraction(object, "background colour", this->backgroundColor[i]);
  }
}

} // namespace dspace
