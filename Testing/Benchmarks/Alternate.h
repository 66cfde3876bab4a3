// Measures two ways of doing the same work in one process, in turns, so that whatever else the
// machine does falls on both.
#ifndef DSPACE_BENCH_ALTERNATE_H
#define DSPACE_BENCH_ALTERNATE_H

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

namespace dspace::bench {

inline double Median(std::vector<double> values) {
  const std::size_t middle = values.size() / 2;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(middle),
                   values.end());
  return values[middle];
}

// Seconds of each turn, and subject / reference of each pair.
struct Turns {
  std::vector<double> subject;
  std::vector<double> reference;
  std::vector<double> ratio;
};

// `pairs` turns of both after one that is not counted; who begins changes from pair to pair.
template<class Subject, class Reference>
Turns Alternate(int pairs, Subject subject, Reference reference) {
  using Clock = std::chrono::steady_clock;
  const auto time = [](auto& work) {
    const auto begin = Clock::now();
    work();
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  Turns turns;
  for (int i = -1; i < pairs; ++i) {
    double s = 0.0;
    double r = 0.0;
    if (i % 2 == 0) {
      s = time(subject);
      r = time(reference);
    } else {
      r = time(reference);
      s = time(subject);
    }
    if (i >= 0) {
      turns.subject.push_back(s);
      turns.reference.push_back(r);
      turns.ratio.push_back(s / r);
    }
  }
  return turns;
}

// "frames: ratio 0.05 (0.04..0.07), 51 pairs; 0.03 ms against 0.6 ms; ...": `per` is the number of
// steps in a turn, `behind` what the work consisted of.
inline void Print(const char* name, const Turns& turns, int per, const char* behind) {
  const auto [low, high] = std::minmax_element(turns.ratio.begin(), turns.ratio.end());
  std::printf("%s: ratio %.4f (%.4f..%.4f), %zu pairs; %.4f ms against %.4f ms; %s\n", name,
              Median(turns.ratio), *low, *high, turns.ratio.size(),
              1e3 * Median(turns.subject) / per, 1e3 * Median(turns.reference) / per, behind);
}

} // namespace dspace::bench

#endif
