// Equal steps of a span of time.
#ifndef DSPACE_TIME_TIME_STEPS_H
#define DSPACE_TIME_TIME_STEPS_H

#include <cstdint>

namespace dspace {

// How many of start, start + step, start + 2 step, ... lie before the end, at least 1; all [s past
// J2000 TDB], start < end, step > 0. A step that is less than 5 ms (and less than a tenth of a
// step) before the end counts as the end: between two UTC texts that are whole steps apart, TDB
// differs from these by up to 3.4 ms, its periodic terms (IERS Conventions 2010, 10.1).
std::int64_t StepsBefore(double start, double end, double step);

} // namespace dspace

#endif
