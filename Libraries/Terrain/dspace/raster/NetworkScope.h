// GDAL's settings, those of HTTP above all, for one thread and one call. Not for public headers.
#ifndef DSPACE_TERRAIN_NETWORKSCOPE_H
#define DSPACE_TERRAIN_NETWORKSCOPE_H

#include <string>
#include <utility>
#include <vector>

namespace dspace {

struct NetworkLimits;

// During its lifetime, network requests of this thread respect the limits, and datasets that it
// opens are not shared with other threads.
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

// GDAL's name of a path that may begin with http:// or https://.
std::string GdalPath(const std::string& path);

// Whether the path itself names a server.
bool IsRemote(const std::string& path);

// Clears GDAL's cache of a path, which may contain failures and partial responses.
void ClearNetworkCache(const std::string& path);

// Whether GDAL's message reports a failed transfer rather than invalid content.
bool IsNetworkFailure(const std::string& message);

// GDAL's message with the meaning of its HTTP status code.
std::string ExplainHttpStatus(const std::string& message);

} // namespace dspace

#endif
