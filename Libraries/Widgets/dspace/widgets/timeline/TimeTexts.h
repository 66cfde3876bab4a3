// Simulation times as text.
#ifndef DSPACE_WIDGETS_TIME_TEXTS_H
#define DSPACE_WIDGETS_TIME_TEXTS_H

#include <string>
#include <vector>

namespace dspace::widgets {

// "2017-01-01 00:00:00.000 UTC" of TDB seconds past J2000, to the nearest millisecond, with the
// leap seconds up to that of 2017-01-01 (IERS Bulletin C); 23:59:60 is the leap second. TDB - TT is
// that of the USNO Circular 179, eq. 2.6, within 10 us from 1600 to 2200. Before 1972, when UTC got
// its present form, the text is of TT. "" beyond 10,000 years from J2000, and for NaN.
std::string UtcText(double tdb_s);

// "T+ 01:02:03.456", "T- 00:00:01.000", "T+ 2 d 03:04:05.678", to the nearest millisecond. "" for
// values that are not finite.
std::string ElapsedText(double seconds);

// What a tick of a time axis with this step says about a time since the axis' zero [s]: "0.25",
// "12:30", "1:00:00", "3 d", "3 d 12:00".
std::string TickText(double seconds, double step_s);

// The least round step [s] of which at most `count` (> 0) multiples lie from `low_s` to `high_s`
// (low < high): up to 50 s as RoundStep() (dspace/overlay/RoundNumbers.h), then 1, 2, 5, 10, 15, 30
// minutes, 1, 2, 3, 6, 12 hours, and round numbers of days.
double TimeStep(double low_s, double high_s, int count);

} // namespace dspace::widgets

#endif
