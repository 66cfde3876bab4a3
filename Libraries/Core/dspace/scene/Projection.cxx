#include <dspace/scene/Projection.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Checks.h>
#include <dspace/FrameRules.h>

namespace dspace {

namespace {

constexpr double RadiansPerDegree = 3.14159265358979323846 / 180.0;
constexpr double Smallest = 1e-9; // metres, or a tangent
constexpr double SmallestFov_deg = 1e-6;
constexpr double LargestTangent = 1e6;
constexpr double StandardNear = 0.05;
constexpr double StandardOrthographicFar = 1e4;

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
  const double near = p.Near();
  const double far = p.Far();
  if (std::isinf(far)) {
    return {near, 0.0};
  }
  const double ratio = near / (far - near);
  return {ratio * far, -ratio};
}

} // namespace

double Projection::Near() const {
  return this->nearDistance.value_or(StandardNear);
}

double Projection::Far() const {
  return this->farDistance.value_or(this->kind == Kind::Orthographic
                                        ? StandardOrthographicFar
                                        : std::numeric_limits<double>::infinity());
}

Projection Projection::Seeing(double nearest, double farthest) const {
  Projection set = *this;
  const bool nothing = !(nearest <= farthest);
  if (this->kind != Kind::Orthographic) {
    // Reversed float depth resolves the same fraction of the distance for any near distance.
    const double ahead = nothing || nearest <= 0.0 ? StandardNear : 0.9 * nearest;
    set.nearDistance = this->nearDistance.value_or(std::clamp(ahead, Smallest, StandardNear));
    set.farDistance = this->Far();
    return set;
  }
  if (nothing) {
    set.nearDistance = this->nearDistance.value_or(std::min(StandardNear, this->Far() - 1.0));
    set.farDistance = this->farDistance.value_or(std::max(this->Far(), *set.nearDistance + 1.0));
    return set;
  }
  // Beyond what single precision rounds.
  const double spare =
      1e-3 * (farthest - nearest) + 1e-6 * std::max(std::abs(nearest), std::abs(farthest)) + 1e-6;
  if (!this->nearDistance) {
    set.nearDistance = std::max(0.0, nearest - spare);
    if (this->farDistance && *set.nearDistance >= *this->farDistance) {
      set.nearDistance = *this->farDistance - spare; // all of it lies beyond far
    }
  }
  if (!this->farDistance) {
    set.farDistance = std::max(farthest, *set.nearDistance) + spare;
  }
  return set;
}

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
  const double near = this->Near();
  Require(near >= (orthographic ? -MaximumCoordinate : Smallest) && near <= MaximumCoordinate,
          object, "near distance", near,
          orthographic ? "-1e18 to 1e18 metres" : "1e-9 to 1e18 metres");
  if (!this->farDistance) {
    return;
  }
  const double far = *this->farDistance;
  Require(far > near, object, "far distance", far,
          ("more than near (" + NumberText(near) + ")").c_str());
  if (orthographic) {
    Require(far - near >= Smallest && far <= MaximumCoordinate, object, "far distance", far,
            "1e-9 metres and more beyond near, up to 1e18 metres, for an orthographic camera");
  } else {
    Require(far <= MaximumCoordinate || std::isinf(far), object, "far distance", far,
            "up to 1e18 metres, or infinite");
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
    const double range = this->Far() - this->Near();
    m(2, 2) = 1.0 / range;
    m(2, 3) = this->Far() / range;
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
    return this->Far() - value * (this->Far() - this->Near());
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
