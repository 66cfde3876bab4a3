#include <dspace/orientation/EarthRotation.h>

#include <algorithm>
#include <cmath>

#include <erfa.h>

#include <dspace/time/Days.h>

namespace dspace {
namespace {

struct Measured {
  double ut1 = 0.0;                               // [s past J2000]
  bool isUtc = true;                              // UTC stands for it
  Eigen::Vector2d pole = Eigen::Vector2d::Zero(); // [rad]
  bool hasPole = false;
  bool predicted = false;
};

Measured MeasuredAt(double tdb, const TimeScales& scales, const EarthOrientation* earth) {
  const TimeScales::UtcDay utc =
      scales.UtcFromTai(scales.Convert(tdb, TimeScale::Tdb, TimeScale::Tai));
  const double mjd = utc.mjd + std::min(utc.seconds / DaySeconds, 1.0);
  Measured found;
  found.isUtc = !scales.KnowsUt1(mjd);
  found.ut1 = scales.Convert(tdb, TimeScale::Tdb, found.isUtc ? TimeScale::Utc : TimeScale::Ut1);
  if (earth && earth->Covers(mjd)) {
    found.pole = earth->PoleAt(mjd);
    found.hasPole = true;
    found.predicted = earth->FirstPredicted() && mjd > *earth->FirstPredicted() - 1.0;
  }
  return found;
}

} // namespace

StateTurn EarthRotation(double tdb, const TimeScales& scales, const EarthOrientation* earth) {
  const Measured found = MeasuredAt(tdb, scales, earth);
  const double tt = scales.TtFromTdb(tdb);
  double rows[3][3];
  eraC2t06a(J2000Julian, tt / DaySeconds, J2000Julian, found.ut1 / DaySeconds, found.pole.x(),
            found.pole.y(), rows);
  StateTurn out;
  out.rotation << rows[0][0], rows[0][1], rows[0][2], rows[1][0], rows[1][1], rows[1][2],
      rows[2][0], rows[2][1], rows[2][2];
  // dR/dt = -[omega]x R (IERS Conventions 2010, 5.15), omega along the intermediate pole, which
  // polar motion tilts against the terrestrial z axis by 1e-6: (-x, y, 1) to first order.
  constexpr double Omega = 2.0 * M_PI * 1.00273781191135448 / DaySeconds;
  const Eigen::Vector3d omega = Omega * Eigen::Vector3d(found.pole.x(), -found.pole.y(), 1.0);
  for (int column = 0; column < 3; ++column) {
    out.rate.col(column) = -omega.cross(out.rotation.col(column));
  }
  return out;
}

std::string EarthRotationAccuracy(double tdb, const TimeScales& scales,
                                  const EarthOrientation* earth) {
  const Measured found = MeasuredAt(tdb, scales, earth);
  if (found.isUtc) {
    return "within 14 arcsec (420 m at the equator): UTC stands for UT1 (0.9 s), no polar "
           "motion (0.6 arcsec)";
  }
  if (!found.hasPole) {
    return "within 0.6 arcsec (19 m at the equator): no polar motion";
  }
  return found.predicted ? "UT1 and the pole as the IERS predicted them in '" + earth->Name() +
                               "': within 0.5 arcsec (15 m at the equator) in the first year"
                         : "within 0.005 arcsec (0.15 m at the equator): UT1 and the pole of '" +
                               earth->Name() + "', without their tides of a day and less";
}

} // namespace dspace
