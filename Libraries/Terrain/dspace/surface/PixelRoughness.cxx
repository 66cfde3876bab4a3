#include <dspace/surface/PixelRoughness.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <dspace/Error.h>

namespace dspace {
namespace {

constexpr double MaximumPixels = 4e6;
constexpr double NoRoughness = std::numeric_limits<double>::quiet_NaN();

// Heights over places in units of the radius.
struct Footprint {
  std::vector<Eigen::Vector3d> points;
  std::size_t holes = 0;

  double Roughness() const {
    const auto n = double(this->points.size());
    if (this->points.size() < 4 || this->points.size() < this->holes) {
      return NoRoughness;
    }
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : this->points) {
      mean += p / n;
    }
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& p : this->points) {
      moments += (p - mean) * (p - mean).transpose() / n;
    }
    const Eigen::Matrix2d level = moments.topLeftCorner<2, 2>();
    if (!(level.determinant() > 1e-9 * level.trace() * level.trace())) {
      return NoRoughness; // in a line
    }
    const Eigen::Vector2d slope = level.ldlt().solve(moments.topRightCorner<2, 1>());
    double sum = 0.0;
    for (const Eigen::Vector3d& p : this->points) {
      const Eigen::Vector3d d = p - mean;
      const double off = d.z() - slope.dot(d.head<2>());
      sum += off * off;
    }
    return std::sqrt(sum / n);
  }
};

} // namespace

PixelRoughness::PixelRoughness(std::string object, Pixels pixels)
    : Object_(std::move(object)), Pixels_(std::move(pixels)) {}

// Posts of the level that a circle reaches to either side.
Eigen::Vector2d PixelRoughness::Reach(const Eigen::Vector3d& p_S, double radius) const {
  const PostPlacement& placement = this->Pixels_.placement;
  const double posts = std::ldexp(1.0, this->Pixels_.level);
  if (!placement.OnBody()) {
    const Eigen::Matrix2d m = placement.SceneToPost().linear();
    return radius / posts * Eigen::Vector2d(m.row(0).norm(), m.row(1).norm());
  }
  const double angle = radius / placement.Body().NorthRadius(0.0); // at most
  if (placement.GetKind() == PostPlacement::Kind::Pole) {          // farthest outwards
    const double away =
        2.0 * std::atan(placement.OnPlaneOfPole(placement.ToPosts(p_S).head<2>()).norm());
    const double reach = std::tan(0.5 * std::min(away + angle, 3.1)) - std::tan(0.5 * away);
    return Eigen::Vector2d::Constant(reach / placement.PlaneStep() / posts);
  }
  const Eigen::Vector2d step = placement.Step().cwiseAbs() * posts;
  const double parallel = placement.Up(p_S).head<2>().norm();
  const double aside = angle < 0.5 * M_PI && std::sin(angle) < parallel
                           ? std::asin(std::sin(angle) / parallel)
                           : M_PI;
  return Eigen::Vector2d(aside, angle).cwiseQuotient(step);
}

PostBlock PixelRoughness::BlockAbout(const Eigen::Vector3d& p_S, double radius) const {
  const PostPlacement& placement = this->Pixels_.placement;
  const PostLattice& lattice = this->Pixels_.lattice;
  const int level = this->Pixels_.level;
  const int every = this->Pixels_.between ? 2 : 1;
  const double posts = std::ldexp(1.0, level); // of level 0 to the next of the level
  const Eigen::Vector2d post = placement.ToPosts(p_S).head<2>() / posts;
  const Eigen::Vector2d reach = this->Reach(p_S, radius);
  const double most = placement.GetKind() == PostPlacement::Kind::Sphere
                          ? 2.0 * M_PI / std::abs(placement.Step().x()) / posts
                          : double(lattice.ColumnsAt(level));
  const double wide = std::min(2.0 * reach.x(), most);
  const double high = std::min(2.0 * reach.y(), double(lattice.RowsAt(level)));
  if (wide * high > MaximumPixels * every * every) {
    throw Error(Error::Kind::InvalidArgument, this->Object_,
                "radius " + std::to_string(radius) +
                    " m reaches over 4 million of its pixels; accepted is a smaller one");
  }
  PostBlock block;
  block.level = level;
  const auto last = [](double at, std::int64_t end) {
    return std::int64_t(std::floor(std::clamp(at, -1.0, double(end))));
  };
  block.row = last(std::ceil(post.y() - reach.y()), lattice.RowsAt(level));
  block.height = int(last(post.y() + reach.y(), lattice.RowsAt(level)) - block.row) + 1;
  if (lattice.periodic) { // each column once
    const auto columns = lattice.ColumnsAt(level);
    block.column = std::int64_t(std::ceil(post.x() - std::min(reach.x(), 0.5 * double(columns))));
    const std::int64_t to = std::int64_t(std::floor(post.x() + reach.x()));
    block.width = int(std::min(to - block.column + 1, columns));
  } else {
    block.column = last(std::ceil(post.x() - reach.x()), lattice.ColumnsAt(level));
    block.width = int(last(post.x() + reach.x(), lattice.ColumnsAt(level)) - block.column) + 1;
  }
  return block;
}

