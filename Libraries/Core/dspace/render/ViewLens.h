// What a viewport needs to show its camera's view through a lens, in plain numbers.
#ifndef DSPACE_RENDER_VIEW_LENS_H
#define DSPACE_RENDER_VIEW_LENS_H

#include <vector>

#include <dspace/Pose.h>
#include <dspace/scene/Projection.h>

namespace dspace {

// The views that the picture is sampled from, and where its pixels lie in them. Immutable once it
// is given to a viewport.
struct ViewLens {
  struct Source {
    Pose X_CF; // axes F of the view in those of the camera; scale 1
    Projection projection;
    int width = 0; // pixels
    int height = 0;
  };
  // Of a pixel in its source's picture: integers are centres of pixels, (0, 0) the top-left one.
  struct Place {
    float x = 0.0f;
    float y = 0.0f;
    float source = -1.0f;   // its index; below 0: the pixel has no ray, and is black
    float footprint = 1.0f; // source pixels across the pixel
  };

  int width = 0; // of the picture [pixels]
  int height = 0;
  std::vector<Source> sources;
  std::vector<Place> places; // width × height, rows from the top
};

} // namespace dspace

#endif
