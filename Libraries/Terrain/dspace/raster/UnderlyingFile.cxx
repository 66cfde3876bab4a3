#include <dspace/raster/UnderlyingFile.h>

#include <filesystem>

#include <dspace/raster/NetworkScope.h>

namespace dspace {

std::string UnderlyingFile(const std::string& name) {
  namespace fs = std::filesystem;
  std::string rest = name;
  while (rest.compare(0, 4, "/vsi") == 0 && !IsRemote(rest)) {
    const std::size_t slash = rest.find('/', 1);
    if (slash == std::string::npos) {
      return name;
    }
    if (rest.compare(0, slash, "/vsisubfile") == 0) { // "/vsisubfile/0_100,FILE"
      const std::size_t comma = rest.find(',', slash);
      if (comma == std::string::npos) {
        return name;
      }
      rest.erase(0, comma + 1);
      continue;
    }
    rest.erase(0, slash + 1);
    if (!rest.empty() && rest[0] == '{') { // "/vsizip/{FILE}/inside"
      rest = rest.substr(1, rest.find('}') - 1);
    }
  }
  std::error_code error;
  for (fs::path part = rest; part.has_relative_path(); part = part.parent_path()) {
    if (fs::exists(part, error)) {
      return part.string();
    }
  }
  return name;
}

} // namespace dspace
