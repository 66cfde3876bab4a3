#include <dspace/gdal/OfflineScope.h>

#include <string>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_http.h>
#include <ogr_spatialref.h>

namespace dspace {
namespace {

CPLHTTPResult* RejectFetch(const char* url, CSLConstList, GDALProgressFunc, void*,
                           CPLHTTPFetchWriteFunc, void*, void*) {
  const std::string why = "'" + std::string(url) + "' is not fetched: a file may name no server";
  CPLError(CE_Failure, CPLE_AppDefined, "%s", why.c_str());
  // With a null result GDAL would fetch it.
  auto* result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
  result->nStatus = 1;
  result->pszErrBuf = CPLStrdup(why.c_str());
  return result;
}

} // namespace

OfflineScope::OfflineScope() {
  CPLHTTPPushFetchCallback(RejectFetch, nullptr);
}

OfflineScope::~OfflineScope() {
  CPLHTTPPopFetchCallback();
}

bool ReadCrsText(const std::string& text, OGRSpatialReference& srs) {
  const char* const limits[] = {"ALLOW_FILE_ACCESS=NO", "ALLOW_NETWORK_ACCESS=NO", nullptr};
  return !text.empty() && srs.SetFromUserInput(text.c_str(), limits) == OGRERR_NONE;
}

} // namespace dspace
