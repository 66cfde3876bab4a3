#include <dspace/commands/objects/PrimitiveParts.h>

#include <algorithm>
#include <memory>

#include <dspace/Checks.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/Markers.h>
#include <dspace/scene/Primitives.h>

namespace dspace::session {
namespace {

constexpr std::uint32_t DefaultResolution = 32;

// The resolution of a message; values beyond the range of int become the largest int, which is
// rejected.
template<class Shape> int ResolutionOf(const Shape& shape) {
  const std::uint32_t value = shape.has_resolution() ? shape.resolution() : DefaultResolution;
  return int(std::min<std::uint32_t>(value, 1u << 30));
}

std::vector<Eigen::Vector3d> ToPoints(const google::protobuf::RepeatedField<double>& values,
                                      const std::string& shape) {
  const std::size_t n = RowsOf(values.size(), 3, shape, "point");
  std::vector<Eigen::Vector3d> points(n);
  for (std::size_t i = 0; i < n; ++i) {
    points[i] = Eigen::Vector3d(values.data() + 3 * i);
  }
  return points;
}

std::vector<Part> LineParts(const v1::CreatePrimitive::Lines& lines) {
  const std::vector<Eigen::Vector3d> points = ToPoints(lines.point(), "line set");
  if (lines.count_size() == 0) {
    return {PartOf(MakeLineSet(points, lines.closed()))};
  }
  std::vector<Part> parts;
  std::size_t begin = 0;
  for (const std::uint32_t count : lines.count()) {
    if (count > points.size() - begin) {
      Reject("line set",
             "count needs more points than the " + std::to_string(points.size()) + " in point");
    }
    parts.push_back(PartOf(MakeLineSet(
        {points.begin() + std::ptrdiff_t(begin), points.begin() + std::ptrdiff_t(begin + count)},
        lines.closed())));
    begin += count;
  }
  if (begin != points.size()) {
    Reject("line set", "count uses " + std::to_string(begin) + " of " +
                           std::to_string(points.size()) + " points; accepted: all of them");
  }
  return parts;
}

std::vector<Part> FrustumParts(const v1::CreatePrimitive::Frustum& frustum) {
  const auto side = [](std::uint32_t pixels) { return int(std::min(pixels, 1u << 30)); };
  return MakeFrustumPyramid(ToProjection(frustum.projection()), frustum.length(),
                            side(frustum.width()), side(frustum.height()));
}

} // namespace

Part PartOf(Mesh mesh) {
  return {std::make_shared<const Mesh>(std::move(mesh)), nullptr};
}

std::string ShapeName(const v1::CreatePrimitive& command) {
  const auto* field = v1::CreatePrimitive::descriptor()->FindFieldByNumber(command.shape_case());
  return field ? field->name() : "primitive";
}

std::vector<Part> PartsOfShape(const v1::CreatePrimitive& command) {
  using Shape = v1::CreatePrimitive;
  switch (command.shape_case()) {
  case Shape::kBox:
    return {PartOf(MakeBox(ToVector(command.box().size())))};
  case Shape::kSphere:
    return {PartOf(MakeSphere(command.sphere().radius(), ResolutionOf(command.sphere())))};
  case Shape::kCylinder:
    return {PartOf(MakeCylinder(command.cylinder().radius(), command.cylinder().height(),
                                ResolutionOf(command.cylinder())))};
  case Shape::kCone:
    return {PartOf(
        MakeCone(command.cone().radius(), command.cone().height(), ResolutionOf(command.cone())))};
  case Shape::kPlane:
    return {PartOf(MakePlane(command.plane().width(), command.plane().height()))};
  case Shape::kDisc:
    return {PartOf(MakeDisc(command.disc().radius(), ResolutionOf(command.disc())))};
  case Shape::kTorus:
    return {PartOf(MakeTorus(command.torus().radius(), command.torus().tube(),
                             ResolutionOf(command.torus())))};
  case Shape::kArrow:
    return {PartOf(MakeArrow(command.arrow().length()))};
  case Shape::kAxes:
    return MakeAxes(command.axes().length());
  case Shape::kLines:
    return LineParts(command.lines());
  case Shape::kPoints:
    return {PartOf(MakePointSet(ToPoints(command.points().point(), "point set")))};
  case Shape::kFrustum:
    return FrustumParts(command.frustum());
  case Shape::kGoal:
    return MakeGoalMarker(command.goal().height());
  case Shape::kTilt:
    return MakeTiltMarker(command.tilt().radius());
  case Shape::SHAPE_NOT_SET:
    break;
  }
  Reject("primitive", "its shape is missing or unknown; accepted: box, sphere, cylinder, cone, "
                      "plane, disc, torus, arrow, axes, lines, points, frustum, goal, tilt");
}

} // namespace dspace::session
