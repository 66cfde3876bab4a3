#include <dspace/messages/Convert.h>

#include <cmath>

#include <dspace/Checks.h>
#include <dspace/FrameRules.h>

namespace dspace::session {
namespace {

Light::Kind ToKind(v1::SetLight::Kind kind, const std::string& light) {
  switch (kind) {
  case v1::SetLight::DIRECTIONAL:
    return Light::Kind::Directional;
  case v1::SetLight::POINT:
    return Light::Kind::Point;
  case v1::SetLight::SPOT:
    return Light::Kind::Spot;
  case v1::SetLight::HEAD:
    return Light::Kind::Head;
  case v1::SetLight::AMBIENT:
    return Light::Kind::Ambient;
  default:
    Reject(light, "its kind is " + std::to_string(int(kind)) + "; accepted: 0 to 4");
  }
}

} // namespace

Eigen::Vector3d ToVector(const v1::Vector3& v) {
  return {v.x(), v.y(), v.z()};
}

Eigen::Quaterniond ToRotation(const v1::Quaternion& q, const std::string& object) {
  Pose X;
  X.rotation = Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z());
  if (!IsValidPose(X)) {
    RejectPose(object, X);
  }
  return NormalisedPose(X).rotation;
}

Pose ToPose(const v1::Pose& pose, const std::string& object) {
  Pose X;
  X.position = ToVector(pose.position());
  if (pose.has_rotation()) {
    const v1::Quaternion& q = pose.rotation();
    X.rotation = Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z());
  }
  X.scale = pose.has_scale() ? pose.scale() : 1.0;
  if (!IsValidPose(X)) {
    RejectPose(object, X);
  }
  return NormalisedPose(X);
}

Eigen::Affine3d ToAffine(const v1::Offset& offset, const std::string& object) {
  const Eigen::Vector3d position = ToVector(offset.position());
  const Eigen::Vector3d scale =
      offset.has_scale() ? ToVector(offset.scale()) : Eigen::Vector3d::Ones();
  RequirePosition(object, "the position", position);
  if (!((scale.array().abs() >= MinimumScale) && (scale.array().abs() <= MaximumScale)).all()) {
    Reject(object, "the scale is " + VectorText(scale) +
                       "; accepted: 1e-12 to 1e12, or the negative of it, on each axis");
  }
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  X.linear() = scale.asDiagonal();
  if (offset.has_rotation()) {
    X.linear() = ToRotation(offset.rotation(), object).toRotationMatrix() * X.linear();
  }
  X.translation() = position;
  return X;
}

std::array<double, 3> ToColor(const v1::Color& color, const std::string& object) {
  RequireFraction(object, "the colour's red", color.r());
  RequireFraction(object, "the colour's green", color.g());
  RequireFraction(object, "the colour's blue", color.b());
  return {color.r(), color.g(), color.b()};
}

Light ToLight(const v1::SetLight& from) {
  const std::string label = "light '" + from.name() + "'";
  Light light;
  light.name = from.name();
  light.kind = ToKind(from.kind(), label);
  light.frame = ToFrame(from.frame());
  if (from.has_direction()) {
    light.direction = ToVector(from.direction());
  }
  light.position = ToVector(from.position());
  if (from.has_cone_deg()) {
    light.cone_deg = from.cone_deg();
  }
  if (from.has_color()) {
    light.color = ToColor(from.color(), label);
  }
  if (from.has_intensity()) {
    light.intensity = from.intensity();
  }
  if (from.has_attenuation()) {
    const v1::Vector3& a = from.attenuation();
    light.attenuation = {a.x(), a.y(), a.z()};
  }
  light.enabled = !from.disabled();
  if (from.has_radius_deg()) {
    light.radius_deg = from.radius_deg();
  }
  return light;
}

