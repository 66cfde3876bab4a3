// The march over the posts of a block that share what is read.
#ifndef DSPACE_TERRAIN_HORIZONPIECE_H
#define DSPACE_TERRAIN_HORIZONPIECE_H

#include <cstddef>

#include <dspace/horizon/HorizonSweep.h>

namespace dspace {

inline constexpr double HorizonFarthest = 1.5; // [rad] along a body, that horizons are looked for

// HorizonSweep::SweepEvery() for a block of up to HorizonLanes x HorizonRows posts whose rows share
// a path each. `all` and `distant` (null: not wanted) have rows of `stride`. Adds to the report.
void SweepPiece(const HorizonSweep& sweep, const PostBlock& block, int every, double azimuth_deg,
                double seconds, HorizonReport& report, float* all, float* distant,
                std::size_t stride);

} // namespace dspace

#endif
