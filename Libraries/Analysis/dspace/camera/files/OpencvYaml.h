// OpenCV's and ROS's calibration files.
#ifndef DSPACE_CAMERA_FILES_OPENCV_YAML_H
#define DSPACE_CAMERA_FILES_OPENCV_YAML_H

#include <string>

#include <dspace/camera/CameraModel.h>

namespace dspace {

// camera_matrix and distortion_coefficients, as matrices with `data: [...]` or as lists;
// image_width and image_height where they are. distortion_model: plumb_bob, rational_polynomial
// (the default), equidistant or fisheye. A rotation and translation are not read. Throws
// Error(Corrupt, Unsupported), or as MakeLens does.
CameraModel ParseOpencvYaml(const std::string& text, const std::string& label);
bool IsOpencvYaml(const std::string& text); // whether it has a camera_matrix
std::string OpencvYamlOf(const CameraModel& model);

} // namespace dspace

#endif