Nature ToNature(v1::Nature nature, const std::string& object) {
  if (nature != v1::PHYSICAL && nature != v1::ORNAMENTAL) {
    Reject(object, "its nature is " + std::to_string(int(nature)) +
                       "; accepted: PHYSICAL (0), ORNAMENTAL (1)");
  }
  return nature == v1::PHYSICAL ? Nature::Physical : Nature::Ornamental;
}

Eigen::Quaterniond RotationToZUp(v1::UpAxis up, const std::string& object) {
  // Written out rather than computed, so that a quarter turn maps axes to axes exactly.
  const double h = std::sqrt(0.5);
  switch (up) {
  case v1::UP_Z:
    return Eigen::Quaterniond::Identity();
  case v1::UP_Y:
    return {h, h, 0, 0};
  case v1::UP_X:
    return {h, 0, -h, 0};
  case v1::UP_MINUS_Z:
    return {0, 1, 0, 0};
  default:
    Reject(object, "its up axis is " + std::to_string(int(up)) +
                       "; accepted: UP_Z (0), UP_Y (1), UP_X (2), UP_MINUS_Z (3)");
  }
}

Projection ToProjection(const v1::Projection& from) {
  Projection to;
  switch (from.kind_case()) {
  case v1::Projection::kOrthographic:
    to.kind = Projection::Kind::Orthographic;
    to.height = from.orthographic().height();
    break;
  case v1::Projection::kFrustum:
    to.kind = Projection::Kind::Frustum;
    to.left = from.frustum().left();
    to.right = from.frustum().right();
    to.top = from.frustum().top();
    to.bottom = from.frustum().bottom();
    break;
  case v1::Projection::kPerspective:
    to.verticalFov_deg = from.perspective().vertical_fov_deg();
    break;
  case v1::Projection::KIND_NOT_SET:
    break;
  }
  if (from.has_near()) {
    to.nearDistance = from.near();
  }
  if (from.has_far()) {
    to.farDistance = from.far();
  }
  return to;
}

void Put(const Projection& from, v1::Projection* to) {
  switch (from.kind) {
  case Projection::Kind::Perspective:
    to->mutable_perspective()->set_vertical_fov_deg(from.verticalFov_deg);
    break;
  case Projection::Kind::Orthographic:
    to->mutable_orthographic()->set_height(from.height);
    break;
  case Projection::Kind::Frustum:
    to->mutable_frustum()->set_left(from.left);
    to->mutable_frustum()->set_right(from.right);
    to->mutable_frustum()->set_top(from.top);
    to->mutable_frustum()->set_bottom(from.bottom);
    break;
  }
  if (from.nearDistance) {
    to->set_near(*from.nearDistance);
  }
  if (from.farDistance) {
    to->set_far(*from.farDistance);
  }
}

namespace {

v1::Mount::Chase::Axes FromAxes(CameraMount::ChaseAxes axes) {
  switch (axes) {
  case CameraMount::ChaseAxes::Followed:
    return v1::Mount::Chase::FOLLOWED;
  case CameraMount::ChaseAxes::Parent:
    return v1::Mount::Chase::PARENT;
  case CameraMount::ChaseAxes::Heading:
    break;
  }
  return v1::Mount::Chase::HEADING;
}

} // namespace

void Put(const CameraMount& from, v1::Mount* to) {
  to->set_frame(from.frame);
  if (from.kind == CameraMount::Kind::Fixed) {
    Put(from.X_FC, to->mutable_pose());
    return;
  }
  if (from.kind == CameraMount::Kind::Pointing) {
    v1::Mount::Pointing* pointing = to->mutable_pointing();
    Put(from.X_FC.position, pointing->mutable_eye());
    pointing->set_aim(from.aim);
    Put(from.target, pointing->mutable_target());
    Put(from.up, pointing->mutable_up());
    pointing->set_smoothing_s(from.smoothing_s);
    return;
  }
  v1::Mount::Chase* chase = to->mutable_chase();
  chase->set_axes(FromAxes(from.axes));
  Put(from.offset, chase->mutable_offset());
  Put(from.target, chase->mutable_target());
  Put(from.up, chase->mutable_up());
  if (from.vertical != CameraMount::Vertical::Parent) {
    chase->mutable_vertical()->set_frame(from.aim);
    chase->mutable_vertical()->set_axis(from.vertical == CameraMount::Vertical::Axis);
  }
  chase->set_smoothing_s(from.smoothing_s);
}

