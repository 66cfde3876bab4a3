#include <dspace/time/TimeScales.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/time/DayText.h>
#include <dspace/time/Days.h>

namespace dspace {
namespace {

constexpr double Earliest = -378677160000.0; // about -9999-01-01
constexpr double Latest = 252455616000.0;    // 10000-01-01 12:00

double SecondsOf(int mjd) {
  return (mjd - J2000Mjd) * DaySeconds - 0.5 * DaySeconds;
}

// Day and seconds in it, of days of 86400 s.
TimeScales::UtcDay Split(double seconds) {
  const double days = std::floor((seconds + 0.5 * DaySeconds) / DaySeconds);
  const int mjd = J2000Mjd + int(days);
  return {mjd, seconds - SecondsOf(mjd)};
}

} // namespace

const char* TimeScaleName(TimeScale scale) {
  switch (scale) {
  case TimeScale::Utc:
    return "UTC";
  case TimeScale::Tai:
    return "TAI";
  case TimeScale::Tt:
    return "TT";
  case TimeScale::Tdb:
    return "TDB";
  case TimeScale::Ut1:
    break;
  }
  return "UT1";
}

TimeScale TimeScaleOf(const std::string& name) {
  std::string upper = name;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return char(std::toupper(c)); });
  for (const TimeScale scale :
       {TimeScale::Utc, TimeScale::Tai, TimeScale::Tt, TimeScale::Tdb, TimeScale::Ut1}) {
    if (upper == TimeScaleName(scale)) {
      return scale;
    }
  }
  Reject("time scale '" + name + "'", "it is unknown; accepted: UTC, TAI, TT, TDB, UT1");
}

TimeScales::TimeScales() : TimeScales(LeapSeconds::FromSystem()) {}

TimeScales::TimeScales(LeapSeconds leapSeconds, const DeltaEt& deltaEt)
    : Leaps_(std::move(leapSeconds)), DeltaEt_(deltaEt) {}

void TimeScales::SetUt1(std::vector<Ut1Row> rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Require(std::isfinite(rows[i].mjd) && rows[i].mjd >= 36934.0 && rows[i].mjd < 3000000.0 &&
                (i == 0 || rows[i].mjd > rows[i - 1].mjd),
            "UT1", "a day (MJD)", rows[i].mjd, "36934 (1960) to 2999999, ascending");
    Require(std::isfinite(rows[i].ut1MinusUtc) && std::abs(rows[i].ut1MinusUtc) <= 1e4, "UT1",
            "UT1 - UTC", rows[i].ut1MinusUtc, "-10000 to 10000 s");
  }
  this->Ut1_ = std::move(rows);
}

bool TimeScales::KnowsUt1(double mjd) const {
  return this->Ut1_.size() == 1 ||
         (!this->Ut1_.empty() && mjd >= this->Ut1_.front().mjd && mjd <= this->Ut1_.back().mjd);
}

double TimeScales::Ut1MinusTai(double mjd) const {
  if (this->Ut1_.empty()) {
    throw Error(Error::Kind::NotFound, "UT1",
                "UT1 - UTC is not known, because it is measured; accepted: a file of the IERS "
                "(finals2000A or EOP C04), loaded as a kernel");
  }
  const auto value = [this](const Ut1Row& row) {
    const double day = std::floor(row.mjd);
    return row.ut1MinusUtc - this->Leaps_.TaiMinusUtc(int(day), row.mjd - day);
  };
  const Ut1Row& first = this->Ut1_.front();
  const Ut1Row& last = this->Ut1_.back();
  if (this->Ut1_.size() == 1) {
    const double day = std::floor(mjd);
    return first.ut1MinusUtc - this->Leaps_.TaiMinusUtc(int(day), mjd - day);
  }
  if (!this->KnowsUt1(mjd)) {
    Reject("UT1", "UT1 - UTC is not known on " + DayText(int(std::floor(mjd))) +
                      "; accepted: " + DayText(int(std::floor(first.mjd))) + " to " +
                      DayText(int(std::floor(last.mjd))));
  }
  auto next = std::upper_bound(this->Ut1_.begin(), this->Ut1_.end(), mjd,
                               [](double day, const Ut1Row& row) { return day < row.mjd; });
  if (next == this->Ut1_.end()) {
    --next;
  }
  const auto before = std::prev(next);
  const double part = (mjd - before->mjd) / (next->mjd - before->mjd);
  return (1.0 - part) * value(*before) + part * value(*next);
}

