// How much of a disc in the sky stands above the horizon.
#ifndef DSPACE_TERRAIN_LITFRACTION_H
#define DSPACE_TERRAIN_LITFRACTION_H

namespace dspace {

// The part of a disc's area above a straight line, 0 to 1: a circular segment. `above` is how far
// the line passes below the disc's centre (negative: above it) along a vertical, `slope` the rise
// of the line across the disc, `radius` the disc's; all in the same small angle. A radius of 0 is a
// point, which the line itself does not hide.
double LitFraction(double above, double slope, double radius);

} // namespace dspace

#endif
