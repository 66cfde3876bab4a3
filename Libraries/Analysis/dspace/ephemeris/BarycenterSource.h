// Planets at the barycentres of their systems.
#ifndef DSPACE_ANALYSIS_BARYCENTER_SOURCE_H
#define DSPACE_ANALYSIS_BARYCENTER_SOURCE_H

#include <dspace/ephemeris/StateSource.h>

namespace dspace {

// Jupiter, Saturn, Uranus, Neptune and Pluto at the barycentres of their systems, for ephemerides
// that have no kernel of their satellites. A planet is off by the sum over its moons of mass ratio
// times distance. Masses: gm_de440.tpc; distances: JPL's satellite mean elements. Each state has a
// warning that gives the largest distance of the planet.
class BarycenterSource final : public StateSource {
public:
  BarycenterSource();

  const std::string& Name() const override; // "barycentre of its system"
  std::string Accuracy(int body) const override;
  std::string Warning(int body) const override;
  const std::vector<Coverage>& Coverages() const override { return this->Coverages_; }
  std::optional<Link> Find(int body, double tdb) const override;

private:
  std::vector<Coverage> Coverages_; // the years -9999 to 9999
};

} // namespace dspace

#endif