double TimeScales::TdbFromTt(double tt) const {
  const double mean = this->DeltaEt_.m0 + this->DeltaEt_.m1 * tt;
  return tt + this->DeltaEt_.k * std::sin(mean + this->DeltaEt_.eb * std::sin(mean));
}

double TimeScales::TtFromTdb(double tdb) const {
  double tt = tdb; // the error shrinks by k m1 = 3e-10 a step
  for (int i = 0; i < 3; ++i) {
    tt -= this->TdbFromTt(tt) - tdb;
  }
  return tt;
}

TimeScales::UtcDay TimeScales::UtcFromTai(double tai) const {
  const auto& steps = this->Leaps_.Steps();
  const auto begin = [](const LeapSeconds::Step& step) {
    return SecondsOf(step.mjd) + step.taiMinusUtc;
  };
  if (tai < begin(steps.front())) { // UTC ran at a rate of its own
    UtcDay utc = Split(tai);
    for (int i = 0; i < 4; ++i) {
      const double fraction = std::clamp(utc.seconds / DaySeconds, 0.0, 1.0);
      utc = Split(tai - this->Leaps_.TaiMinusUtc(utc.mjd, fraction));
    }
    if (utc.mjd >= steps.front().mjd) { // within the last 0.1 s of 1971
      utc.seconds += (utc.mjd - (steps.front().mjd - 1)) * DaySeconds;
      utc.mjd = steps.front().mjd - 1;
    }
    return utc;
  }
  const auto after = std::upper_bound(
      steps.begin(), steps.end(), tai,
      [&](double time, const LeapSeconds::Step& step) { return time < begin(step); });
  UtcDay utc = Split(tai - std::prev(after)->taiMinusUtc);
  if (after != steps.end() && utc.mjd >= after->mjd) { // in the leap second
    utc.seconds += (utc.mjd - (after->mjd - 1)) * DaySeconds;
    utc.mjd = after->mjd - 1;
  }
  return utc;
}

double TimeScales::TaiFromUtc(const UtcDay& utc) const {
  return SecondsOf(utc.mjd) + utc.seconds +
         this->Leaps_.TaiMinusUtc(utc.mjd, utc.seconds / DaySeconds);
}

double TimeScales::Convert(double seconds, TimeScale from, TimeScale to) const {
  if (!(seconds >= Earliest && seconds <= Latest)) {
    Reject("time", NumberText(seconds) + " s past J2000 in " + TimeScaleName(from) +
                       "; accepted: a finite number within the years -9999 to 9999");
  }
  if (from == to) {
    return seconds;
  }
  double tai = seconds;
  switch (from) {
  case TimeScale::Utc:
    tai = this->TaiFromUtc(Split(seconds));
    break;
  case TimeScale::Tai:
    break;
  case TimeScale::Tt:
    tai = seconds - this->DeltaEt_.ttMinusTai;
    break;
  case TimeScale::Tdb:
    tai = this->TtFromTdb(seconds) - this->DeltaEt_.ttMinusTai;
    break;
  case TimeScale::Ut1: {
    UtcDay utc = Split(seconds);
    for (int i = 0; i < 3; ++i) {
      tai = seconds - this->Ut1MinusTai(utc.mjd + utc.seconds / DaySeconds);
      utc = this->UtcFromTai(tai);
    }
    break;
  }
  }
  switch (to) {
  case TimeScale::Utc: {
    const UtcDay utc = this->UtcFromTai(tai);
    return SecondsOf(utc.mjd) + utc.seconds;
  }
  case TimeScale::Tai:
    return tai;
  case TimeScale::Tt:
    return tai + this->DeltaEt_.ttMinusTai;
  case TimeScale::Tdb:
    return this->TdbFromTt(tai + this->DeltaEt_.ttMinusTai);
  case TimeScale::Ut1:
    break;
  }
  const UtcDay utc = this->UtcFromTai(tai);
  return tai + this->Ut1MinusTai(utc.mjd + utc.seconds / DaySeconds);
}

} // namespace dspace
