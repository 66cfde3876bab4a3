// JPL's DE405, as Debian packages it.
#ifndef DSPACE_ANALYSIS_DE405_SOURCE_H
#define DSPACE_ANALYSIS_DE405_SOURCE_H

#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>

#include <dspace/ephemeris/StateSource.h>

namespace dspace {

// The Sun, the Moon, the planets (for Jupiter and beyond the barycentres of their systems) from
// 1960 to 2060. Mercury, Venus and Mars are their systems' barycentres: Mars is off by up to 0.2 m.
//
// Reads table.f0i of Debian's casacore-data-jpl-de405 (public domain): little-endian doubles,
// record r at byte 12 + 8160 r, 1018 coefficients in the standard order of JPL's DE405, 1143
// records of 32 days from MJD 36912 (TDB). Source: E. M. Standish, JPL IOM 312.F-98-048 (1998).
class De405Source final : public StateSource {
public:
  // The libration of the Moon: Euler angles from J2000 to DE405's own principal axes of the Moon,
  // [psi]3 [theta]1 [phi]3 [rad, rad/s]. They are not those of another DE: each has axes of its
  // own.
  struct Libration {
    Eigen::Vector3d angles; // phi, theta, psi
    Eigen::Vector3d rates;
  };

  // The table's path where the package is installed.
  static const char* StandardPath(); // /usr/share/casacore/data/ephemerides/DE405/table.f0i
  static bool IsInstalled();

  // Reads nothing yet but the first record. Throws Error(Io), and Error(Corrupt) for another table.
  explicit De405Source(const std::string& path = StandardPath());
  ~De405Source() override;

  const std::string& Name() const override; // "JPL DE405"
  std::string Accuracy(int body) const override;
  const std::vector<Coverage>& Coverages() const override;
  std::optional<Link> Find(int body, double tdb) const override;
  // None outside of 1960 to 2060.
  std::optional<Libration> LibrationAt(double tdb) const;

private:
  class Table;
  std::unique_ptr<const Table> Table_;
};

} // namespace dspace

#endif
