#include <dspace/measure/MeshRays.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace dspace {
namespace {

using V = Eigen::Vector3d;
constexpr double Infinity = std::numeric_limits<double>::infinity();
// Nodes that wait in a walk: halves of 2^32 triangles at most.
constexpr std::size_t MostDepth = 64;

// Moeller and Trumbore (1997), with edges that belong to both of their triangles.
double CrossingOf(const V& origin, const V& direction, const V& a, const V& b, const V& c) {
  const V ab = b - a;
  const V ac = c - a;
  const V p = direction.cross(ac);
  const double det = ab.dot(p);
  if (det == 0.0) {
    return Infinity;
  }
  constexpr double Edge = 1e-12;
  const V s = origin - a;
  const double u = s.dot(p) / det;
  if (!(u >= -Edge && u <= 1.0 + Edge)) {
    return Infinity;
  }
  const V q = s.cross(ab);
  const double v = direction.dot(q) / det;
  if (!(v >= -Edge && u + v <= 1.0 + Edge)) {
    return Infinity;
  }
  return ac.dot(q) / det;
}

// Whether origin + t * direction is in the box for some t in [first, last].
bool Reaches(const Eigen::AlignedBox3d& box, const V& origin, const V& direction, double first,
             double last) {
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0.0) {
      if (origin[k] < box.min()[k] || origin[k] > box.max()[k]) {
        return false;
      }
      continue;
    }
    double t0 = (box.min()[k] - origin[k]) / direction[k];
    double t1 = (box.max()[k] - origin[k]) / direction[k];
    if (t0 > t1) {
      std::swap(t0, t1);
    }
    constexpr double Slack = 1e-12; // of rounding
    first = std::max(first, t0 - Slack * std::abs(t0));
    last = std::min(last, t1 + Slack * std::abs(t1));
  }
  return first <= last;
}

V OnSegment(const V& p, const V& a, const V& b) { // nearest to p
  const V d = b - a;
  const double length = d.squaredNorm();
  return length == 0.0 ? a : V(a + std::clamp((p - a).dot(d) / length, 0.0, 1.0) * d);
}

// The nearest points of two segments (Ericson, Real-Time Collision Detection, 5.1.9).
void Segments(const V& p1, const V& q1, const V& p2, const V& q2, V& on1, V& on2) {
  const V d1 = q1 - p1;
  const V d2 = q2 - p2;
  const V r = p1 - p2;
  const double a = d1.squaredNorm();
  const double e = d2.squaredNorm();
  const double f = d2.dot(r);
  if (a == 0.0 || e == 0.0) {
    on2 = e == 0.0 ? p2 : OnSegment(p1, p2, q2);
    on1 = OnSegment(on2, p1, q1);
    return;
  }
  const double c = d1.dot(r);
  const double b = d1.dot(d2);
  const double denominator = a * e - b * b;
  double s =
      denominator > 1e-14 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  double t = (b * s + f) / e;
  if (t < 0.0) {
    t = 0.0;
    s = std::clamp(-c / a, 0.0, 1.0);
  } else if (t > 1.0) {
    t = 1.0;
    s = std::clamp((b - c) / a, 0.0, 1.0);
  }
  on1 = p1 + s * d1;
  on2 = p2 + t * d2;
}

// The point of a triangle that is nearest to p (Ericson, 5.1.5).
V OnTriangle(const V& p, const V& a, const V& b, const V& c) {
  const V normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  if (area > 0.0) {
    V foot = p - normal * (normal.dot(p - a) / area);
    if (normal.dot((b - a).cross(foot - a)) >= 0.0 && normal.dot((c - b).cross(foot - b)) >= 0.0 &&
        normal.dot((a - c).cross(foot - c)) >= 0.0) {
      return foot;
    }
  }
  V best = OnSegment(p, a, b);
  for (const V& each : {OnSegment(p, b, c), OnSegment(p, c, a)}) {
    if ((each - p).squaredNorm() < (best - p).squaredNorm()) {
      best = each;
    }
  }
  return best;
}

} // namespace

MeshRays::MeshRays(std::shared_ptr<const Mesh> mesh) : Mesh_(std::move(mesh)) {
  if (!this->Mesh_ || this->Mesh_->primitive != Mesh::Primitive::Triangles) {
    return;
  }
  const std::size_t count = this->Mesh_->indices.size() / 3;
  std::vector<Eigen::AlignedBox3d> boxes(count);
  for (std::size_t t = 0; t < count; ++t) {
    this->Order_.push_back(std::uint32_t(t));
    for (int k = 0; k < 3; ++k) {
      boxes[t].extend(CornerOf(*this->Mesh_, t, k));
    }
  }
  if (count > 0) {
    this->Build(0, std::uint32_t(count), boxes);
  }
}

