#include <dspace/letters/FontFiles.h>

#include <string>

#include <dspace/Error.h>

namespace dspace {

const char* FontFile(Font font) {
  return font == Font::Sans ? DSPACE_FONT_SANS : DSPACE_FONT_MONO;
}

void RejectFont(Font font) {
  throw Error(Error::Kind::Resource, "font '" + std::string(FontFile(font)) + "'",
              "cannot be read; text needs this file (Debian's package fonts-dejavu-core)");
}

} // namespace dspace
