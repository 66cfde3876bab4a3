#include <dspace/ephemeris/ErfaSource.h>

#include <array>

#include <Eigen/Core>

#include <erfa.h>

#include <dspace/ephemeris/BodyNames.h>
#include <dspace/time/Days.h>

namespace dspace {
namespace {

constexpr double Au = 149597870700.0;         // [m] (IAU 2012 B2)
constexpr double SeriesBegin = -3155716800.0; // 1900-01-01
constexpr double SeriesEnd = 3155760000.0;    // 2100-01-01 12:00

State StateOf(const double pv[2][3]) {
  State state;
  for (int i = 0; i < 3; ++i) {
    state.position[i] = pv[0][i] * Au;
    state.velocity[i] = pv[1][i] * Au / DaySeconds;
  }
  return state;
}

// The Sun, or the Earth, from the barycentre.
State FromBarycenter(double tdb, bool sun) {
  double heliocentric[2][3], barycentric[2][3];
  eraEpv00(J2000Julian, tdb / DaySeconds, heliocentric, barycentric);
  State state = StateOf(barycentric);
  if (sun) {
    state -= StateOf(heliocentric);
  }
  return state;
}

State MoonFromEarth(double tdb) {
  double pv[2][3];
  eraMoon98(J2000Julian, tdb / DaySeconds, pv);
  return StateOf(pv);
}

Eigen::Vector3d PlanetAt(double tdb, int planet) {
  double pv[2][3];
  eraPlan94(J2000Julian, tdb / DaySeconds, planet, pv);
  return StateOf(pv).position;
}

// eraPlan94's own velocity is that of an ellipse, without the changes of its elements: up to 37 m/s
// off. Differences of the positions are up to 6 m/s off.
State PlanetFromSun(double tdb, int planet) {
  constexpr double Step = 600.0;
  return {PlanetAt(tdb, planet),
          (PlanetAt(tdb + Step, planet) - PlanetAt(tdb - Step, planet)) / (2.0 * Step)};
}

} // namespace

ErfaSource::ErfaSource() {
  const auto add = [this](int body, int center) {
    this->Coverages_.push_back({body, center, 1, SeriesBegin, SeriesEnd, {}});
  };
  add(10, 0);
  add(399, 0);
  add(301, 399);
  add(3, 399);
  for (const int planet : {1, 2, 4, 5, 6, 7, 8}) {
    add(planet, 10);
  }
  add(199, 1);
  add(299, 2);
  add(499, 4);
}

const std::string& ErfaSource::Name() const {
  static const std::string name = "ERFA";
  return name;
}

// The Moon, the Earth and the Sun as eraMoon98 and eraEpv00 document them. Planets: the largest
// distance from DE405 in 1960 to 2060 (TestEphemeris); eraPlan94 documents angles.
std::string ErfaSource::Accuracy(int body) const {
  switch (body) {
  case 301:
    return "up to 32 km off (eraMoon98)";
  case 3:
  case 399:
  case 10:
    return "up to 14 km off (eraEpv00)";
  case 1:
  case 199:
    return "up to 1,500 km off in 1960 to 2060, not compared beyond (eraPlan94)";
  case 2:
  case 299:
    return "up to 3,200 km off in 1960 to 2060, not compared beyond (eraPlan94)";
  case 4:
  case 499:
    return "up to 27,000 km off in 1960 to 2060, not compared beyond (eraPlan94)";
  case 5:
    return "up to 180,000 km off in 1960 to 2060, not compared beyond (eraPlan94)";
  case 6:
    return "up to 540,000 km off in 1960 to 2060, not compared beyond (eraPlan94)";
  case 7:
    return "up to 970,000 km off in 1960 to 2060, not compared beyond (eraPlan94)";
  case 8:
    return "up to 260,000 km off in 1960 to 2060, not compared beyond (eraPlan94)";
  default:
    return {};
  }
}

std::string ErfaSource::Warning(int body) const {
  static const BodyNames names;
  return "body " + names.NameOf(body) + " is taken from ERFA's series, " + this->Accuracy(body) +
         "; load a kernel, or install Debian's casacore-data-jpl-de405 (1960 to 2060)";
}

std::optional<StateSource::Link> ErfaSource::Find(int body, double tdb) const {
  if (!(tdb >= SeriesBegin && tdb <= SeriesEnd)) {
    return std::nullopt;
  }
  switch (body) {
  case 10:
    return Link{0, 1, FromBarycenter(tdb, true), 0};
  case 399:
    return Link{0, 1, FromBarycenter(tdb, false), 1};
  case 301:
    return Link{399, 1, MoonFromEarth(tdb), 2};
  case 3: {
    State moon = MoonFromEarth(tdb);
    moon.position *= MoonMassShare;
    moon.velocity *= MoonMassShare;
    return Link{399, 1, moon, 3};
  }
  case 1:
  case 2:
    return Link{10, 1, PlanetFromSun(tdb, body), 3 + body};
  case 4:
  case 5:
  case 6:
  case 7:
  case 8:
    return Link{10, 1, PlanetFromSun(tdb, body), 2 + body};
  case 199:
    return Link{1, 1, {}, 11};
  case 299:
    return Link{2, 1, {}, 12};
  case 499:
    return Link{4, 1, {}, 13};
  default:
    return std::nullopt;
  }
}

} // namespace dspace
