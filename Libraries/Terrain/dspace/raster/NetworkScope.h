// GDAL's settings, those of HTTP above all, for one thread and one call. Not for public headers.
#ifndef DSPACE_TERRAIN_NETWORKSCOPE_H
#define DSPACE_TERRAIN_NETWORKSCOPE_H

#include <string>
#include <utility>
#include <vector>

namespace dspace {

struct NetworkLimits;

// While it lives, what this thread asks of a server ends within the limits, and what it opens is
// nobody else's.
class NetworkScope {
public:
  NetworkScope(const NetworkLimits& limits, const std::string& path);
  ~NetworkScope();
  NetworkScope(const NetworkScope&) = delete;
  NetworkScope& operator=(const NetworkScope&) = delete;

private:
  void Set(const char* name, const std::string& value);
  std::vector<std::pair<std::string, std::string>> Before_; // an empty value: none was set
};

// Throws Error(InvalidArgument) naming `object` for a limit out of range.
void CheckLimits(const NetworkLimits& limits, const std::string& object);

// GDAL's name of what users may give as http:// or https://.
std::string GdalPath(const std::string& path);

// Whether the path alone says that a server is asked.
bool IsRemote(const std::string& path);

// GDAL keeps failures and parts of answers as if they were the file. What it kept is dropped.
void ClearNetworkCache(const std::string& path);

// Whether GDAL's message is of bytes that did not come, rather than of such that are no raster's.
bool IsNetworkFailure(const std::string& message);

// GDAL's message with what its response code means.
std::string ExplainHttpStatus(const std::string& message);

} // namespace dspace

#endif
