// Where an image stands in a picture of another shape.
#ifndef DSPACE_CAMERA_FITTED_IMAGE_H
#define DSPACE_CAMERA_FITTED_IMAGE_H

namespace dspace {

// The pixels of the picture that an image takes: as large as the picture holds it whole, to a
// pixel, in its middle.
struct FittedImage {
  int x = 0; // of its first column
  int y = 0; // of its first row
  int width = 0;
  int height = 0;
};

// All sizes in pixels, 1 or more.
FittedImage FitImage(int imageWidth, int imageHeight, int width, int height);

} // namespace dspace

#endif
