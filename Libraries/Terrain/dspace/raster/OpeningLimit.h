// How long a raster of a server or a recording may be read while it is opened.
#pragma once

#include <string>

#include <gdal_priv.h>

namespace dspace {

// While it lives, reads of rasters in this thread end after Budget::OpenSeconds (Budgets.h),
// counted from its beginning: a mosaic of many sources that cover each other would else hold
// everybody. Only under a FilesGuard; within another one it does nothing.
class OpeningLimit {
public:
  OpeningLimit();
  ~OpeningLimit();
  OpeningLimit(const OpeningLimit&) = delete;
  OpeningLimit& operator=(const OpeningLimit&) = delete;

  static bool IsActive();
  // For RasterIO: formats that look at it end in time. Read in parts, others do not.
  static GDALRasterIOExtraArg Argument();
  // Throws Error(Resource) that names `object` and the limit when the time is over.
  static void Check(const std::string& object);

private:
  bool Mine_ = false;
};

} // namespace dspace
