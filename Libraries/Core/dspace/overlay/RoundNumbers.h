// Round numbers for scales and labels, and how they are written.
#ifndef DSPACE_SCENE_ROUND_NUMBERS_H
#define DSPACE_SCENE_ROUND_NUMBERS_H

#include <string>
#include <vector>

namespace dspace {

// The least round step (1, 2 or 5 times a power of ten; of `angles` in degrees also 15, 30, 45, 60,
// 90, 180) of which at most `count` (> 0) multiples lie from `low` to `high`, both finite, low <
// high.
double RoundStep(double low, double high, int count, bool angles);

// Its multiples from `low` to `high`.
std::vector<double> Multiples(double step, double low, double high);

// A multiple of `step`, with the decimals that the step needs (up to 9) and commas between
// thousands: "-12,000", "0.25". Beyond 1e12 and below 1e-9 with an exponent.
std::string RoundText(double value, double step);

} // namespace dspace

#endif
