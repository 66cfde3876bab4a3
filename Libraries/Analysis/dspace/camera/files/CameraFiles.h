// Files of camera models, of all formats.
#ifndef DSPACE_CAMERA_FILES_CAMERA_FILES_H
#define DSPACE_CAMERA_FILES_CAMERA_FILES_H

#include <string>
#include <vector>

#include <dspace/camera/CameraModel.h>

namespace dspace {

// The models of a file, in its order; at least one. The content decides on the format:
// - JSON: one model, or a list, as CameraJson.h describes
// - JPL's text (.cahv, .cahvor, .cahvore): "C = x y z" and so on
// - PDS3 and VICAR labels: the group or property GEOMETRIC_CAMERA_MODEL
// - OpenCV's and ROS's YAML: camera_matrix, distortion_coefficients
// - mrcal's .cameramodel
// - ISD of the USGS (JSON): radial frame cameras and line scanners
// - SPICE instrument kernels: rectangular fields of view with a number of pixels
// Throws Error: NotFound, Io; Corrupt for a file that is cut short or damaged; Unsupported for
// other files and types of models; InvalidArgument for numbers that are no camera.
std::vector<CameraModel> ReadCameraModels(const std::string& path);

// The model of a name; with an empty name the only one. Throws as above, and NotFound naming the
// models of the file.
CameraModel ReadCameraModel(const std::string& path, const std::string& name = "");

// Writes a model in the format of the name's ending: .json (every model); .cahv, .cahvor, .cahvore
// (that type); .yaml, .yml (pinhole, brown, kannala_brandt, equidistant, without a pose);
// .cameramodel (pinhole, brown without tilt, cahvor and cahvore whose A is the camera's axis).
// Throws Error(Unsupported) naming what the format cannot hold, Error(Io).
void WriteCameraModel(const std::string& path, const CameraModel& model);

} // namespace dspace

#endif
