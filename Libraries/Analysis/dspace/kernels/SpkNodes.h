// SPK types 8, 9 and 13: states at times, between which polynomials interpolate.
#ifndef DSPACE_ANALYSIS_SPK_NODES_H
#define DSPACE_ANALYSIS_SPK_NODES_H

#include <cstdint>

#include <dspace/kernels/SpkArray.h>

namespace dspace {

// Lagrange polynomials of position and of velocity through states at equal (8) or any (9) steps,
// or Hermite polynomials of the position through positions and velocities (13). The window is the
// one that SPICE takes: centred on the interval for an even number of states, on the nearest state
// for an odd number, and moved inwards at the segment's ends.
//
// Source: NAIF, "SPK Required Reading".
class SpkNodes final : public SpkArray {
public:
  SpkNodes(const DafFile& file, const DafFile::Array& array, int type);
  State At(double tdb) const override;

private:
  const DafFile& File_;
  const DafFile::Array& Array_;
  int Type_;
  std::int64_t States_ = 0;
  std::int64_t Window_ = 0; // states
  double Begin_ = 0.0;      // type 8
  double Step_ = 0.0;
};

} // namespace dspace

#endif
