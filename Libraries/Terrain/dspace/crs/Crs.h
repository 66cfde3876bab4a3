// A coordinate reference system of any body (PROJ).
#ifndef DSPACE_TERRAIN_CRS_H
#define DSPACE_TERRAIN_CRS_H

#include <memory>
#include <string>

#include <Eigen/Core>

#include <dspace/crs/VerticalDatum.h>

class OGRSpatialReference;

namespace dspace {

// Immutable and cheap to copy. Map coordinates are always (x, y) as rasters have them: easting
// before northing, longitude before latitude, independent of the order of the authority.
class Crs {
public:
  enum class Kind {
    None,       // not known: map coordinates are metres in a plane
    Geographic, // map x is longitude, y latitude
    Projected,  // map x, y are lengths
    Local       // engineering CRS: lengths, no place on a body
  };

  Crs();

  // From WKT, a PROJ string, or "AUTHORITY:CODE" ("EPSG:4326", "IAU_2015:49900").
  // Throws Error(InvalidArgument) naming the text; Unsupported for a geocentric CRS.
  static Crs FromText(const std::string& text);
  static Crs FromOgr(const OGRSpatialReference& srs);

  Kind GetKind() const { return this->Kind_; }
  const std::string& GetName() const { return this->Name_; }
  const std::string& GetWkt() const { return this->Wkt_; }             // WKT2:2019; empty for None
  const std::string& GetAuthority() const { return this->Authority_; } // "EPSG:4326", or empty
  const std::string& GetVerticalName() const { return this->VerticalName_; } // compound CRS only
  const BodyAxes& GetAxes() const { return this->Axes_; }

  // Metres a unit of map x and y (Projected, Local, None), degrees a unit (Geographic).
  double GetUnit() const { return this->Unit_; }
  // +1 or -1: which way map x runs against east and map y against north (west-positive longitude).
  const Eigen::Vector2d& GetAxisSigns() const { return this->AxisSigns_; }

  // Longitude and latitude have a meaning.
  bool HasGeographic() const {
    return this->Kind_ == Kind::Geographic || this->Kind_ == Kind::Projected;
  }
  // The geographic CRS under this one. Throws Error(Unsupported) when there is none.
  Crs Geographic() const;

  // Scale of the projection at a place: metres of map a metre of ground, along the parallel (x) and
  // the meridian (y). (1, 1) for other kinds. Throws Error(InvalidArgument) where it is undefined.
  Eigen::Vector2d ScaleFactors(double longitude_deg, double latitude_deg) const;

  // For GDAL calls; null for None.
  const OGRSpatialReference* Ogr() const { return this->Srs_.get(); }

private:
  Kind Kind_ = Kind::None;
  std::string Name_;
  std::string Wkt_;
  std::string Authority_;
  std::string VerticalName_;
  BodyAxes Axes_;
  double Unit_ = 1.0;
  Eigen::Vector2d AxisSigns_ = Eigen::Vector2d::Ones();
  std::shared_ptr<const OGRSpatialReference> Srs_;
};

} // namespace dspace

#endif
