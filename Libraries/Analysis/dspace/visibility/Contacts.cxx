#include <dspace/visibility/Contacts.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Geometry>

#include <dspace/Checks.h>
#include <dspace/ephemeris/BodyNames.h>

namespace dspace {
namespace {

constexpr double Precision = 1.0e-3; // [s] of rise, set and peak
constexpr int MostIterations = 200;

struct Sample {
  double time = 0.0;
  Sighted seen;
};

class Finder {
public:
  Finder(const std::function<Sighted(double)>& look, double start, double end, double step)
      : Look_(look), Start_(start), End_(end), Step_(step) {}

  std::vector<Contact> Find() {
    const auto count = std::max<std::int64_t>(
        1, std::int64_t(std::ceil((this->End_ - this->Start_) / this->Step_ - 1e-9)));
    Sample last = this->At(this->Start_);
    Sample present = last;
    this->Take(last);
    for (std::int64_t i = 1; i <= count; ++i) {
      const Sample next =
          this->At(i == count ? this->End_ : this->Start_ + double(i) * this->Step_);
      if (i > 1) {
        this->Turn(last, present, next);
      }
      this->Take(next);
      last = present;
      present = next;
    }
    // The samples that Turn added are out of order.
    std::sort(this->Samples_.begin(), this->Samples_.end(),
              [](const Sample& a, const Sample& b) { return a.time < b.time; });
    return this->Join();
  }

private:
  Sample At(double time) const { return {time, this->Look_(time)}; }
  static bool In(const Sample& sample) { return sample.seen.margin_deg >= 0.0; }

  void Take(const Sample& sample) { this->Samples_.push_back(sample); }

  // Three samples on one side whose middle is nearest to the other side.
  void Turn(const Sample& a, const Sample& b, const Sample& c) {
    if (In(a) != In(b) || In(b) != In(c)) {
      return;
    }
    const double sign = In(b) ? -1.0 : 1.0; // of what becomes greatest
    const auto of = [&](const Sample& s) { return sign * s.seen.margin_deg; };
    if (!(of(b) >= of(a) && of(b) >= of(c))) {
      return;
    }
    const Sample best = this->Greatest(a.time, c.time, of);
    if (In(best) != In(b)) {
      this->Take(best);
    }
  }

  // Golden-section search.
  template<class Of> Sample Greatest(double from, double to, Of of) const {
    const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
    Sample left = this->At(to - golden * (to - from));
    Sample right = this->At(from + golden * (to - from));
    while (to - from > Precision) {
      if (of(left) < of(right)) {
        from = left.time;
        left = right;
        right = this->At(from + golden * (to - from));
      } else {
        to = right.time;
        right = left;
        left = this->At(to - golden * (to - from));
      }
    }
    return of(left) < of(right) ? right : left;
  }

  // The sample on the side that is in contact, within Precision of the crossing.
  Sample Cross(Sample a, Sample b) const {
    for (int i = 0; i < MostIterations && b.time - a.time > Precision; ++i) {
      const Sample middle = this->At(0.5 * (a.time + b.time));
      (In(middle) == In(a) ? a : b) = middle;
    }
    return In(a) ? a : b;
  }

