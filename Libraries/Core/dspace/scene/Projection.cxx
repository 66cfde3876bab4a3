#include <dspace/scene/Projection.h>

#include <cmath>

#include <dspace/FrameRules.h>
#include <dspace/scene/Checks.h>

namespace dspace {

namespace {

constexpr double RadiansPerDegree = 3.14159265358979323846 / 180.0;
constexpr double Smallest = 1e-9; // metres, or a tangent
constexpr double SmallestFov_deg = 1e-6;
constexpr double LargestTangent = 1e6;

void CheckSize(int width, int height) {
  if (width < 1 || height < 1) {
    Reject("image", "its size is " + std::to_string(width) + " x " + std::to_string(height) +
                        "; accepted: 1 x 1 and more");
  }
}

// What the image's borders see, before the division by depth where there is one.
struct Extent {
  double left, right, top, bottom;
};

Extent ExtentOf(const Projection& p, int width, int height) {
  CheckSize(width, height);
  if (p.kind == Projection::Kind::Frustum) {
    return {p.left, p.right, p.top, p.bottom};
  }
  const double y = p.kind == Projection::Kind::Perspective
                       ? std::tan(0.5 * p.verticalFov_deg * RadiansPerDegree)
                       : 0.5 * p.height;
  const double x = y * width / height;
  return {-x, x, -y, y};
}

// depth buffer = scale / Z + offset (perspective kinds): 1 at near, 0 at far.
struct DepthMap {
  double scale, offset;
};

DepthMap DepthOf(const Projection& p) {
  if (std::isinf(p.farDistance)) {
    return {p.nearDistance, 0.0};
  }
  const double ratio = p.nearDistance / (p.farDistance - p.nearDistance);
  return {ratio * p.farDistance, -ratio};
}

} // namespace

void Projection::Check(const std::string& camera) const {
  const std::string object = "camera '" + camera + "'";
  const bool orthographic = this->kind == Kind::Orthographic;
  if (this->kind == Kind::Perspective) {
    Require(this->verticalFov_deg >= SmallestFov_deg &&
                this->verticalFov_deg <= 180.0 - SmallestFov_deg,
            object, "vertical fov", this->verticalFov_deg, "1e-6 to 180 - 1e-6 degrees");
  } else if (orthographic) {
    Require(this->height >= Smallest && this->height <= MaximumCoordinate, object, "height",
            this->height, "1e-9 to 1e18 metres");
  } else {
    const auto tangent = [&object](const char* side, double value) {
      Require(std::abs(value) <= LargestTangent, object, side, value, "-1e6 to 1e6");
    };
    tangent("left", this->left);
    tangent("right", this->right);
    tangent("top", this->top);
    tangent("bottom", this->bottom);
    Require(this->right - this->left >= Smallest, object, "left", this->left,
            ("less than right (" + NumberText(this->right) + ") by 1e-9 and more").c_str());
    Require(this->bottom - this->top >= Smallest, object, "top", this->top,
            ("less than bottom (" + NumberText(this->bottom) + ") by 1e-9 and more").c_str());
  }
  Require(this->nearDistance >= (orthographic ? -MaximumCoordinate : Smallest) &&
              this->nearDistance <= MaximumCoordinate,
          object, "near distance", this->nearDistance,
          orthographic ? "-1e18 to 1e18 metres" : "1e-9 to 1e18 metres");
  Require(this->farDistance > this->nearDistance, object, "far distance", this->farDistance,
          ("more than near (" + NumberText(this->nearDistance) + ")").c_str());
  if (orthographic) {
    Require(this->farDistance - this->nearDistance >= Smallest &&
                this->farDistance <= MaximumCoordinate,
            object, "far distance", this->farDistance,
            "1e-9 metres and more beyond near, up to 1e18 metres, for an orthographic camera");
  } else {
    Require(this->farDistance <= MaximumCoordinate || std::isinf(this->farDistance), object,
            "far distance", this->farDistance, "up to 1e18 metres, or infinite");
  }
}

Eigen::Matrix4d Projection::ClipFromView(int width, int height) const {
  const Extent e = ExtentOf(*this, width, height);
  const double w = e.right - e.left;
  const double h = e.bottom - e.top;
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = 2.0 / w;
  m(1, 1) = 2.0 / h;
  if (this->kind == Kind::Orthographic) {
    const double range = this->farDistance - this->nearDistance;
    m(2, 2) = 1.0 / range;
    m(2, 3) = this->farDistance / range;
    m(3, 3) = 1.0;
    return m;
  }
  m(0, 2) = (e.right + e.left) / w;
  m(1, 2) = -(e.bottom + e.top) / h; // view Y is up, top and bottom are tangents along Y down
  const DepthMap depth = DepthOf(*this);
  m(2, 2) = -depth.offset;
  m(2, 3) = depth.scale;
  m(3, 2) = -1.0;
  return m;
}

Projection::PixelPoint Projection::Project(const Eigen::Vector3d& p_C, int width,
                                           int height) const {
  const Extent e = ExtentOf(*this, width, height);
  const double depth = p_C.z();
  double x = p_C.x();
  double y = p_C.y();
  if (this->kind != Kind::Orthographic) {
    if (!(depth > 0.0)) {
      const double none = std::numeric_limits<double>::quiet_NaN();
      return {none, none, depth, false};
    }
    x /= depth;
    y /= depth;
  }
  return {(x - e.left) / (e.right - e.left) * width - 0.5,
          (y - e.top) / (e.bottom - e.top) * height - 0.5, depth, true};
}

Projection::Ray Projection::PixelRay(double x, double y, int width, int height) const {
  const Extent e = ExtentOf(*this, width, height);
  const double u = e.left + (x + 0.5) / width * (e.right - e.left);
  const double v = e.top + (y + 0.5) / height * (e.bottom - e.top);
  if (this->kind == Kind::Orthographic) {
    return {{u, v, 0.0}, Eigen::Vector3d::UnitZ()};
  }
  return {Eigen::Vector3d::Zero(), Eigen::Vector3d(u, v, 1.0).normalized()};
}

double Projection::DepthFromBuffer(double value) const {
  if (value <= 0.0) {
    return std::numeric_limits<double>::infinity();
  }
  if (this->kind == Kind::Orthographic) {
    return this->farDistance - value * (this->farDistance - this->nearDistance);
  }
  const DepthMap depth = DepthOf(*this);
  return depth.scale / (value - depth.offset);
}

double Projection::MetresPerPixel(double depth, int height) const {
  const Extent e = ExtentOf(*this, 1, 1); // vertical extent: the aspect does not matter
  CheckSize(1, height);
  const double metres = (e.bottom - e.top) / height;
  return this->kind == Kind::Orthographic ? metres : metres * depth;
}

} // namespace dspace
