#include <dspace/raster/NetworkScope.h>

#include <cmath>

#include <cpl_conv.h>
#include <cpl_vsi.h>

#include <dspace/Error.h>
#include <dspace/raster/ElevationSource.h>

namespace dspace {

NetworkScope::NetworkScope(const NetworkLimits& limits, const std::string& path) {
  this->Set("GDAL_HTTP_CONNECTTIMEOUT", std::to_string(limits.connect));
  this->Set("GDAL_HTTP_TIMEOUT", std::to_string(limits.request));
  // Whole seconds at fewer than so many bytes a second.
  this->Set("GDAL_HTTP_LOW_SPEED_TIME", std::to_string(std::lround(std::ceil(limits.stall))));
  this->Set("GDAL_HTTP_LOW_SPEED_LIMIT", "100");
  this->Set("GDAL_HTTP_MAX_RETRY", std::to_string(limits.retries));
  this->Set("GDAL_HTTP_RETRY_DELAY", std::to_string(limits.retryDelay));
  // GDAL shares a mosaic's sources between all mosaics that one thread has opened, which then are
  // read by several at once.
  this->Set("VRT_SHARED_SOURCE", "NO");
  // A TIFF is one file: without this GDAL asks for half a dozen that might stand beside it, each
  // of which a stalling server keeps waiting.
  const std::size_t dot = path.rfind('.');
  const std::string ending = dot == std::string::npos ? "" : path.substr(dot);
  const bool tiff = ending == ".tif" || ending == ".tiff" || ending == ".TIF" || ending == ".TIFF";
  if (tiff && IsRemote(path) && !CPLGetConfigOption("GDAL_DISABLE_READDIR_ON_OPEN", nullptr))
    this->Set("GDAL_DISABLE_READDIR_ON_OPEN", "EMPTY_DIR");
}

NetworkScope::~NetworkScope() {
  for (const auto& [name, value] : this->Before_)
    CPLSetThreadLocalConfigOption(name.c_str(), value.empty() ? nullptr : value.c_str());
}

void NetworkScope::Set(const char* name, const std::string& value) {
  const char* before = CPLGetThreadLocalConfigOption(name, nullptr);
  this->Before_.emplace_back(name, before ? before : "");
  CPLSetThreadLocalConfigOption(name, value.c_str());
}

void CheckLimits(const NetworkLimits& limits, const std::string& object) {
  const auto check = [&](const char* name, double seconds) {
    if (!(seconds > 0.0 && seconds <= 3600.0))
      throw Error(Error::Kind::InvalidArgument, object,
                  "network limit '" + std::string(name) + "' of " + std::to_string(seconds) +
                      " s is rejected; accepted is more than 0, up to 3600");
  };
  check("connect", limits.connect);
  check("stall", limits.stall);
  check("request", limits.request);
  check("retryDelay", limits.retryDelay);
  if (limits.retries < 0 || limits.retries > 10)
    throw Error(Error::Kind::InvalidArgument, object,
                std::to_string(limits.retries) + " network retries are rejected; accepted is 0 "
                                                 "to 10");
}

std::string GdalPath(const std::string& path) {
  const bool url = path.compare(0, 7, "http://") == 0 || path.compare(0, 8, "https://") == 0;
  return url ? "/vsicurl/" + path : path;
}

bool IsRemote(const std::string& path) {
  for (const char* prefix : {"/vsicurl", "/vsis3", "/vsigs", "/vsiaz", "/vsiadls", "/vsioss",
                             "/vsiswift", "/vsiwebhdfs", "http://", "https://"})
    if (path.find(prefix) != std::string::npos)
      return true;
  return false;
}

void ClearNetworkCache(const std::string& path) {
  const std::string gdal = GdalPath(path);
  const std::size_t at = gdal.find("/vsicurl/");
  if (at != std::string::npos)
    VSICurlPartialClearCache(gdal.substr(at).c_str());
  else
    VSICurlClearCache();
}

bool IsNetworkFailure(const std::string& message) {
  for (const char* words : {"response_code=", "response code", "CURL error", "IO error",
                            "Read error", "does not exist"})
    if (message.find(words) != std::string::npos)
      return true;
  return false;
}

std::string ExplainHttpStatus(const std::string& message) {
  // Of a read that was tried in several ways the first message says most.
  const std::string first = message.substr(0, message.find("; "));
  if (first.find("response_code=0") != std::string::npos)
    return first + " (no response: the server stalled or the connection was lost)";
  if (first.find("response_code=206") != std::string::npos)
    return first + " (incomplete response: the server stalled or the connection was lost)";
  if (first.find("response_code=") != std::string::npos)
    return first + " (HTTP status)";
  return first + " (the server did not send all of it)";
}

} // namespace dspace
