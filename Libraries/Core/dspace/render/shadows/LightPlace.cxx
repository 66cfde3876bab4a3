#include <dspace/render/shadows/LightPlace.h>

#include <algorithm>

namespace dspace {
namespace {

constexpr double Grazing = 1e-3; // sine of the light's elevation over planes that say nothing more

// The sides of the convex hull of points (A. M. Andrew 1979), moved outwards by a radius. Returns
// how many there are: none of too many points, which a box must do for.
template<std::size_t Most>
int SidesOf(const std::vector<Eigen::Vector3d>& given, double radius,
            std::array<Eigen::Vector3d, Most>& sides) {
  std::array<Eigen::Vector2d, Most> points;
  if (given.size() > Most) {
    return 0;
  }
  const auto end = std::transform(given.begin(), given.end(), points.begin(),
                                  [](const Eigen::Vector3d& p) { return p.head<2>(); });
  const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  for (auto p = points.begin(); p != end; ++p) { // there are few
    std::rotate(std::upper_bound(points.begin(), p, *p, before), p, p + 1);
  }
  int count = 0;
  for (const double turn : {1.0, -1.0}) { // the lower half, and the upper one
    std::array<Eigen::Vector2d, Most> chain;
    std::size_t length = 0;
    for (auto p = points.begin(); p != end; ++p) {
      while (length > 1) {
        const Eigen::Vector2d a = chain[length - 1] - chain[length - 2];
        const Eigen::Vector2d b = *p - chain[length - 1];
        if (turn * (a.x() * b.y() - a.y() * b.x()) > 0.0) {
          break;
        }
        --length;
      }
      chain[length++] = *p;
    }
    for (std::size_t i = 1; i < length && count < int(Most); ++i) {
      const Eigen::Vector2d along = chain[i] - chain[i - 1];
      const double distance = along.norm();
      if (distance > 0.0) {
        const Eigen::Vector2d out = turn / distance * Eigen::Vector2d(along.y(), -along.x());
        sides[std::size_t(count++)] = {out.x(), out.y(), out.dot(chain[i]) + radius};
      }
    }
  }
  return count;
}

} // namespace

LightPlace::LightPlace(const Eigen::Matrix3d& axes, const LightHull& hull)
    : Axes_(axes), Boxes_(hull.parts), X_VM_(hull.X_VM), Anywhere_(hull.points.empty()) {
  thread_local std::vector<Eigen::Vector3d> places;
  places.clear();
  for (const Eigen::Vector3d& point : hull.points) {
    places.push_back(axes * point);
    this->Whole_.box.extend(places.back());
    this->Depths_.nearest = std::min(this->Depths_.nearest, -point.z() - hull.radius);
    this->Depths_.farthest = std::max(this->Depths_.farthest, -point.z() + hull.radius);
  }
  this->Whole_.box.min().array() -= hull.radius;
  this->Whole_.box.max().array() += hull.radius;
  const auto along = [&](const Eigen::Vector4d& plane) -> std::optional<Eigen::Vector3d> {
    const Eigen::Vector3d normal = axes * plane.head<3>();
    if (normal.z() < Grazing) {
      return std::nullopt;
    }
    return Eigen::Vector3d(-plane[3], -normal.x(), -normal.y()) / normal.z();
  };
  this->Whole_.floor = hull.floor ? along(*hull.floor) : std::nullopt;
  this->Whole_.ceiling = hull.ceiling ? along(*hull.ceiling) : std::nullopt;
  this->Whole_.sideCount = SidesOf(places, hull.radius, this->Whole_.sides);
}

const std::vector<LightPlace::Part>& LightPlace::Parts() const {
  if (this->Parts_.empty() && this->HasParts()) {
    const Eigen::Matrix<double, 3, 4> X_LM = this->Axes_ * this->X_VM_;
    const Eigen::Matrix3d spread = X_LM.leftCols<3>().cwiseAbs();
    const Eigen::RowVector3d depth = this->X_VM_.row(2).head<3>().cwiseAbs();
    this->Parts_.reserve(this->Boxes_->size());
    for (const Eigen::AlignedBox3f& box : *this->Boxes_) {
      if (box.isEmpty()) {
        continue;
      }
      const Eigen::Vector3d middle = box.center().cast<double>();
      const Eigen::Vector3d size = 0.5 * box.sizes().cast<double>();
      const Eigen::Vector3d center = X_LM.leftCols<3>() * middle + X_LM.col(3);
      const Eigen::Vector3d half = spread * size;
      const double before = -(this->X_VM_.row(2).head<3>().dot(middle) + this->X_VM_(2, 3));
      Part part;
      part.box = Eigen::AlignedBox3d(center - half, center + half);
      part.depths = {before - depth.dot(size), before + depth.dot(size)};
      this->Parts_.push_back(part);
    }
  }
  return this->Parts_;
}

} // namespace dspace
