// Conversions between time scales.
#ifndef DSPACE_ANALYSIS_TIME_SCALES_H
#define DSPACE_ANALYSIS_TIME_SCALES_H

#include <string>
#include <utility>
#include <vector>

#include <dspace/time/LeapSeconds.h>

namespace dspace {

enum class TimeScale { Utc, Tai, Tt, Tdb, Ut1 };

// "UTC", "TAI", "TT", "TDB" or "UT1".
const char* TimeScaleName(TimeScale scale);
// In any case. Throws Error(InvalidArgument).
TimeScale TimeScaleOf(const std::string& name);

// Seconds of an atomic or dynamic scale are past J2000: 2000-01-01 12:00:00 of that same scale.
// A double resolves 0.1 us within 30 years of 2000, and 30 us in the year 9999.
//
// TDB - TT is the one periodic term that SPICE uses, K sin(E) with K = 1.657 ms, so that times
// equal SPICE's; it differs from the full series (ERFA's eraDtdb) by up to 50 us.
//
// UTC as seconds counts 86400 s a day: a leap second cannot be told from the second after it.
// UtcText.h converts texts, which can.
class TimeScales {
public:
  // DELTET of an LSK: TDB - TT = k sin(E), E = M + eb sin(M), M = m0 + m1 TT. The values of
  // naif0012.tls.
  struct DeltaEt {
    double ttMinusTai = 32.184; // [s]
    double k = 1.657e-3;        // [s]
    double eb = 1.671e-2;
    double m0 = 6.239996;      // [rad]
    double m1 = 1.99096871e-7; // [rad/s]
  };
  // UT1 - UTC [s] at a day of UTC.
  struct Ut1Row {
    double mjd;
    double ut1MinusUtc;
  };

  // With LeapSeconds::FromSystem().
  TimeScales();
  explicit TimeScales(LeapSeconds leapSeconds) : TimeScales(std::move(leapSeconds), DeltaEt()) {}
  TimeScales(LeapSeconds leapSeconds, const DeltaEt& deltaEt);

  const LeapSeconds& GetLeapSeconds() const { return this->Leaps_; }

  // UT1 is known only from measurements: without rows, conversions to and from it throw
  // Error(NotFound). One row applies at all times; between several, UT1 - TAI is linear, and times
  // beyond them throw Error(InvalidArgument). Throws unless days ascend.
  void SetUt1(std::vector<Ut1Row> rows);
  // Whether the rows answer for a day of UTC.
  bool KnowsUt1(double mjd) const;

  // Throws Error(InvalidArgument) for what is not finite, and beyond the years 1960 (UTC, UT1) or
  // -9999 to 9999 (others).
  double Convert(double seconds, TimeScale from, TimeScale to) const;

  double TtFromTdb(double tdb) const;
  double TdbFromTt(double tt) const;

  // A day of UTC and the seconds since its 0h: up to 86401 on a day with a leap second.
  struct UtcDay {
    int mjd;
    double seconds;
  };
  UtcDay UtcFromTai(double tai) const;
  double TaiFromUtc(const UtcDay& utc) const;

private:
  double Ut1MinusTai(double mjd) const;

  LeapSeconds Leaps_;
  DeltaEt DeltaEt_;
  std::vector<Ut1Row> Ut1_;
};

} // namespace dspace

#endif
