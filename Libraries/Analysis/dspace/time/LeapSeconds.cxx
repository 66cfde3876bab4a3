#include <dspace/time/LeapSeconds.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <erfa.h>
#include <erfaextra.h>

#include <dspace/Checks.h>
#include <dspace/FilesRead.h>
#include <dspace/SystemFiles.h>
#include <dspace/time/DayText.h>
#include <dspace/time/Days.h>

namespace dspace {
namespace {

constexpr int FirstDay = 36934;      // 1960-01-01
constexpr int FirstWholeDay = 41317; // 1972-01-01: whole seconds from here on

int DayOf(int year, int month) {
  double zero = 0.0, mjd = 0.0;
  eraCal2jd(year, month, 1, &zero, &mjd);
  return int(mjd);
}

LeapSeconds ReadList(const std::string& path) {
  const std::string object = "leap seconds '" + path + "'";
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw Error(Error::Kind::Io, object, "the file cannot be opened");
  }
  const auto damaged = [&](const std::string& what) -> Error {
    return {Error::Kind::Corrupt, object, what + "; accepted: a leap-seconds.list of the IERS"};
  };
  constexpr int NtpZero = 15020; // MJD of 1900-01-01
  const auto dayOf = [&](double seconds) {
    if (!(seconds >= 0.0 && seconds < 1e12) || std::fmod(seconds, 86400.0) != 0.0) {
      throw damaged("the time " + NumberText(seconds) + " is not the beginning of a day");
    }
    return NtpZero + int(seconds / 86400.0);
  };
  std::vector<LeapSeconds::Step> steps;
  std::optional<int> expires;
  std::string line;
  std::size_t length = 0;
  while (std::getline(file, line)) {
    length += line.size() + 1;
    if (length > (1 << 20)) {
      throw damaged("the file is longer than 1 MiB");
    }
    if (line.rfind("#@", 0) == 0) {
      double seconds = -1.0;
      if (!(std::istringstream(line.substr(2)) >> seconds)) {
        throw damaged("the line of its expiry, '" + line + "', has no number");
      }
      expires = NtpZero + int(std::floor(seconds / 86400.0));
      continue;
    }
    const std::string content = line.substr(0, line.find('#'));
    if (content.find_first_not_of(" \t\r") == std::string::npos) {
      continue;
    }
    double seconds = 0.0, difference = 0.0;
    if (!(std::istringstream(content) >> seconds >> difference)) {
      throw damaged("the line '" + content + "' is not a time and a number of seconds");
    }
    steps.push_back({dayOf(seconds), difference});
  }
  if (steps.empty()) {
    throw damaged("the file has no leap seconds");
  }
  try {
    return LeapSeconds::FromSteps(std::move(steps), "'" + path + "'", expires);
  } catch (const Error& error) {
    throw damaged(error.what());
  }
}

} // namespace

const char* LeapSeconds::SystemList() {
  return "/usr/share/zoneinfo/leap-seconds.list";
}

LeapSeconds LeapSeconds::FromErfa() {
  return Erfa();
}

const LeapSeconds& LeapSeconds::Erfa() {
  static const LeapSeconds table = [] {
    eraLEAPSECOND* rows = nullptr;
    const int count = eraGetLeapSeconds(&rows);
    std::vector<Step> steps;
    for (int i = 0; i < count; ++i) {
      if (rows[i].iyear >= 1972) {
        steps.push_back({DayOf(rows[i].iyear, rows[i].month), rows[i].delat});
      }
    }
    // eraDat calls years dubious that are well after its release.
    std::optional<int> expires;
    for (int year = 2021; year < 2200 && !expires; ++year) {
      double difference = 0.0;
      if (eraDat(year, 1, 1, 0.0, &difference) == 1) {
        expires = DayOf(year, 1);
      }
    }
    return FromSteps(std::move(steps), "ERFA", expires);
  }();
  return table;
}

LeapSeconds LeapSeconds::FromList(const std::string& path) {
  NoteFileRead(path);
  return ReadList(path);
}

