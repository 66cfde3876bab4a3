// Finds the model of another type that is nearest to a camera's.
#ifndef DSPACE_CAMERA_CONVERT_MODEL_H
#define DSPACE_CAMERA_CONVERT_MODEL_H

#include <string>

#include <dspace/camera/CameraModel.h>

namespace dspace {

struct ConvertedModel {
  CameraModel model;
  // Distances between the pixels of the two models, of the directions of a grid of 41 × 41 pixels.
  double rms = 0.0;        // pixels
  double greatest = 0.0;   // pixels
  double covered = 0.0;    // fraction that was fitted of the grid's pixels with a ray
  double pupilShift = 0.0; // of the source, which the new model lacks [m]
};

// Least squares (Levenberg and Marquardt) over all numbers of the type; name, frame, pose and size
// are those of `from`. Directions count as infinitely far, so that a moving pupil is lost; a
// cahvore is fitted as type 2 without moving pupil. Types that distort a plane are fitted within 80
// degrees of the axis. The same type gives the same model. Throws
// Error(Unsupported) for an unknown type and for orthographic ones, Error(InvalidArgument) for a
// model without a size, or one whose axis lies outside its image's field.
ConvertedModel ConvertModel(const CameraModel& from, const std::string& type);

} // namespace dspace

#endif
