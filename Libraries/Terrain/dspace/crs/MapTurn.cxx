#include <dspace/crs/MapTurn.h>

#include <cmath>

#include <ogr_spatialref.h>

#include <dspace/gdal/OgrLock.h>

namespace dspace {

double MapTurn(const Crs& crs) {
  if (crs.GetKind() == Crs::Kind::Geographic) {
    return 360.0 / crs.GetUnit();
  }
  const std::lock_guard<std::mutex> lock(OgrMutex());
  const OGRSpatialReference* srs = crs.Ogr();
  const char* projection = srs ? srs->GetAttrValue("PROJECTION") : nullptr;
  if (!projection || std::string(projection) != SRS_PT_EQUIRECTANGULAR) {
    return 0.0;
  }
  const double parallel = srs->GetNormProjParm(SRS_PP_STANDARD_PARALLEL_1, 0.0);
  return 2.0 * M_PI * crs.GetAxes().semiMajor * std::cos(parallel * M_PI / 180.0) / crs.GetUnit();
}

} // namespace dspace
