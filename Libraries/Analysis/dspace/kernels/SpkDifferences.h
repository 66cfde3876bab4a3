// SPK types 1 and 21: modified difference arrays.
#ifndef DSPACE_ANALYSIS_SPK_DIFFERENCES_H
#define DSPACE_ANALYSIS_SPK_DIFFERENCES_H

#include <cstdint>

#include <dspace/kernels/SpkArray.h>

namespace dspace {

// Records of the numerical integrator of JPL's orbit determination: from a reference state, the
// divided differences of the acceleration. Type 1 has up to 15 of them, type 21 as many as it
// states.
//
// Source: NAIF's "SPK Required Reading", and F. T. Krogh, "Changing stepsize in the integration of
// differential equations using modified divided differences" (1974), whose method it names.
class SpkDifferences final : public SpkArray {
public:
  SpkDifferences(const DafFile& file, const DafFile::Array& array, int type);
  State At(double tdb) const override;

private:
  const DafFile& File_;
  const DafFile::Array& Array_;
  std::int64_t Differences_ = 15; // the most of a record
  std::int64_t RecordWords_ = 71;
  std::int64_t Records_ = 0;
};

} // namespace dspace

#endif