namespace {

v1::SetLight::Kind FromLightKind(Light::Kind kind) {
  switch (kind) {
  case Light::Kind::Point:
    return v1::SetLight::POINT;
  case Light::Kind::Spot:
    return v1::SetLight::SPOT;
  case Light::Kind::Head:
    return v1::SetLight::HEAD;
  case Light::Kind::Ambient:
    return v1::SetLight::AMBIENT;
  case Light::Kind::Directional:
    break;
  }
  return v1::SetLight::DIRECTIONAL;
}

} // namespace

void Put(const Light& from, v1::SetLight* to) {
  to->set_name(from.name);
  to->set_kind(FromLightKind(from.kind));
  to->set_frame(from.frame);
  Put(from.direction, to->mutable_direction());
  Put(from.position, to->mutable_position());
  to->set_cone_deg(from.cone_deg);
  Put(from.color, to->mutable_color());
  to->set_intensity(from.intensity);
  Put(Eigen::Vector3d(from.attenuation[0], from.attenuation[1], from.attenuation[2]),
      to->mutable_attenuation());
  to->set_disabled(!from.enabled);
  to->set_radius_deg(from.radius_deg);
}

void Put(const Eigen::Vector3d& from, v1::Vector3* to) {
  to->set_x(from.x());
  to->set_y(from.y());
  to->set_z(from.z());
}

void Put(const Pose& from, v1::Pose* to) {
  Put(from.position, to->mutable_position());
  v1::Quaternion* q = to->mutable_rotation();
  q->set_w(from.rotation.w());
  q->set_x(from.rotation.x());
  q->set_y(from.rotation.y());
  q->set_z(from.rotation.z());
  to->set_scale(from.scale);
}

void Put(const std::array<double, 3>& from, v1::Color* to) {
  to->set_r(from[0]);
  to->set_g(from[1]);
  to->set_b(from[2]);
}

void MergeMaterial(const v1::Material& later, v1::Material* material) {
  if (later.has_color()) { // whole: zeros of its channels are values too
    material->clear_color();
  }
  if (later.has_emissive()) {
    material->clear_emissive();
  }
  if (later.has_reflectance()) {
    material->clear_reflectance();
  }
  material->MergeFrom(later);
}

v1::Nature FromNature(Nature nature) {
  return nature == Nature::Physical ? v1::PHYSICAL : v1::ORNAMENTAL;
}

v1::Error::Kind FromKind(Error::Kind kind) {
  switch (kind) {
  case Error::Kind::InvalidArgument:
    return v1::Error::INVALID_ARGUMENT;
  case Error::Kind::NotFound:
    return v1::Error::NOT_FOUND;
  case Error::Kind::AlreadyExists:
    return v1::Error::ALREADY_EXISTS;
  case Error::Kind::Unsupported:
    return v1::Error::UNSUPPORTED;
  case Error::Kind::Corrupt:
    return v1::Error::CORRUPT;
  case Error::Kind::Io:
    return v1::Error::IO;
  case Error::Kind::Resource:
    return v1::Error::RESOURCE;
  case Error::Kind::DeadlineExceeded:
    return v1::Error::DEADLINE_EXCEEDED;
  case Error::Kind::Internal:
    break;
  }
  return v1::Error::INTERNAL;
}

std::size_t RowsOf(int values, int size, const std::string& object, const char* what) {
  if (values % size != 0) {
    Reject(object, std::string(what) + " holds " + std::to_string(values) +
                       " numbers; accepted: a multiple of " + std::to_string(size));
  }
  return std::size_t(values / size);
}

} // namespace dspace::session
