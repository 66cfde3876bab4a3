// Times as texts.
#ifndef DSPACE_ANALYSIS_UTC_TEXT_H
#define DSPACE_ANALYSIS_UTC_TEXT_H

#include <string>

#include <dspace/time/TimeScales.h>

namespace dspace {

// TDB seconds past J2000 of a text in ISO 8601: "2003-07-04T19:00:00.25", a date alone (0h), a date
// and hours and minutes, a day of the year ("2003-185T19:00:00"); a space in place of T. Second 60
// is accepted where UTC has a leap second. The text is UTC unless a scale follows it: "Z",
// "+02:00", " UTC", " TAI", " TT", " TDB", " UT1". "JD 2451545.0 TDB" is a Julian date, whose scale
// must be given. Years 1960 (UTC, UT1) or 0001 (others) to 9999. Throws Error(InvalidArgument) with
// what is accepted.
double TdbFromText(const std::string& text, const TimeScales& scales);

// "2003-07-04T19:00:00.250" in UTC (or another scale), rounded to `decimals` (0 to 9) of a second;
// no suffix: the caller adds it. Throws Error(InvalidArgument) beyond the years of TdbFromText.
std::string UtcText(double tdb, const TimeScales& scales, int decimals = 3);
std::string TimeText(double tdb, TimeScale scale, const TimeScales& scales, int decimals = 3);

// For errors: UtcText with "UTC" behind it, and TDB where UTC does not exist.
std::string TimeLabel(double tdb, const TimeScales& scales);

} // namespace dspace

#endif
