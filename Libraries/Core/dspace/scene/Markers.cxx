#include <dspace/scene/Markers.h>

#include <algorithm>

#include <dspace/scene/MeshBuilder.h>
#include <dspace/scene/Primitives.h>

namespace dspace {

namespace {

using Color = std::array<double, 3>;

std::shared_ptr<const Material> Unlit(const Color& color, double opacity = 1.0) {
  auto material = std::make_shared<Material>();
  material->color = color;
  material->opacity = opacity;
  material->lit = false;
  return material;
}

Part MakePart(Mesh mesh, std::shared_ptr<const Material> material,
              const Eigen::Affine3d& X_OP = Eigen::Affine3d::Identity()) {
  return {std::make_shared<const Mesh>(std::move(mesh)), std::move(material), X_OP};
}

// Turns +X to `axis` (0 X, 1 Y, 2 Z) by cycling the axes.
Eigen::Affine3d AlongAxis(int axis) {
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  for (int i = 0; i < 3; ++i) {
    X.linear().col(i) = Eigen::Vector3d::Unit((i + axis) % 3);
  }
  return X;
}

Color Mix(const Color& a, const Color& b, double share) {
  Color mixed;
  for (std::size_t i = 0; i < 3; ++i) {
    mixed[i] = (1.0 - share) * a[i] + share * b[i];
  }
  return mixed;
}

} // namespace

std::vector<Part> MakeAxes(double length) {
  RequireLength("axes", "length", length);
  const Color colors[] = {{0.9, 0.1, 0.1}, {0.1, 0.75, 0.1}, {0.15, 0.3, 1.0}};
  const auto arrow = std::make_shared<const Mesh>(MakeArrow(length));
  std::vector<Part> parts;
  parts.reserve(3);
  for (int axis = 0; axis < 3; ++axis) {
    parts.push_back({arrow, Unlit(colors[axis]), AlongAxis(axis)});
  }
  return parts;
}

std::vector<Part> MakeFrustumPyramid(const Projection& projection, double length, int width,
                                     int height) {
  projection.Check("frustum pyramid");
  RequireLength("frustum pyramid", "length", length);
  const double right = width - 0.5;
  const double bottom = height - 0.5;
  const double pixels[4][2] = {{-0.5, -0.5}, {right, -0.5}, {right, bottom}, {-0.5, bottom}};
  std::vector<Eigen::Vector3d> start; // clockwise seen along Z, from the top left
  std::vector<Eigen::Vector3d> end;
  for (const auto& pixel : pixels) {
    const Projection::Ray ray = projection.PixelRay(pixel[0], pixel[1], width, height);
    start.push_back(ray.origin);
    end.push_back(ray.origin + ray.direction * (length / ray.direction.z()));
    RequireFinite("frustum pyramid", "a corner", end.back());
  }
  const bool pointed = projection.kind != Projection::Kind::Orthographic;

  std::vector<Eigen::Vector3d> points = end;
  points.insert(points.end(), start.begin(), pointed ? start.begin() + 1 : start.end());
  Mesh lines = MakeLineSet(points);
  lines.name = "frustum edges";
  lines.indices.clear();
  for (std::uint32_t k = 0; k < 4; ++k) {
    lines.indices.insert(lines.indices.end(), {k, (k + 1) % 4, pointed ? 4 : 4 + k, k});
    if (!pointed) {
      lines.indices.insert(lines.indices.end(), {4 + k, 4 + (k + 1) % 4});
    }
  }

  MeshBuilder faces("frustum faces");
  faces.Face(end);
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    if (pointed) {
      faces.Face({start[k], end[next], end[k]});
    } else {
      faces.Face({start[k], start[next], end[next], end[k]});
    }
  }
  if (!pointed) {
    faces.Face({start[3], start[2], start[1], start[0]});
  }
  const Color color = {1.0, 0.85, 0.2};
  return {MakePart(std::move(lines), Unlit(color)), MakePart(faces.Take(), Unlit(color, 0.15))};
}

std::vector<Part> MakeGoalMarker(double height) {
  RequireLength("goal marker", "height", height);
  const double h = height;
  MeshBuilder flag("flag");
  flag.Face({{0, 0, 0.7 * h}, {0.45 * h, 0, 0.85 * h}, {0, 0, h}});
  Eigen::Affine3d X_OPole = Eigen::Affine3d::Identity();
  X_OPole.translation().z() = 0.5 * h;
  return {MakePart(MakeCylinder(0.02 * h, h, 12), Unlit({0.9, 0.9, 0.9}), X_OPole),
          MakePart(flag.Take(), Unlit({0.95, 0.3, 0.1})),
          MakePart(MakeTorus(0.35 * h, 0.02 * h, 48), Unlit({0.95, 0.3, 0.1}))};
}

std::vector<Part> MakeTiltMarker(double radius) {
  RequireLength("tilt marker", "radius", radius);
  const auto white = Unlit({1, 1, 1});
  Mesh cross = MakeLineSet({{-radius, 0, 0}, {radius, 0, 0}, {0, -radius, 0}, {0, radius, 0}});
  cross.name = "diameters";
  cross.indices = {0, 1, 2, 3};
  return {MakePart(MakeTorus(radius, 0.05 * radius, 48), white), MakePart(std::move(cross), white),
          MakePart(MakeArrow(radius), white, AlongAxis(2))};
}

std::array<double, 3> TiltColor(double tilt_deg, double warn_deg, double limit_deg) {
  const std::string object = "tilt marker";
  Require(tilt_deg >= 0.0 && tilt_deg <= 180.0, object, "tilt", tilt_deg, "0 to 180 degrees");
  Require(limit_deg > 0.0 && limit_deg <= 180.0, object, "limit", limit_deg,
          "more than 0, to 180 degrees");
  Require(warn_deg > 0.0 && warn_deg < limit_deg, object, "warning", warn_deg,
          ("more than 0, less than the limit of " + NumberText(limit_deg)).c_str());
  const Color green = {0.1, 0.75, 0.2};
  const Color yellow = {0.95, 0.85, 0.1};
  const Color red = {0.9, 0.1, 0.1};
  return tilt_deg < warn_deg
             ? Mix(green, yellow, tilt_deg / warn_deg)
             : Mix(yellow, red, std::min(1.0, (tilt_deg - warn_deg) / (limit_deg - warn_deg)));
}

} // namespace dspace
