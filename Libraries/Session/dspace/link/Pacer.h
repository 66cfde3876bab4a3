// Maps simulation time to wall time.
#ifndef DSPACE_SESSION_PACER_H
#define DSPACE_SESSION_PACER_H

#include <map>
#include <string>

namespace dspace::session {

// Each scene has its own origin: the first time that is passed in. The origin is reset when time
// goes back, when a time is due more than LongestPause from now (another epoch), and when the rate
// changes. A late simulation is not slowed down until it has caught up.
class Pacer {
public:
  static constexpr double LongestPause = 3600; // [s] of wall time

  // Simulation seconds per wall second; 0: no pacing. Throws Error(InvalidArgument) if it is not
  // finite or below 0.
  void SetRate(double rate);
  // Wall seconds from now_s (any steady clock) until time_s is due; 0: it is due.
  double Ahead(const std::string& scene, double time_s, double now_s);

private:
  struct Clock {
    double time; // origin: simulation time
    double wall; // origin: wall time
  };
  double Rate_ = 0;
  std::map<std::string, Clock> Clocks_; // by scene
};

} // namespace dspace::session

#endif
