// Posts between those of a coarser level, on its triangles. Not for public headers.
#ifndef DSPACE_TERRAIN_POSTSBETWEEN_H
#define DSPACE_TERRAIN_POSTSBETWEEN_H

#include <functional>

#include <dspace/posts/PostSource.h>

namespace dspace {

// Height at (u, v) of a cell whose corners are a (0, 0), b (1, 0), c (0, 1), d (1, 1): triangles A
// (below the diagonal a-d) and B, as in HeightGrid.
double OnTriangles(double a, double b, double c, double d, double u, double v);

// Reads a block of a level finer than `full`; `read` gives the posts of `full`. With `poles` the
// first and the last row of the lattice are a pole each: from there the surface is ruled to the
// next row.
void ReadBetweenPosts(const PostLattice& lattice, bool poles, int full,
                      const std::function<void(const PostBlock&, float*)>& read,
                      const PostBlock& block, float* heights);

} // namespace dspace

#endif
