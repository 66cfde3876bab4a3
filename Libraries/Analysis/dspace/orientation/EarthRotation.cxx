#include <dspace/orientation/EarthRotation.h>

#include <cmath>

#include <erfa.h>

#include <dspace/Error.h>
#include <dspace/time/Days.h>

namespace dspace {
namespace {

// UT1 seconds past J2000; whether UTC stands for it.
double Ut1Of(double tdb, const TimeScales& scales, bool* isUtc) {
  try {
    const double ut1 = scales.Convert(tdb, TimeScale::Tdb, TimeScale::Ut1);
    *isUtc = false;
    return ut1;
  } catch (const Error& error) {
    if (error.GetKind() != Error::Kind::NotFound) {
      throw;
    }
  }
  *isUtc = true;
  return scales.Convert(tdb, TimeScale::Tdb, TimeScale::Utc);
}

} // namespace

StateTurn EarthRotation(double tdb, const TimeScales& scales) {
  bool isUtc = false;
  const double ut1 = Ut1Of(tdb, scales, &isUtc);
  const double tt = scales.TtFromTdb(tdb);
  double rows[3][3];
  eraC2t06a(J2000Julian, tt / DaySeconds, J2000Julian, ut1 / DaySeconds, 0.0, 0.0, rows);
  StateTurn out;
  out.rotation << rows[0][0], rows[0][1], rows[0][2], rows[1][0], rows[1][1], rows[1][2],
      rows[2][0], rows[2][1], rows[2][2];
  // dR/dt = -[omega]x R, omega along the terrestrial z axis (IERS Conventions 2010, 5.15).
  constexpr double Omega = 2.0 * M_PI * 1.00273781191135448 / DaySeconds;
  out.rate.row(0) = Omega * out.rotation.row(1);
  out.rate.row(1) = -Omega * out.rotation.row(0);
  out.rate.row(2).setZero();
  return out;
}

std::string EarthRotationAccuracy(double tdb, const TimeScales& scales) {
  bool isUtc = false;
  Ut1Of(tdb, scales, &isUtc);
  return isUtc ? "within 14 arcsec (420 m at the equator): UTC stands for UT1 (0.9 s), no polar "
                 "motion (0.6 arcsec)"
               : "within 0.6 arcsec (19 m at the equator): no polar motion";
}

} // namespace dspace
