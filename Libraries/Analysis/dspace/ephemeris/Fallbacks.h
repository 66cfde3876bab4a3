// Reports when results come from data of lower accuracy than the loaded data.
#ifndef DSPACE_ANALYSIS_FALLBACKS_H
#define DSPACE_ANALYSIS_FALLBACKS_H

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <dspace/time/TimeScales.h>

namespace dspace {

// Collects the warnings of sources that this thread uses during the scope's lifetime: of every
// time, and of every state that a light time or an aberration needs. Scopes nest: the innermost
// collects, the outer ones do not get its warnings. Without a scope nothing is collected.
class FallbackScope {
public:
  FallbackScope();
  ~FallbackScope();
  FallbackScope(const FallbackScope&) = delete;
  FallbackScope& operator=(const FallbackScope&) = delete;

  // What follows answers for `tdb` [s past J2000], until the next call. Ephemeris::FindMany calls
  // it for each of its times. The same time twice in a row counts once.
  static void Begin(double tdb);
  // A source that has a warning is used; the empty text is none.
  static void Note(const std::string& warning);
  // The texts that the innermost scope of this thread has, each once, in the order of their use.
  static std::vector<std::string> Noted();

  // The texts, each with the number of times that it holds for and their span, where there were
  // several times. `scales`: for the texts of times.
  std::vector<std::string> Warnings(const TimeScales& scales) const;

private:
  struct Entry {
    std::string text;
    std::size_t last = 0; // the index of the time that it was noted for last
    std::size_t count = 0;
    double begin = 0.0; // TDB [s past J2000]
    double end = 0.0;
  };
  std::vector<Entry> Entries_;
  std::size_t Times_ = 0;
  double Time_ = std::numeric_limits<double>::quiet_NaN();
  FallbackScope* Outer_;
};

} // namespace dspace

#endif
