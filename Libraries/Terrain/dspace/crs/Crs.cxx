#include <dspace/crs/Crs.h>

#include <cmath>

#include <cpl_conv.h>
#include <ogr_spatialref.h>
#include <proj.h>

#include <dspace/Error.h>
#include <dspace/FileText.h>
#include <dspace/Utf8.h>

#include <dspace/gdal/GdalErrors.h>
#include <dspace/gdal/OfflineScope.h>
#include <dspace/gdal/OgrLock.h>

namespace dspace {

namespace {

// Map axes against east and north. Axes of a polar aspect all point north or south: taken as they
// are, since there is no east.
Eigen::Vector2d AxisSigns(const OGRSpatialReference& srs) {
  OGRAxisOrientation way[2] = {OAO_East, OAO_North};
  const std::vector<int>& mapping = srs.GetDataAxisToSRSAxisMapping();
  for (int i = 0; i < 2 && i < static_cast<int>(mapping.size()); ++i)
    srs.GetAxis(nullptr, std::abs(mapping[i]) - 1, &way[i]);
  const bool polar = way[0] == OAO_North || way[0] == OAO_South;
  if (polar)
    return Eigen::Vector2d::Ones();
  return {way[0] == OAO_West ? -1.0 : 1.0, way[1] == OAO_South ? -1.0 : 1.0};
}

std::string ExportedWkt(const OGRSpatialReference& srs) {
  char* text = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  std::string wkt = srs.exportToWkt(&text, options) == OGRERR_NONE ? text : "";
  CPLFree(text);
  return wkt;
}

std::string AuthorityOf(const OGRSpatialReference& srs) {
  const char* name = srs.GetAuthorityName(nullptr);
  const char* code = srs.GetAuthorityCode(nullptr);
  return name && code ? std::string(name) + ":" + code : std::string();
}

} // namespace

Crs::Crs() = default;

Crs Crs::FromText(const std::string& text) {
  GdalErrors errors;
  OGRSpatialReference srs;
  if (!ReadCrsText(text, srs))
    throw Error(Error::Kind::InvalidArgument, "CRS '" + text + "'",
                errors.Message("not understood") +
                    "; accepted are WKT, a PROJ string, or AUTHORITY:CODE such as EPSG:4326 or "
                    "IAU_2015:49900");
  return FromOgr(srs);
}

Crs Crs::FromOgr(const OGRSpatialReference& source) {
  GdalErrors errors;
  Crs crs;
  if (source.IsEmpty())
    return crs;
  crs.Wkt_ = ExportedWkt(source);
  if (!IsUtf8(crs.Wkt_)) {
    // GeoTIFF says nothing of its texts' encoding, and old writers use Latin-1. Nothing of it
    // remains: the CRS is created again from UTF-8 text.
    OGRSpatialReference readable;
    const std::string wkt =
        ToFileText(crs.Wkt_, "CRS '" + ToUtf8(source.GetName() ? source.GetName() : "") + "'");
    if (readable.importFromWkt(wkt.c_str()) != OGRERR_NONE)
      throw Error(Error::Kind::Unsupported, "CRS '" + crs.Wkt_ + "'",
                  "its text is not UTF-8; " + errors.Message("accepted: WKT of UTF-8"));
    return FromOgr(readable);
  }
  auto srs = std::make_shared<OGRSpatialReference>(source);
  const char* vertical = srs->IsCompound() ? srs->GetAttrValue("COMPD_CS|VERT_CS") : nullptr;
  crs.VerticalName_ = ToUtf8(vertical ? vertical : "");
  crs.Name_ = ToUtf8(srs->GetName() ? srs->GetName() : "");
  crs.Authority_ = AuthorityOf(*srs);
  if (srs->IsCompound())
    srs->StripVertical();
  srs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  // The traditional order turns (latitude north, longitude east) only; west-positive longitude of
  // planetographic systems comes first all the same.
  OGRAxisOrientation first = OAO_Other;
  srs->GetAxis(nullptr, 0, &first);
  if (srs->IsGeographic() && (first == OAO_North || first == OAO_South))
    srs->SetDataAxisToSRSAxisMapping({2, 1});
  if (srs->IsGeocentric())
    throw Error(Error::Kind::Unsupported, "CRS '" + crs.Name_ + "'",
                "geocentric coordinates do not georeference a raster; a geographic or projected "
                "CRS does");
  if (srs->IsGeographic() || srs->IsDerivedGeographic()) {
    crs.Kind_ = Kind::Geographic;
    crs.Unit_ = srs->GetAngularUnits() * 180.0 / M_PI;
  } else if (srs->IsProjected()) {
    crs.Kind_ = Kind::Projected;
    crs.Unit_ = srs->GetLinearUnits();
  } else {
    crs.Kind_ = Kind::Local;
    crs.Unit_ = srs->GetLinearUnits();
  }
  if (crs.HasGeographic())
    crs.Axes_ = {srs->GetSemiMajor(), srs->GetSemiMinor()};
  if (!(crs.Unit_ > 0.0) || !std::isfinite(crs.Unit_))
    throw Error(Error::Kind::InvalidArgument, "CRS '" + crs.Name_ + "'", "its unit has no size");
  crs.AxisSigns_ = AxisSigns(*srs);
  crs.Srs_ = srs;
  return crs;
}

Crs Crs::Geographic() const {
  if (!this->HasGeographic())
    throw Error(Error::Kind::Unsupported,
                this->Name_.empty() ? "raster without CRS" : "CRS '" + this->Name_ + "'",
                "it has no longitude and latitude; give a geographic or projected CRS");
  if (this->Kind_ == Kind::Geographic)
    return *this;
  const std::lock_guard<std::mutex> lock(OgrMutex());
  GdalErrors errors;
  std::unique_ptr<OGRSpatialReference> base(this->Srs_->CloneGeogCS());
  if (!base)
    throw Error(Error::Kind::Unsupported, "CRS '" + this->Name_ + "'",
                errors.Message("its geographic CRS is not stated"));
  return FromOgr(*base);
}

Eigen::Vector2d Crs::ScaleFactors(double longitude_deg, double latitude_deg) const {
  if (this->Kind_ != Kind::Projected)
    return Eigen::Vector2d::Ones();
  // A context of its own: PROJ's errors stay in it.
  PJ_CONTEXT* context = proj_context_create();
  proj_log_level(context, PJ_LOG_NONE);
  PJ* pj = proj_create(context, this->Wkt_.c_str());
  PJ_FACTORS factors = {};
  bool failed = pj == nullptr;
  if (pj) {
    factors =
        proj_factors(pj, proj_coord(proj_torad(longitude_deg), proj_torad(latitude_deg), 0.0, 0.0));
    failed = proj_errno(pj) != 0;
  }
  proj_destroy(pj);
  proj_context_destroy(context);
  if (failed || !std::isfinite(factors.parallel_scale) || !std::isfinite(factors.meridional_scale))
    throw Error(Error::Kind::InvalidArgument, "CRS '" + this->Name_ + "'",
                "no scale factor at longitude " + std::to_string(longitude_deg) + ", latitude " +
                    std::to_string(latitude_deg));
  return {factors.parallel_scale, factors.meridional_scale};
}

} // namespace dspace
