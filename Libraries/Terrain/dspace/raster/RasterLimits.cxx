#include <dspace/raster/RasterLimits.h>

#include <cstdlib>
#include <cstring>

namespace dspace {

std::uint64_t RasterLimit::Value() const {
  const char* text = std::getenv(this->variable);
  if (!text || !*text || std::strspn(text, "0123456789") != std::strlen(text)) {
    return this->otherwise;
  }
  const unsigned long long value = std::strtoull(text, nullptr, 10);
  return value > 0 ? value : this->otherwise;
}

} // namespace dspace
