// Merges many small changed rectangles into a few.
#ifndef DSPACE_TERRAIN_JOINRECTANGLES_H
#define DSPACE_TERRAIN_JOINRECTANGLES_H

#include <cstddef>
#include <vector>

#include <dspace/posts/PostSource.h>

namespace dspace {

// At most `most` (1 or more) rectangles that hold all of the given ones, and reach as many levels;
// the same where there are no more. Joined are those whose middles lie in one square of posts, of a
// pyramid's tile or as often doubled as is needed. On a plane.
std::vector<PostRectangle> JoinRectangles(const std::vector<PostRectangle>& rectangles,
                                          std::size_t most);

} // namespace dspace

#endif
