// The error that arises because a degree grid's posts do not stand at its pixels. Not for public
// headers.
#ifndef DSPACE_TERRAIN_RESAMPLINGERROR_H
#define DSPACE_TERRAIN_RESAMPLINGERROR_H

#include <dspace/posts/RasterPosts.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace {

// At pixels near a number of places, so that little is read; each pixel against the triangles
// between the posts of FullLevel() around it.
ResamplingReport MeasureResampling(const RasterPosts& posts);

} // namespace dspace

#endif
