#include <dspace/import/model/Polygon.h>

#include <Eigen/Geometry>

#include <cmath>

namespace dspace {

namespace {

constexpr int MaximumEarCorners = 4096;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// Corners seen along the normal, so that they run counter-clockwise.
std::vector<Eigen::Vector2d> Flatten(const std::vector<Eigen::Vector3d>& corners,
                                     const Eigen::Vector3d& normal) {
  int drop = 0;
  normal.cwiseAbs().maxCoeff(&drop);
  const int x = (drop + 1) % 3;
  const int y = (drop + 2) % 3;
  const double sign = normal[drop] < 0.0 ? -1.0 : 1.0;
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(corners.size());
  for (const Eigen::Vector3d& p : corners) {
    flat.emplace_back(sign * p[x], p[y]);
  }
  return flat;
}

// Whether the corner `b` between `a` and `c` can be cut off: it is convex and no other corner lies
// in its triangle.
bool IsEar(const std::vector<Eigen::Vector2d>& flat, const std::vector<int>& rest, std::size_t i) {
  const std::size_t n = rest.size();
  const Eigen::Vector2d& a = flat[rest[(i + n - 1) % n]];
  const Eigen::Vector2d& b = flat[rest[i]];
  const Eigen::Vector2d& c = flat[rest[(i + 1) % n]];
  if (!(Cross(a, b, c) > 0.0)) {
    return false;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector2d& p = flat[rest[k]];
    // A corner at the same place as one of the triangle's (a hole cut open) is no obstacle.
    if (p == a || p == b || p == c) {
      continue;
    }
    if (Cross(a, b, p) >= 0.0 && Cross(b, c, p) >= 0.0 && Cross(c, a, p) >= 0.0) {
      return false;
    }
  }
  return true;
}

bool IsConvex(const std::vector<Eigen::Vector2d>& flat) {
  const std::size_t n = flat.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (Cross(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) < 0.0) {
      return false;
    }
  }
  return true;
}

} // namespace

Eigen::Vector3d PolygonNormal(const std::vector<Eigen::Vector3d>& corners) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    normal += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  }
  return normal;
}

void TriangulatePolygon(const std::vector<Eigen::Vector3d>& corners, bool convex,
                        std::vector<std::array<int, 3>>& triangles) {
  const int n = static_cast<int>(corners.size());
  std::vector<int> rest;
  if (!convex && n > 3 && n <= MaximumEarCorners) {
    const Eigen::Vector3d normal = PolygonNormal(corners);
    const std::vector<Eigen::Vector2d> flat = Flatten(corners, normal);
    if (normal.allFinite() && !IsConvex(flat)) {
      for (int i = 0; i < n; ++i) {
        rest.push_back(i);
      }
      std::size_t i = 0;
      for (std::size_t misses = 0; rest.size() > 3 && misses < rest.size();) {
        i %= rest.size();
        if (!IsEar(flat, rest, i)) {
          ++i;
          ++misses;
          continue;
        }
        const std::size_t m = rest.size();
        triangles.push_back({rest[(i + m - 1) % m], rest[i], rest[(i + 1) % m]});
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
        misses = 0;
      }
    }
  }
  const int m = rest.empty() ? n : static_cast<int>(rest.size());
  const auto corner = [&rest](int i) { return rest.empty() ? i : rest[i]; };
  for (int i = 1; i + 1 < m; ++i) {
    triangles.push_back({corner(0), corner(i), corner(i + 1)});
  }
}

} // namespace dspace
