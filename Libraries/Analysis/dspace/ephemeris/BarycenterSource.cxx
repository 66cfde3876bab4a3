#include <dspace/ephemeris/BarycenterSource.h>

#include <array>

namespace dspace {
namespace {

struct OuterPlanet {
  int body;
  const char* name;
  const char* moons;
  // Largest distance from the barycentre [km]: the sum of a (1 + e) GM / GM of the system.
  const char* distance_km;
};

// Jupiter: Ganymede 84, Callisto 107, Io 20, Europa 17. Saturn: Titan 297, Iapetus 11, others 4.
// Uranus: Oberon 21, Titania 17, others 7. Neptune: Triton 74. Pluto: Charon 2,129.
constexpr std::array<OuterPlanet, 5> OuterPlanets = {{{599, "JUPITER", "Jupiter's moons", "230"},
                                                      {699, "SATURN", "Saturn's moons", "320"},
                                                      {799, "URANUS", "Uranus's moons", "50"},
                                                      {899, "NEPTUNE", "Triton", "80"},
                                                      {999, "PLUTO", "Charon", "2,200"}}};
constexpr double CoverBegin = -378677160000.0; // TDB [s past J2000]
constexpr double CoverEnd = 252455616000.0;

const OuterPlanet* PlanetOf(int body) {
  for (const OuterPlanet& planet : OuterPlanets) {
    if (planet.body == body) {
      return &planet;
    }
  }
  return nullptr;
}

} // namespace

BarycenterSource::BarycenterSource() {
  for (const OuterPlanet& planet : OuterPlanets) {
    this->Coverages_.push_back({planet.body, planet.body / 100, 1, CoverBegin, CoverEnd, {}});
  }
}

const std::string& BarycenterSource::Name() const {
  static const std::string name = "barycentre of its system";
  return name;
}

std::string BarycenterSource::Accuracy(int body) const {
  const OuterPlanet* planet = PlanetOf(body);
  return planet ? "up to " + std::string(planet->distance_km) + " km off" : std::string();
}

std::string BarycenterSource::Warning(int body) const {
  const OuterPlanet* planet = PlanetOf(body);
  return planet ? "body " + std::string(planet->name) + " is taken at the " + this->Name() + ", " +
                      this->Accuracy(body) + "; load an SPK with " + planet->moons
                : std::string();
}

std::optional<StateSource::Link> BarycenterSource::Find(int body, double tdb) const {
  for (std::size_t i = 0; i < OuterPlanets.size(); ++i) {
    if (OuterPlanets[i].body == body && tdb >= CoverBegin && tdb <= CoverEnd) {
      return Link{body / 100, 1, {}, int(i)};
    }
  }
  return std::nullopt;
}

} // namespace dspace
