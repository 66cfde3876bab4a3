// The shaded relief of a terrain, coloured by height.
#ifndef DSPACE_TERRAIN_SHADEDRELIEF_H
#define DSPACE_TERRAIN_SHADEDRELIEF_H

#include <array>
#include <cstdint>
#include <optional>

#include <dspace/layers/ColorRamp.h>
#include <dspace/mesh/DrapeImage.h>

namespace dspace {

struct ShadedReliefOptions {
  double sunAzimuth_deg = 315.0;  // clockwise from the scene's north
  double sunElevation_deg = 45.0; // 0 to 90
  double ambient = 0.25;          // 0 to 1: brightness of what faces away
  double exaggeration = 1.0;      // of heights, for shading only; greater than 0
  ColorRamp ramp = {{0.85, 0.83, 0.8}};
  std::optional<double> rampLow; // [m]; the terrain's least height by default
  std::optional<double> rampHigh;
  std::array<std::uint8_t, 3> holeColor = {90, 90, 90};
  int maximumSize = 4096; // pixels along the longer side; at most one per post
};

// Shades the ramp's colour by Lambert's law with the normals of the posts. Throws
// Error(InvalidArgument) for an option out of range.
DrapeImage ShadedRelief(const GridTerrain& terrain, const ShadedReliefOptions& options = {});

} // namespace dspace

#endif
