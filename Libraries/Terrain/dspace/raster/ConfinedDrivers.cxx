#include <dspace/raster/ConfinedDrivers.h>

#include <string>

#include <gdal_priv.h>

#include <dspace/gdal/GdalErrors.h>
#include <dspace/raster/DatasetGate.h>
#include <dspace/raster/SelfContainedDrivers.h>

namespace dspace {

ConfinedDrivers::ConfinedDrivers(bool withoutNamesOnly) {
  if (withoutNamesOnly) {
    AcceptFilesWithoutNamesOnly();
  }
  RegisterGdal();
  GDALDriverManager& manager = *GetGDALDriverManager();
  for (int i = 0; i < manager.GetDriverCount(); ++i) {
    GDALDriver* driver = manager.GetDriver(i);
    const std::string name = driver ? driver->GetDescription() : "";
    if (driver && name != DatasetGateName && (name != "VRT" || !AreMosaicsAccepted()) &&
        !IsSelfContained(name)) {
      driver->pfnOpen = nullptr;
      driver->pfnOpenWithDriverArg = nullptr;
    }
  }
}

} // namespace dspace
