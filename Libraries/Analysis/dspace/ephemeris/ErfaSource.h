// States from ERFA's series, for machines without any other ephemeris.
#ifndef DSPACE_ANALYSIS_ERFA_SOURCE_H
#define DSPACE_ANALYSIS_ERFA_SOURCE_H

#include <string>
#include <vector>

#include <dspace/ephemeris/StateSource.h>

namespace dspace {

// The Sun and the Earth (eraEpv00), the Moon (eraMoon98) and the planets up to Neptune (eraPlan94),
// from 1900 to 2100. Accuracy() states the largest errors, and Warning() repeats them: it is
// meant to be shown wherever these states are used.
// Source: ERFA 2.0 (BSD). Errors of the planets are measured against DE405.
class ErfaSource final : public StateSource {
public:
  ErfaSource();

  const std::string& Name() const override; // "ERFA"
  std::string Accuracy(int body) const override;
  std::string Warning(int body) const override;
  const std::vector<Coverage>& Coverages() const override { return this->Coverages_; }
  std::optional<Link> Find(int body, double tdb) const override;

private:
  std::vector<Coverage> Coverages_;
};

} // namespace dspace

#endif
