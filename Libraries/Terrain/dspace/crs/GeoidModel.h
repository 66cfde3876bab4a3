// The height of a geoid above WGS 84.
#ifndef DSPACE_TERRAIN_GEOIDMODEL_H
#define DSPACE_TERRAIN_GEOIDMODEL_H

#include <memory>
#include <string>

#include <Eigen/Core>

namespace dspace {

// One grid of geoid heights. For one thread at a time.
class GeoidModel {
public:
  // The grid that PROJ's own data have (Debian's proj-data): EGM96, of 15 minutes.
  static constexpr const char* Standard = "egm96_15.gtx";

  // `name`: a grid of PROJ's by its file ("egm96_15.gtx", "us_nga_egm08_25.tif"), interpolated
  // bilinearly; or a data set of GeographicLib's ("egm96-5", "egm2008-1"), interpolated by cubics.
  // Throws Error(NotFound) that names the file and the folders in which it is not, and
  // Error(Corrupt) for one that cannot be read.
  explicit GeoidModel(const std::string& name);
  ~GeoidModel();
  GeoidModel(const GeoidModel&) = delete;
  GeoidModel& operator=(const GeoidModel&) = delete;

  // [m] at (longitude, latitude) [deg]; NaN outside of a grid that does not cover the Earth. Throws
  // Error(InvalidArgument) for a latitude beyond 90 degrees and for what is not finite, and
  // Error(Corrupt) where the file ends early.
  double Height(const Eigen::Vector2d& place);

private:
  struct Grid;
  std::unique_ptr<Grid> Grid_;
};

} // namespace dspace

#endif
