// Shapes across the edge of a map that goes once around a body, and around its poles. Not for
// public headers.
#ifndef DSPACE_LAYERS_VECTORTURNS_H
#define DSPACE_LAYERS_VECTORTURNS_H

#include <array>
#include <vector>

#include <dspace/layers/vector/VectorShapes.h>

namespace dspace {

// Vertices one after the other across the edge of a map that is `turn` wide, the shorter way: each
// is moved by whole turns. `frames`: one that is a whole turn away stays, as in a map's frame.
void Unwrap(std::vector<Eigen::Vector2d>& places, double turn, bool frames);

// By whole turns to where it is nearest to another ring: a hole to the ring that it is in.
void BesideOf(const std::vector<Eigen::Vector2d>& other, double turn,
              std::vector<Eigen::Vector2d>& places);

// Of a closed ring that has been unwrapped and yet ends a turn away from where it began: it goes
// around a pole, and is closed along the nearer of the two, whose `y` is given.
void CloseOverPole(VectorRing& ring, double turn, const std::array<double, 2>& poles);

} // namespace dspace

#endif
