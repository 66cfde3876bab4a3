// States of bodies from other bodies, out of several sources.
#ifndef DSPACE_ANALYSIS_EPHEMERIS_H
#define DSPACE_ANALYSIS_EPHEMERIS_H

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <dspace/ephemeris/BodyNames.h>
#include <dspace/ephemeris/FrameTurns.h>
#include <dspace/ephemeris/StateSource.h>
#include <dspace/time/TimeScales.h>

namespace dspace {

// How the light that reaches the observer changes a target's state.
enum class Correction {
  None,          // the geometric state
  LightTime,     // LT: where the target was when the light left it, by one iteration
  LightTimeStar, // LT+S: with stellar aberration
  Converged,     // CN: LT, iterated until it converges
  ConvergedStar  // CN+S
};
// "NONE", "LT", "LT+S", "CN", "CN+S"; case does not matter. Throws Error(InvalidArgument).
Correction CorrectionOf(const std::string& text);
const char* CorrectionText(Correction correction);
bool HasStar(Correction correction); // stellar aberration

constexpr double SpeedOfLight = 299792458.0; // [m/s]

// Combines sources as SPICE combines kernels: a body's state comes from the first source in the
// order of search that knows it at the time, and states are chained through the bodies in between
// (a moon, its planet's barycentre, the solar system's barycentre).
//
// Order of search: what is loaded later comes first, as in SPICE, or on request after all others.
// Reading is safe from several threads, as long as none changes it.
class Ephemeris {
public:
  enum class Priority { First, Last };

  struct Query {
    int target = 0; // NAIF ids
    int observer = 0;
    std::string frame = "J2000"; // of the result
    Correction correction = Correction::None;
  };
  struct Result {
    State state;            // of the target from the observer [m, m/s]
    double lightTime = 0.0; // [s] one way; with Correction::None that of the geometric distance
  };
  // One link of the chain of a state, and where it came from.
  struct Used {
    int body = 0;
    int center = 0;
    std::string source;              // StateSource::Name
    std::string segment;             // Coverage::name
    std::string accuracy;            // StateSource::Accuracy; empty: not stated
    std::string warning;             // as a FallbackScope has it
    std::vector<std::string> hidden; // names of sources that know this state too and were not asked
  };

  Ephemeris();
  ~Ephemeris();

  // Throws Error(AlreadyExists) for a name that is taken.
  void Load(std::shared_ptr<const StateSource> source, Priority priority = Priority::First);
  // Throws Error(NotFound) with the names of the sources.
  void Unload(const std::string& name);
  const std::vector<std::shared_ptr<const StateSource>>& Sources() const; // in the order of search

  // The frames of queries and of sources. Without it J2000 and ECLIPJ2000.
  void SetFrames(std::shared_ptr<const FrameTurns> frames);
  const FrameTurns& Frames() const { return *this->Frames_; }
  // For the texts of errors.
  void SetTimeScales(TimeScales scales) { this->Scales_ = std::move(scales); }
  const TimeScales& GetTimeScales() const { return this->Scales_; }
  BodyNames& Names() { return this->Names_; }
  const BodyNames& Names() const { return this->Names_; }

  // Throws Error(NotFound) for a body that no source knows and for an unknown frame,
  // Error(InvalidArgument) for a time outside of what the sources cover, with the spans that they
  // do cover, and what sources throw. Where a state, also one that a light time or an aberration
  // needs, comes from a source with a warning, a FallbackScope has it; also where a source of
  // Priority::Last answers for one of Priority::First that knows the body at other times.
  Result Find(const Query& query, double tdb) const;
  // The same for many times; `results` holds `count`.
  void FindMany(const Query& query, const double* tdb, std::size_t count, Result* results) const;
  // By names, in J2000 unless stated: Find("MOON", "EARTH", tdb).
  State Find(const std::string& target, const std::string& observer, double tdb,
             const std::string& frame = "J2000", Correction correction = Correction::None) const;
  // A body's geometric state from the solar system's barycentre, in J2000.
  State FromBarycenter(int body, double tdb) const;
  // The sources that the geometric state at `tdb` comes from, link by link.
  std::vector<Used> Explain(const Query& query, double tdb) const;
  // When a body's states are known, and from which centres, by all sources in the order of search.
  std::vector<StateSource::Coverage> CoverageOf(int body) const;

private:
  struct Known {
    StateSource::Link link;
    std::size_t source = 0;
  };
  std::optional<Known> LinkOf(int body, double tdb) const;
  State AxesJ2000(const StateSource::Link& link, double tdb) const;
  // In J2000. `used`: the bodies whose links were followed.
  State Geometric(int target, int observer, double tdb, std::vector<int>* used = nullptr) const;
  // In J2000; `lightTimeRate`: its derivative.
  Result Apparent(int target, int observer, double tdb, Correction correction,
                  double* lightTimeRate) const;
  Result Evaluate(const Query& query, int frame, double tdb, const StateTurn* turn) const;
  [[noreturn]] void Missing(int body, double tdb) const;
  void Index();
  // For who uses the link of `body` that this source gave; empty: none.
  std::string WarningOf(int body, std::size_t source) const;

  std::vector<std::shared_ptr<const StateSource>> Sources_;
  std::size_t First_ = 0; // number of sources of Priority::First, which stand first
  std::unordered_map<int, std::vector<std::size_t>> ByBody_; // sources in the order of search
  std::shared_ptr<const FrameTurns> Frames_;
  BodyNames Names_;
  TimeScales Scales_;
};

} // namespace dspace

#endif
