// Camera models as JSON: the one form that holds every model.
#ifndef DSPACE_CAMERA_FILES_CAMERA_JSON_H
#define DSPACE_CAMERA_FILES_CAMERA_JSON_H

#include <string>
#include <vector>

#include <dspace/camera/CameraModel.h>

namespace dspace {

// One object or a list of objects:
//   {"name": "NCAML", "frame": "Body_RSM", "model": {"type": "cahvore", "width": 5120, ...}}
// or the "model" alone. A model of a type cahv, cahvor, cahvore has C, A, H, V, O, R, E in the
// frame, and `linearity` and `pupilType` (1, 2 or 3); the others have the numbers that MakeLens
// takes, and optionally the camera's "position" [m] and "rotation" (w, x, y, z) in the frame. A
// type rejects the pose of the other form.
// Throws Error(Corrupt) naming `label` and the place of the damage, or as MakeLens does.
std::vector<CameraModel> ParseCameraJson(const std::string& text, const std::string& label);

std::string CameraJsonOf(const CameraModel& model);

} // namespace dspace

#endif
