// When a simulation's time is due on the wall clock.
#ifndef DSPACE_SESSION_PACER_H
#define DSPACE_SESSION_PACER_H

namespace dspace::session {

// Counts from the first time that it is asked about, and anew from one that goes back or once the
// rate was changed. A simulation that is late is not slowed down until it has caught up.
class Pacer {
public:
  // Simulation seconds a wall second; 0: none. Throws Error(InvalidArgument) for what is not finite
  // or below 0.
  void SetRate(double rate);
  // Wall seconds from now_s, of any steady clock, until time_s is due; 0: it is.
  double Ahead(double time_s, double now_s);

private:
  double Rate_ = 0;
  bool Began_ = false;
  double Time_ = 0; // simulation time, and
  double Wall_ = 0; // wall time, from which it counts
};

} // namespace dspace::session

#endif
