// Converts wire types to types of the core and back. Absent fields take their documented defaults.
#ifndef DSPACE_SESSION_CONVERT_H
#define DSPACE_SESSION_CONVERT_H

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/Error.h>
#include <dspace/FrameTree.h>
#include <dspace/Pose.h>
#include <dspace/proto/cameras.pb.h>
#include <dspace/proto/common.pb.h>
#include <dspace/proto/objects.pb.h>
#include <dspace/scene/Camera.h>
#include <dspace/scene/GraphicsObject.h>
#include <dspace/scene/Light.h>

namespace dspace::session {

// `object` names the owner of the value in the message of Error(InvalidArgument).
Eigen::Vector3d ToVector(const v1::Vector3& v);
Eigen::Quaterniond ToRotation(const v1::Quaternion& q, const std::string& object); // checked
Pose ToPose(const v1::Pose& pose, const std::string& object);                      // checked
Eigen::Affine3d ToAffine(const v1::Offset& offset, const std::string& object);     // checked
std::array<double, 3> ToColor(const v1::Color& color, const std::string& object);  // checked
Light ToLight(const v1::SetLight& from); // Scene::SetLight checks the rest
Nature ToNature(v1::Nature nature, const std::string& object);
inline FrameId ToFrame(FrameId frame) {
  return frame == NoFrame ? RootFrame : frame;
}
Projection ToProjection(const v1::Projection& from); // not checked: Projection::Check is
// Rotates a file's `up` axis to Z.
Eigen::Quaterniond RotationToZUp(v1::UpAxis up, const std::string& object);

void Put(const Eigen::Vector3d& from, v1::Vector3* to);
void Put(const Pose& from, v1::Pose* to);
void Put(const std::array<double, 3>& from, v1::Color* to);
void Put(const Projection& from, v1::Projection* to);
void Put(const CameraMount& from, v1::Mount* to);
void Put(const Light& from, v1::SetLight* to);
v1::Nature FromNature(Nature nature);
// Overrides the material with the later one, field by field.
void MergeMaterial(const v1::Material& later, v1::Material* material);
v1::Error::Kind FromKind(Error::Kind kind);

// The number of rows of `size` values; throws Error(InvalidArgument) if `values` is not a multiple
// of `size`.
std::size_t RowsOf(int values, int size, const std::string& object, const char* what);

// The value as an int, limited to the largest int. Range checks then reject it.
inline int ToInt(std::uint32_t value) {
  return int(std::min<std::uint32_t>(value, 0x7fffffffu));
}

} // namespace dspace::session

#endif
