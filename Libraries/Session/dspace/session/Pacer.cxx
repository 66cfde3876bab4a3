#include <dspace/session/Pacer.h>

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
  this->Began_ = false;
}

double Pacer::Ahead(double time_s, double now_s) {
  if (this->Rate_ == 0 || !std::isfinite(time_s)) {
    return 0; // such a time is refused by whoever is asked to set it
  }
  if (!this->Began_ || time_s < this->Time_) {
    this->Began_ = true;
    this->Time_ = time_s;
    this->Wall_ = now_s;
  }
  return std::max(0.0, (time_s - this->Time_) / this->Rate_ - (now_s - this->Wall_));
}

} // namespace dspace::session
