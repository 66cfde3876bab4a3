// Days and epochs in numbers.
#ifndef DSPACE_ANALYSIS_DAYS_H
#define DSPACE_ANALYSIS_DAYS_H

namespace dspace {

constexpr double DaySeconds = 86400.0;    // but for days of UTC with a leap second
constexpr double MjdZero = 2400000.5;     // Julian date at which modified Julian dates begin
constexpr int J2000Mjd = 51544;           // of 2000-01-01, whose noon is J2000
constexpr double J2000Julian = 2451545.0; // Julian date of J2000

} // namespace dspace

#endif