LeapSeconds LeapSeconds::FromSystem() {
  static const LeapSeconds table = [] {
    const LeapSeconds erfa = FromErfa();
    if (!std::ifstream(SystemList())) {
      return erfa;
    }
    try {
      LeapSeconds list =
          ReadList(SystemList()); // not noted: a file of the system, not of a command
      const bool goesOn = list.Steps_.size() >= erfa.Steps_.size() &&
                          std::equal(erfa.Steps_.begin(), erfa.Steps_.end(), list.Steps_.begin(),
                                     [](const Step& a, const Step& b) {
                                       return a.mjd == b.mjd && a.taiMinusUtc == b.taiMinusUtc;
                                     });
      const bool later = list.Expires_ && (!erfa.Expires_ || *list.Expires_ > *erfa.Expires_);
      return goesOn && (later || list.Steps_.size() > erfa.Steps_.size()) ? list : erfa;
    } catch (const Error&) {
      return erfa; // the list is an addition to a complete table
    }
  }();
  NoteSystemFile(SystemList());
  return table;
}

LeapSeconds LeapSeconds::FromSteps(std::vector<Step> steps, std::string source,
                                   std::optional<int> expires_mjd) {
  const std::string object = "leap seconds of " + source;
  if (steps.empty()) {
    Reject(object, "there are none; accepted: at least that of 1972-01-01");
  }
  if (steps.front().mjd != FirstWholeDay || steps.front().taiMinusUtc != 10.0) {
    Reject(object, "the first is TAI - UTC = " + NumberText(steps.front().taiMinusUtc) +
                       " s on MJD " + std::to_string(steps.front().mjd) +
                       "; accepted: 10 s on 1972-01-01, MJD 41317");
  }
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const double change = steps[i].taiMinusUtc - steps[i - 1].taiMinusUtc;
    if (steps[i].mjd <= steps[i - 1].mjd || steps[i].mjd > 3000000 || std::abs(change) != 1.0) {
      Reject(object, "TAI - UTC = " + NumberText(steps[i].taiMinusUtc) + " s on MJD " +
                         std::to_string(steps[i].mjd) + " follows " +
                         NumberText(steps[i - 1].taiMinusUtc) + " s on MJD " +
                         std::to_string(steps[i - 1].mjd) +
                         "; accepted: later days, and steps of one second");
    }
  }
  LeapSeconds table;
  table.Steps_ = std::move(steps);
  table.Source_ = std::move(source);
  table.Expires_ = expires_mjd;
  return table;
}

double LeapSeconds::TaiMinusUtc(int mjd, double dayFraction) const {
  if (mjd < FirstDay) {
    Reject("time", "a day in UTC, MJD " + std::to_string(mjd) +
                       ", is before 1960-01-01, when UTC began; accepted: later days, or the time "
                       "in TDB, TT or TAI");
  }
  if (mjd < FirstWholeDay) {
    int year = 0, month = 0, day = 0;
    double fraction = 0.0, difference = 0.0;
    eraJd2cal(MjdZero, mjd, &year, &month, &day, &fraction);
    eraDat(year, month, day, std::clamp(dayFraction, 0.0, 1.0), &difference);
    return difference;
  }
  const auto after = std::upper_bound(this->Steps_.begin(), this->Steps_.end(), mjd,
                                      [](int day, const Step& step) { return day < step.mjd; });
  return std::prev(after)->taiMinusUtc;
}

std::string LeapSeconds::Lacking() const {
  const std::vector<Step>& known = Erfa().Steps();
  const Step& last = this->Steps_.back();
  const auto next = std::find_if(known.begin(), known.end(),
                                 [&](const Step& step) { return step.mjd > last.mjd; });
  if (next == known.end()) {
    return {};
  }
  const double seconds = known.back().taiMinusUtc - last.taiMinusUtc;
  return "the leap seconds of " + this->Source_ + " end before that of " + DayText(next->mjd) +
         ", which ERFA has: UTC from that day on is off by up to " + NumberText(seconds) +
         " s; load a newer LSK";
}

int LeapSeconds::SecondsOfDay(int mjd) const {
  if (mjd < FirstWholeDay) {
    return 86400;
  }
  return 86400 + int(std::lround(this->TaiMinusUtc(mjd + 1) - this->TaiMinusUtc(mjd)));
}

std::string LeapSeconds::WarningAt(int mjd) const {
  if (this->Expires_ && mjd >= *this->Expires_) {
    return "the leap seconds of " + this->Source_ + " are known up to " + DayText(*this->Expires_) +
           ": UTC on " + DayText(mjd) +
           " may be off by a second or more; an LSK or a newer tzdata brings later ones";
  }
  if (mjd > this->Steps_.back().mjd && this->TaiMinusUtc(mjd) != Erfa().TaiMinusUtc(mjd)) {
    return this->Lacking();
  }
  return {};
}

} // namespace dspace
