// When a simulation's time is due on the wall clock.
#ifndef DSPACE_SESSION_PACER_H
#define DSPACE_SESSION_PACER_H

#include <map>
#include <string>

namespace dspace::session {

// Counts, for each scene by itself, from the first time that it is asked about, and anew from one
// that goes back, from one that is due more than LongestPause from now (another epoch), and once
// the rate was changed. A simulation that is late is not slowed down until it has caught up.
class Pacer {
public:
  static constexpr double LongestPause = 3600; // [s] of wall time

  // Simulation seconds a wall second; 0: none. Throws Error(InvalidArgument) for what is not finite
  // or below 0.
  void SetRate(double rate);
  // Wall seconds from now_s, of any steady clock, until time_s is due; 0: it is.
  double Ahead(const std::string& scene, double time_s, double now_s);

private:
  struct Clock {
    double time; // simulation time, and
    double wall; // wall time, from which it counts
  };
  double Rate_ = 0;
  std::map<std::string, Clock> Clocks_; // by scene
};

} // namespace dspace::session

#endif
