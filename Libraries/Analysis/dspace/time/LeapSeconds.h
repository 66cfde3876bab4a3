// TAI - UTC: when leap seconds were inserted.
#ifndef DSPACE_ANALYSIS_LEAP_SECONDS_H
#define DSPACE_ANALYSIS_LEAP_SECONDS_H

#include <optional>
#include <string>
#include <vector>

namespace dspace {

// A table of TAI - UTC. Days are Modified Julian Dates of UTC.
//
// From 1960 to 1972, UTC had steps of fractions of a second and ran at a rate of its own: every
// table takes these from ERFA (eraDat). SPICE instead takes TAI - UTC = 9 s for all times before
// 1972.
class LeapSeconds {
public:
  // From 0h UTC of the day `mjd` on, TAI - UTC is `taiMinusUtc` [s].
  struct Step {
    int mjd;
    double taiMinusUtc;
  };

  // ERFA's own table (the IERS's Bulletin C up to ERFA's release).
  static LeapSeconds FromErfa();
  // A file leap-seconds.list of the IERS, as the system's tzdata brings it: after a leap second
  // that ERFA's release does not know yet, it knows it. Throws Error(Io, Corrupt).
  static LeapSeconds FromList(const std::string& path);
  // The system's list (SystemList) where it exists and goes on from ERFA's table, else ERFA's
  // table.
  static LeapSeconds FromSystem();
  // Steps in ascending order, from 1972 on (mjd 41317); those of an LSK. `source` names them in
  // texts. Throws Error(InvalidArgument) unless days ascend and each step is a whole second.
  static LeapSeconds FromSteps(std::vector<Step> steps, std::string source,
                               std::optional<int> expires_mjd = std::nullopt);
  static const char* SystemList(); // "/usr/share/zoneinfo/leap-seconds.list"

  // TAI - UTC [s] on the day `mjd`, at the fraction `dayFraction` (0 to 1) of it. Throws
  // Error(InvalidArgument) before 1960: UTC did not exist.
  double TaiMinusUtc(int mjd, double dayFraction = 0.0) const;
  // Length of the day [s]: 86400, 86401 with a leap second at its end. Before 1972: 86400.
  int SecondsOfDay(int mjd) const;

  const std::vector<Step>& Steps() const { return this->Steps_; } // from 1972 on
  const std::string& Source() const { return this->Source_; }
  // The day from which on the table may lack a leap second; absent: not stated.
  std::optional<int> Expires() const { return this->Expires_; }
  // A warning where ERFA's table goes on after this one's last leap second; empty: it does not.
  std::string Lacking() const;
  // A warning for a day on which the table has expired, or lacks a leap second; empty: none.
  std::string WarningAt(int mjd) const;

private:
  LeapSeconds() = default;
  static const LeapSeconds& Erfa(); // FromErfa, made once
  std::vector<Step> Steps_;
  std::string Source_;
  std::optional<int> Expires_;
};

} // namespace dspace

#endif
