// Two discs, one before the other.
#ifndef DSPACE_DISC_LEFT_H
#define DSPACE_DISC_LEFT_H

namespace dspace {

// The part of a disc of radius `a` that a disc of radius `b` leaves, at a distance `d` of the
// centres; all in the same unit. 0 to 1.
double DiscLeft(double a, double b, double d);

} // namespace dspace

#endif