// Halves the triangles at the median of their centres along the longest side of these.
void MeshRays::Build(std::uint32_t first, std::uint32_t last,
                     const std::vector<Eigen::AlignedBox3d>& boxes) {
  const std::size_t at = this->Nodes_.size();
  this->Nodes_.emplace_back();
  Eigen::AlignedBox3d box, centers;
  for (std::uint32_t i = first; i < last; ++i) {
    box.extend(boxes[this->Order_[i]]);
    centers.extend(boxes[this->Order_[i]].center());
  }
  this->Nodes_[at].box = box;
  constexpr std::uint32_t Leaf = 4;
  if (last - first <= Leaf) {
    this->Nodes_[at].first = first;
    this->Nodes_[at].count = last - first;
    return;
  }
  Eigen::Index axis = 0;
  centers.sizes().maxCoeff(&axis);
  const std::uint32_t middle = first + (last - first) / 2;
  const auto begin = this->Order_.begin();
  std::nth_element(begin + first, begin + middle, begin + last,
                   [&](std::uint32_t i, std::uint32_t j) {
                     return boxes[i].center()[axis] < boxes[j].center()[axis];
                   });
  this->Build(first, middle, boxes);
  this->Nodes_[at].first = std::uint32_t(this->Nodes_.size());
  this->Build(middle, last, boxes);
}

template<typename Enter, typename Visit>
void MeshRays::Walk(const Enter& enter, const Visit& visit) const {
  std::array<std::uint32_t, MostDepth> todo;
  std::size_t waiting = 0;
  if (!this->Nodes_.empty()) {
    todo[waiting++] = 0;
  }
  while (waiting > 0) {
    const std::uint32_t at = todo[--waiting];
    const Node& node = this->Nodes_[at];
    if (!enter(node.box)) {
      continue;
    }
    if (node.count == 0) {
      todo[waiting++] = node.first;
      todo[waiting++] = at + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const std::uint32_t t = this->Order_[i];
      visit(CornerOf(*this->Mesh_, t, 0), CornerOf(*this->Mesh_, t, 1),
            CornerOf(*this->Mesh_, t, 2));
    }
  }
}

MeshRays::Crossing MeshRays::Cross(const V& origin_M, const V& direction_M, double first,
                                   double last) const {
  Crossing best;
  this->Walk(
      [&](const Eigen::AlignedBox3d& box) {
        return Reaches(box, origin_M, direction_M, first, std::min(last, best.t));
      },
      [&](const V& a, const V& b, const V& c) {
        const double found = CrossingOf(origin_M, direction_M, a, b, c);
        if (found >= first && found <= last && found < best.t) {
          best = {found, (b - a).cross(c - a)};
        }
      });
  return best;
}

MeshRays::Near MeshRays::Nearest(const Eigen::Affine3d& X_WM, const V& a_W, const V& b_W,
                                 double within) const {
  Near best;
  best.distance = within;
  bool found = false;
  const auto offer = [&](const V& onLine, const V& onTriangle) {
    const double distance = (onLine - onTriangle).norm();
    if (distance < best.distance) {
      best = {distance, onTriangle};
      found = true;
    }
  };
  const Eigen::Matrix3d spread = X_WM.linear().cwiseAbs();
  this->Walk(
      [&](const Eigen::AlignedBox3d& box) {
        const V center = X_WM * box.center();
        const double radius = (spread * (0.5 * box.sizes())).norm();
        return (OnSegment(center, a_W, b_W) - center).norm() - radius <= best.distance;
      },
      [&](const V& a_M, const V& b_M, const V& c_M) {
        const V p = X_WM * a_M;
        const V q = X_WM * b_M;
        const V r = X_WM * c_M;
        const double crossing = CrossingOf(a_W, b_W - a_W, p, q, r);
        if (crossing >= 0.0 && crossing <= 1.0) {
          const V point = a_W + crossing * (b_W - a_W);
          offer(point, point);
        }
        for (const auto& [start, end] : {std::pair(p, q), std::pair(q, r), std::pair(r, p)}) {
          V onLine, onEdge;
          Segments(a_W, b_W, start, end, onLine, onEdge);
          offer(onLine, onEdge);
        }
        offer(a_W, OnTriangle(a_W, p, q, r));
        offer(b_W, OnTriangle(b_W, p, q, r));
      });
  return found ? best : Near();
}

} // namespace dspace
