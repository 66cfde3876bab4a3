// The camera with its lens that a request names.
#ifndef DSPACE_SESSION_PLACED_LENS_H
#define DSPACE_SESSION_PLACED_LENS_H

#include <string>

#include <dspace/camera/CameraModel.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/proto/lenses.pb.h>
#include <dspace/scene/Camera.h>

namespace dspace::session {

// The lens, for a size that is known, and the pose of the camera's axes.
struct PlacedLens {
  dspace::CameraModel model;
  CameraPose camera; // X_FC, scale 1
};

// The one model that JSON holds. Throws Error: Corrupt, Unsupported or InvalidArgument.
dspace::CameraModel ParseModel(const std::string& json);

// Throws Error: NotFound for a vantage, camera or frame; Corrupt, Unsupported or InvalidArgument
// for the model; InvalidArgument for a size that is missing or is not the model's.
PlacedLens PlaceLens(const Context& context, const v1::CameraModel& from);

} // namespace dspace::session

#endif
