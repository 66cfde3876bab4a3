#include <dspace/overlay/RoundNumbers.h>

#include <cmath>
#include <cstdio>

namespace dspace {
namespace {

constexpr double Rounding = 1e-9; // of a step

double FirstMultiple(double step, double low) {
  return std::ceil(low / step - Rounding);
}

double LastMultiple(double step, double high) {
  return std::floor(high / step + Rounding);
}

bool Fits(double step, double low, double high, int count) {
  return LastMultiple(step, high) - FirstMultiple(step, low) + 1.0 <= count;
}

} // namespace

double RoundStep(double low, double high, int count, bool angles) {
  const double least = (high - low) / count;
  if (angles && least >= 2.0) {
    for (const double step : {5.0, 10.0, 15.0, 30.0, 45.0, 60.0, 90.0, 180.0}) {
      if (Fits(step, low, high, count)) {
        return step;
      }
    }
  }
  // Of one multiple more than whole steps fit into a range, hence some steps may be too short.
  for (int power = int(std::floor(std::log10(least))) - 1;; ++power) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double step =
          power < 0 ? digit / std::pow(10.0, -power) : digit * std::pow(10.0, power);
      if (Fits(step, low, high, count)) {
        return step;
      }
    }
  }
}

std::vector<double> Multiples(double step, double low, double high) {
  std::vector<double> values;
  for (double n = FirstMultiple(step, low); n <= LastMultiple(step, high); ++n) {
    values.push_back(n * step + 0.0); // no -0
  }
  return values;
}

std::string RoundText(double value, double step) {
  const double size = std::max(std::abs(value), std::abs(step));
  char text[64];
  if (size >= 1e12 || std::abs(step) < 1e-9) {
    std::snprintf(text, sizeof(text), "%.9g", value);
    return text;
  }
  int decimals = 0;
  for (double scaled = std::abs(step);
       decimals < 9 && std::abs(scaled - std::round(scaled)) > 1e-6 * scaled; ++decimals) {
    scaled = std::abs(step) * std::pow(10.0, decimals + 1);
  }
  std::snprintf(text, sizeof(text), "%.*f", decimals, std::abs(value));
  std::string digits = text;
  const bool zero = digits.find_first_not_of("0.") == std::string::npos;
  const std::size_t whole = std::min(digits.find('.'), digits.size());
  for (std::size_t at = whole; at > 3; at -= 3) {
    digits.insert(at - 3, ",");
  }
  return (value < 0.0 && !zero ? "-" : "") + digits;
}

} // namespace dspace
