// A part of a viewport's picture.
#ifndef DSPACE_OVERLAY_PICTURE_BOX_H
#define DSPACE_OVERLAY_PICTURE_BOX_H

namespace dspace {

// Pixels: x to the right, y down from the top left corner of the picture.
struct PictureBox {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;
};

} // namespace dspace

#endif