double PixelRoughness::At(const Eigen::Vector3d& p_S, double radius) const {
  const PostPlacement& placement = this->Pixels_.placement;
  const PostLattice& lattice = this->Pixels_.lattice;
  const PostBlock block = this->BlockAbout(p_S, radius);
  std::vector<float> heights;
  if (block.width > 0 && block.height > 0) {
    heights.resize(std::size_t(block.width) * block.height);
    this->Pixels_.read(block, heights.data());
  }
  const int every = this->Pixels_.between ? 2 : 1;
  const int firstRow = this->Pixels_.between ? 1 : 0;
  const double posts = std::ldexp(1.0, block.level);
  const Eigen::Vector3d up = placement.Up(p_S);
  const Eigen::Vector3d north = placement.North(p_S);
  const Eigen::Vector3d east = north.cross(up);
  const Eigen::Vector3d foot = // on the body
      placement.OnBody() ? placement.Body().Point(up, 0.0) : Eigen::Vector3d(p_S);
  Footprint footprint;
  for (int r = 0; r < block.height; ++r) {
    for (int c = 0; c < block.width; ++c) {
      const std::int64_t row = block.row + r;
      const std::int64_t column = block.column + c;
      const bool inside =
          row >= 0 && row < lattice.RowsAt(block.level) &&
          (lattice.periodic || (column >= 0 && column < lattice.ColumnsAt(block.level)));
      if (!inside || (row - firstRow) % every != 0 || column % every != 0) {
        continue;
      }
      const Eigen::Vector3d there =
          placement.ToScene(Eigen::Vector2d(double(column), double(row)) * posts, 0.0);
      Eigen::Vector2d at;
      if (placement.OnBody() && !placement.Body().Spherical()) {
        // Along a circle of its radius, to some 1e-6 of a radius of 100 km.
        const Eigen::Vector3d chord = there - foot;
        const Eigen::Vector2d aside(chord.dot(east), chord.dot(north));
        const double part = chord.norm() / placement.Radius();
        const double level = aside.norm();
        at = level > 0.0 ? Eigen::Vector2d(aside * (chord.norm() * (1.0 + part * part / 24.0) /
                                                    (level * radius)))
                         : Eigen::Vector2d::Zero();
      } else if (placement.OnBody()) { // distance and direction along the sphere
        const Eigen::Vector3d d = there / placement.Radius();
        const Eigen::Vector2d aside(d.dot(east), d.dot(north));
        const double sine = aside.norm();
        const double angle = std::atan2(sine, d.dot(up));
        at = sine > 0.0 ? Eigen::Vector2d(aside * (angle / sine)) : Eigen::Vector2d::Zero();
        at *= placement.Radius() / radius;
      } else {
        at = (there - p_S).head<2>() / radius;
      }
      if (at.squaredNorm() > 1.0) {
        continue;
      }
      const float height = heights[std::size_t(r) * block.width + c];
      if (std::isnan(height)) {
        ++footprint.holes;
      } else {
        footprint.points.emplace_back(at.x(), at.y(), height);
      }
    }
  }
  return footprint.Roughness();
}

} // namespace dspace
