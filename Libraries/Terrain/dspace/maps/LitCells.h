// Counts how much of the time cells of an illumination map are lit.
#ifndef DSPACE_MAPS_LIT_CELLS_H
#define DSPACE_MAPS_LIT_CELLS_H

#include <cstdint>

namespace dspace {

// How a row of cells sees a body: `above` is how far its centre stands above the cell's horizon
// [rad], `rise` how much the horizon rises to the next azimuth [rad], `secant` what an azimuth is
// narrower by in the sky there. NaN: no data.
struct SeenRow {
  const float* above;
  const float* rise;
  const float* secant;
  int count;
};

// Of each cell: the sum of the parts of the disc that were up, the steps since one was up last, and
// the most of those. Add up to MostLitSteps into `lit`, which are floats.
struct LitCounts {
  float* lit;
  std::uint32_t* night;
  std::uint32_t* longest;
};
constexpr int MostLitSteps = 256;

// Adds a step: LitFraction() of the disc, with a slope of `rise` x `perRise` x `secant`, to 2e-7.
// `radius` [rad] is above 0.
void AddLit(const SeenRow& row, float radius, float perRise, const LitCounts& counts);

// Adds 1 to each cell whose horizon the centre is not below.
void CountAbove(const SeenRow& row, std::uint32_t* counts);

} // namespace dspace

#endif
