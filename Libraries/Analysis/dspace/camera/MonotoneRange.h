// Functions of one number that grow from 0 on: how far, and where they take a value.
#ifndef DSPACE_CAMERA_MONOTONE_RANGE_H
#define DSPACE_CAMERA_MONOTONE_RANGE_H

#include <algorithm>
#include <cmath>

namespace dspace {

// The first place in [0, end] where the slope is not positive, or `end`. The search looks at 2,000
// places, then bisects.
template<class Slope> double MonotoneRange(double end, Slope slope) {
  constexpr int Places = 2000;
  double inside = 0.0;
  for (int i = 0; i <= Places; ++i) {
    double outside = end * i / Places;
    if (!(slope(outside) > 0.0)) {
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (inside + outside);
        (slope(middle) > 0.0 ? inside : outside) = middle;
      }
      return inside;
    }
    inside = outside;
  }
  return end;
}

// Where f(t, slope), which grows from 0 in [0, end] and sets its slope, is `value`: Newton's steps
// within a bracket.
template<class Function> double SolveMonotone(double value, double end, Function f) {
  double low = 0.0, high = end;
  double t = std::min(value, end);
  for (int i = 0; i < 100; ++i) {
    double slope = 1.0;
    const double error = f(t, slope) - value;
    if (error == 0.0) {
      return t;
    }
    (error > 0.0 ? high : low) = t;
    double next = t - error / slope;
    if (!(next > low && next < high)) {
      next = 0.5 * (low + high);
    }
    if (std::abs(next - t) <= 1e-16 * (1.0 + std::abs(t))) {
      return next;
    }
    t = next;
  }
  return t;
}

} // namespace dspace

#endif
