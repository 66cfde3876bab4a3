// A camera with its lens, its size, and its place in the frame that its file speaks of.
#ifndef DSPACE_CAMERA_CAMERA_MODEL_H
#define DSPACE_CAMERA_CAMERA_MODEL_H

#include <string>

#include <Eigen/Geometry>

#include <dspace/camera/LensModel.h>

namespace dspace {

// The axes C of the camera are X right, Y down, Z forward. M is the frame of the model, such as a
// rover's; C and M are one for a model without a pose.
struct CameraModel {
  std::string name;  // may be empty
  std::string frame; // the name of M; may be empty
  int width = 0;     // pixels; 0: the file does not say
  int height = 0;
  LensPtr lens;
  Eigen::Quaterniond q_MC = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_MC = Eigen::Vector3d::Zero(); // [m]

  // "camera 'NAME'", or "camera model".
  std::string Label() const;
  // As the lens does, of a point in M, and with the ray in M.
  bool Project(const Eigen::Vector3d& p_M, Eigen::Vector2d& pixel,
               LensModel::Jacobian* jacobian = nullptr) const;
  bool Unproject(const Eigen::Vector2d& pixel, LensRay& ray_M) const;
  // The model for another size of its image, of the same field of view. Throws
  // Error(InvalidArgument) unless its own size is known and the ratios of the sides agree within
  // half a pixel.
  CameraModel Scaled(int width, int height) const;
};

// What a camera's lens does to its image.
struct LensCheck {
  LensField field;
  // Of the image's pixels, on a grid of at most 129 × 129 with its corners.
  double withoutRay = 0.0;    // the fraction that sees nothing
  double halfAngle_deg = 0.0; // the widest angle between a pixel's ray and the axis
  double density[2] = {0,
                       0}; // least and greatest pixels per degree, of all directions in the image
  double pupilShift = 0.0; // the greatest distance of a ray's origin from C [m]
  double roundTrip = 0.0;  // the greatest distance of a pixel from the projection of its ray
};

// Throws Error(InvalidArgument) where the size is not known.
LensCheck CheckLens(const CameraModel& model);

// JPL's C, A, H, V, O, R, E in M make the camera: Z is along A, and X lies in the plane of A and H.
// `values` has A, H, V, and O, R, E, linearity as the type needs. Throws as MakeLens does.
void PutCahvore(const std::string& type, const Eigen::Vector3d& C, const LensValues& values,
                CameraModel& model, const std::string& label);
// The vectors of a camera of type cahv, cahvor or cahvore in M, with C.
LensValues CahvoreOf(const CameraModel& model);

} // namespace dspace

#endif
