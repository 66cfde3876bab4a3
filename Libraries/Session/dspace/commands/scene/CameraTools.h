// Functions that the commands on cameras share.
#ifndef DSPACE_SESSION_CAMERA_TOOLS_H
#define DSPACE_SESSION_CAMERA_TOOLS_H

#include <string>
#include <utility>

#include <dspace/proto/cameras.pb.h>
#include <dspace/scene/Scene.h>

namespace dspace::session {

// An empty name is the active camera. Throws Error(NotFound).
void DescribeCamera(const std::string& sceneName, const Scene& scene, const std::string& vantage,
                    const std::string& name, v1::CameraInfo* info);
// X_GC of a camera now, in the frame G, with its lag; scale 1. An empty name is the active camera.
// Throws Error(NotFound).
Pose CameraPoseIn(const Scene& scene, const std::string& vantage, const std::string& camera,
                  FrameId frame);
void PutLag(const std::pair<std::string, std::string>& camera, const ChaseState& from,
            v1::CameraLag* to);

} // namespace dspace::session

#endif