  std::vector<Contact> Join() const {
    std::vector<Contact> contacts;
    for (std::size_t i = 0; i < this->Samples_.size(); ++i) {
      if (!In(this->Samples_[i])) {
        continue;
      }
      std::size_t last = i;
      std::size_t highest = i;
      while (last + 1 < this->Samples_.size() && In(this->Samples_[last + 1])) {
        ++last;
        if (Elevation(this->Samples_[last]) > Elevation(this->Samples_[highest])) {
          highest = last;
        }
      }
      Contact contact;
      contact.sinceBefore = i == 0;
      contact.untilAfter = last + 1 == this->Samples_.size();
      const Sample rise = contact.sinceBefore
                              ? this->Samples_[i]
                              : this->Cross(this->Samples_[i - 1], this->Samples_[i]);
      const Sample set = contact.untilAfter
                             ? this->Samples_[last]
                             : this->Cross(this->Samples_[last], this->Samples_[last + 1]);
      Sample peak = this->Samples_[highest];
      const double from =
          std::max(rise.time, highest > 0 ? this->Samples_[highest - 1].time : rise.time);
      const double to =
          std::min(set.time, highest + 1 < this->Samples_.size() ? this->Samples_[highest + 1].time
                                                                 : set.time);
      if (to - from > Precision) {
        const Sample top = this->Greatest(from, to, Elevation);
        peak = Elevation(top) > Elevation(peak) ? top : peak;
      }
      for (const Sample& end : {rise, set}) {
        peak = Elevation(end) >= Elevation(peak) ? end : peak;
      }
      contact.rise = rise.time;
      contact.atRise = rise.seen;
      contact.set = set.time;
      contact.atSet = set.seen;
      contact.peak = peak.time;
      contact.atPeak = peak.seen;
      contacts.push_back(contact);
      i = last;
    }
    return contacts;
  }
  static double Elevation(const Sample& sample) { return sample.seen.direction.elevation_deg; }

  const std::function<Sighted(double)>& Look_;
  double Start_, End_, Step_;
  std::vector<Sample> Samples_;
};

// The point's direction from the place is that of its apparent position.
Sighted LookAtPoint(const Ephemeris& ephemeris, const Frames& frames, const SkyPlace& place,
                    const ContactTarget& target, double tdb) {
  const SightedPoint point = SightPoint(ephemeris, frames, place, target.point, tdb);
  Sighted seen;
  seen.range = point.away.norm();
  // Positions from the solar system's barycentre are rounded to 3e-5 m.
  Require(seen.range >= 0.01, "contacts", "the distance between the place and the target",
          seen.range, "0.01 m or more");
  seen.direction =
      ToAzimuthElevation(place.axes.toLocal * (frames.Rotation("J2000", place.frame, tdb) *
                                               Aberrated(point.away, point.observer.velocity)));
  seen.margin_deg = target.stationMask_deg
                        ? ElevationFrom(frames, point, tdb) - *target.stationMask_deg
                        : std::numeric_limits<double>::infinity();
  return seen;
}

} // namespace

void RequireSpan(double start, double end, double step) {
  if (!(std::isfinite(start) && std::isfinite(end) && start < end)) {
    Reject("contacts", "the span runs from " + NumberText(start) + " to " + NumberText(end) +
                           " s; accepted: an end after the start");
  }
  Require(step > 0.0 && (end - start) / step <= double(MostSteps), "contacts", "the step", step,
          "more than 0 s, and at most 2,000,000 steps in the span");
}

std::vector<Contact> FindContacts(const std::function<Sighted(double)>& look, double start,
                                  double end, double step) {
  RequireSpan(start, end, step);
  return Finder(look, start, end, step).Find();
}

Sighted LookOver(const Ephemeris& ephemeris, const Frames& frames, const SkyPlace& place,
                 const HorizonLine& horizon, const ContactTarget& target, double tdb, bool upper) {
  if (target.point) {
    if (target.stationMask_deg && target.body == place.body) {
      Reject("station on body '" + ephemeris.Names().NameOf(target.body) + "'",
             "the place is on the same body; accepted: a station on another one (a line of sight "
             "for this one)");
    }
    Sighted seen = LookAtPoint(ephemeris, frames, place, target, tdb);
    seen.margin_deg = std::min(seen.margin_deg, horizon.TopOver(seen.direction, 0.0));
    return seen;
  }
  const SkyBody body = Look(ephemeris, frames, place, target.body, tdb);
  return {body.direction, body.range,
          horizon.TopOver(body.direction,
                          upper ? std::min(body.radius_deg, HorizonLine::MostRadius) : 0.0)};
}

} // namespace dspace
