#include <dspace/link/Pacer.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <dspace/Error.h>

namespace dspace::session {

void Pacer::SetRate(double rate) {
  if (!(std::isfinite(rate) && rate >= 0)) {
    throw Error(Error::Kind::InvalidArgument, "session",
                "the pace is " + std::to_string(rate) +
                    "; accepted: a finite number above 0, or 0 for none");
  }
  this->Rate_ = rate;
  this->Clocks_.clear();
}

double Pacer::Ahead(const std::string& scene, double time_s, double now_s) {
  if (this->Rate_ == 0 || !std::isfinite(time_s)) {
    return 0; // the interpreter rejects such a time
  }
  const auto [at, first] = this->Clocks_.insert({scene, {time_s, now_s}});
  Clock& clock = at->second;
  const double ahead = (time_s - clock.time) / this->Rate_ - (now_s - clock.wall);
  if (first || time_s < clock.time || !(ahead <= LongestPause)) {
    clock = {time_s, now_s};
    return 0;
  }
  return std::max(0.0, ahead);
}

} // namespace dspace::session
