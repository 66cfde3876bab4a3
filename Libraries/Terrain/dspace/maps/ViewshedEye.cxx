#include <dspace/maps/ViewshedEye.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <dspace/horizon/EdgeCrossings.h>
#include <dspace/horizon/HeldPosts.h>

namespace dspace {
namespace {

constexpr double Snap = 1e-9;   // of an edge: a place on a post needs no other one
constexpr double Stretch = 8.0; // posts that are followed at once
constexpr double Touch = 1e-6;  // posts: ground so near an end is no obstacle

constexpr double NoValue = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

} // namespace

inline double ViewshedEye::HeightAt(std::int64_t c, std::int64_t r) const {
  const PostBlock& place = this->Held_.Place();
  const auto row = std::uint64_t(r - place.row);
  auto column = std::uint64_t(c - place.column);
  if (column >= std::uint64_t(place.width)) {
    const PostLattice& lattice = this->Ground_.pyramid->Lattice();
    if (!lattice.periodic) {
      return NoValue;
    }
    column = std::uint64_t(lattice.Wrapped(0, c) - place.column);
  }
  return row >= std::uint64_t(place.height)
             ? NoValue
             : this->Held_.Heights()[row * std::uint64_t(place.width) + column];
}

// On an edge; NaN without data.
inline double ViewshedEye::HeightOn(std::int64_t c, std::int64_t r, int right, int down,
                                    double share) const {
  if (share < Snap) {
    return this->HeightAt(c, r);
  }
  const double second = this->HeightAt(c + right, r + down);
  if (share > 1.0 - Snap) {
    return second;
  }
  const double first = this->HeightAt(c, r);
  return first + share * (second - first);
}

ViewshedEye::ViewshedEye(const MapGround& ground, const HeldPosts& held,
                         const ViewshedObserver& observer)
    : Ground_(ground), Held_(held), Post_(observer.post) {
  const double c = std::floor(this->Post_.x());
  const double r = std::floor(this->Post_.y());
  const double u = this->Post_.x() - c;
  const double v = this->Post_.y() - r;
  const auto at = [&](int right, int down, double share) {
    return share == 0.0 ? 0.0
                        : share * this->HeightAt(std::int64_t(c) + right, std::int64_t(r) + down);
  };
  const bool below = v > u;
  this->Floor_ = at(0, 0, 1.0 - std::max(u, v)) + at(1, 1, std::min(u, v)) +
                 (below ? at(0, 1, v - u) : at(1, 0, u - v));
  this->Height_ = this->Floor_ + observer.height;
}

bool ViewshedEye::HasGround() const {
  return !std::isnan(this->Floor_);
}

// Bounds of the heights of the ground about a line between two places.
HeightSpan ViewshedEye::SpanOf(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                               int margin) const {
  const Eigen::Vector2d low = a.cwiseMin(b);
  const Eigen::Vector2d high = a.cwiseMax(b);
  PostBlock box;
  box.column = std::int64_t(std::floor(low.x())) - margin;
  box.row = std::int64_t(std::floor(low.y())) - margin;
  box.width = int(std::int64_t(std::floor(high.x())) + margin + 2 - box.column);
  box.height = int(std::int64_t(std::floor(high.y())) + margin + 2 - box.row);
  return this->Held_.SpanOf(box);
}

// Straight over the posts of a plane. Slopes are rises over the whole line.
class ViewshedEye::PlaneLine {
public:
  PlaneLine(const ViewshedEye& eye, const Eigen::Vector2d& to, double height)
      : Eye_(eye), To_(to), Height_(height), Way_(to - eye.Post_), Posts_(this->Way_.norm()) {}

  double Length() const {
    return (this->Eye_.Ground_.placement.PostToScene().linear() * this->Way_).norm();
  }
  // Where nothing can stand between.
  std::optional<double> LeastAtOnce() const { return {}; }
  int Stretches() const { return this->Stretches_; }

  double SlopeTo(double above) const { return this->Height_ + above - this->Eye_.Height_; }
  double Least(double steepest) const {
    return std::max(0.0, this->Eye_.Height_ + steepest - this->Height_);
  }

  // No crossing in the stretches from the first up to `end` is steeper.
  double Bound(int first, int end) const {
    const double from = this->Share(first);
    const double till = this->Share(end);
    const double highest =
        this->Eye_.SpanOf(this->Post(from), this->Post(till), 1).greatest - this->Eye_.Height_;
    return highest > 0.0 ? highest / from : highest / till;
  }

  void Follow(int stretch, double& steepest) const {
    const double from = this->Share(stretch);
    const double till = this->Share(stretch + 1);
    const Eigen::Vector2d a = this->Post(from);
    const Eigen::Vector2d b = this->Post(till);
    const double first = Touch / std::max(this->Posts_, Touch);
    ForEachCrossing(
        a.x(), a.y(), b.x(), b.y(),
        [&](double t, std::int64_t c, std::int64_t r, int right, int down, double share) {
          const double at = from + t * (till - from);
          if (at > first && at < 1.0 - first) {
            const double rise = this->Eye_.HeightOn(c, r, right, down, share) - this->Eye_.Height_;
            steepest = rise > steepest * at ? rise / at : steepest;
          }
        });
  }

private:
  double Share(int stretch) const {
    return stretch < this->Stretches_ ? stretch * Stretch / this->Posts_ : 1.0;
  }
  Eigen::Vector2d Post(double share) const {
    return share < 1.0 ? Eigen::Vector2d(this->Eye_.Post_ + share * this->Way_) : this->To_;
  }

  const ViewshedEye& Eye_;
  Eigen::Vector2d To_;
  double Height_; // of the ground there
  Eigen::Vector2d Way_;
  double Posts_;
  int Stretches_ = std::max(int(std::ceil(this->Posts_ / Stretch)), 1);
};

// On a great circle over a body. Slopes are tangents of elevations.
class ViewshedEye::BodyLine {
public:
  BodyLine(const ViewshedEye& eye, const Eigen::Vector2d& to, double height, Memory& memory)
      : BodyLine(eye, to, height, memory, eye.Ground_.placement.ToScene(eye.Post_, 0.0),
                 eye.Ground_.placement.ToScene(to, 0.0)) {}

  double Length() const { return this->Length_; }
  std::optional<double> LeastAtOnce() const {
    if (this->Angle_ > 0.5 * M_PI) {
      return Infinity;
    }
    return this->Length_ < Touch * this->PostSize_ ? std::optional<double>(0.0) : std::nullopt;
  }
  int Stretches() const { return this->Stretches_; }

  double SlopeTo(double above) {
    const HorizonPath::Point& end = this->Point(this->Stretches());
    const double top = this->Height_ + above;
    return (end.fall + end.rise * top - this->Eye_.Height_) / (end.away + end.spread * top);
  }
  double Least(double steepest) {
    if (!std::isfinite(steepest)) {
      return 0.0; // nothing is between them
    }
    const HorizonPath::Point& end = this->Point(this->Stretches());
    const double rise = end.rise - steepest * end.spread;
    return rise > 0.0 ? std::max(0.0, (steepest * end.away - end.fall + this->Eye_.Height_) / rise -
                                          this->Height_)
                      : Infinity;
  }

  // About a pole of a degree grid the places between two may lie outside the box of a straight
  // line.
  double Bound(int first, int end) {
    const PostPlacement& placement = this->Eye_.Ground_.placement;
    const HorizonPath::Point a = this->Point(first);
    const HorizonPath::Point b = this->Point(end);
    const double arc = (this->Distance(end) - this->Distance(first)) / placement.Radius();
    // A great circle departs from its chord in posts by so many of them.
    double bow = 0.125 * arc * arc * placement.Radius() / (0.5 * this->PostSize_);
    if (placement.GetKind() == PostPlacement::Kind::Sphere) {
      constexpr double Polar = 80.0 * M_PI / 180.0;
      const double latitude =
          std::max(std::abs(placement.Angles(a.post).y()), std::abs(placement.Angles(b.post).y())) +
          arc;
      if (latitude > Polar) {
        return Infinity;
      }
      bow = 0.125 * arc * arc * std::tan(latitude) /
            std::min(std::abs(placement.Step().y()),
                     std::abs(placement.Step().x()) * std::cos(latitude));
    }
    // The bounds below count on what holds of spheres, and of ellipsoids up to here.
    constexpr double Quarter = 85.0 * M_PI / 180.0;
    if (!placement.Body().Spherical() && this->Distance(end) > Quarter * placement.Radius()) {
      return Infinity;
    }
    constexpr double MostBow = 64.0; // posts
    const PostLattice& lattice = this->Eye_.Ground_.pyramid->Lattice();
    if (!(bow < MostBow) ||
        (lattice.periodic && (std::min(a.post.x(), b.post.x()) < -0.4 * double(lattice.columns) ||
                              std::max(a.post.x(), b.post.x()) > 1.4 * double(lattice.columns)))) {
      return Infinity;
    }
    const HeightSpan span = this->Eye_.SpanOf(a.post, b.post, 2 + int(std::ceil(1.5 * bow)));
    if (!(span.least <= span.greatest)) {
      return -Infinity; // no data
    }
    const double high = span.greatest;
    const double top = a.fall + std::max(a.rise * high, b.rise * high) - this->Eye_.Height_;
    const double least = a.away + std::min({a.spread * span.least, b.spread * span.least, 0.0});
    const double most = b.away + std::max(b.spread * high, 0.0);
    return least > 0.0 ? (top > 0.0 ? top / least : top / most) + 1e-12 : Infinity;
  }

  void Follow(int stretch, double& steepest) {
    const double till = this->Distance(stretch + 1);
    const double first = Touch * this->PostSize_;
    HorizonPath::Point a = this->Point(stretch);
    for (double s = this->Distance(stretch); s < till;) {
      double next = s + 0.5 * this->Path_.FineStep(a, s, this->PostSize_);
      next = next > till - 0.005 * this->PostSize_ ? till : next;
      const HorizonPath::Point b = next == till ? this->Point(stretch + 1) : this->Path_.At(next);
      // Linear between them but for the fall, which bends as the sphere does.
      const double bend = 0.5 * (next - s) * (next - s) / this->Eye_.Ground_.placement.Radius();
      const auto mix = [](double from, double to, double t) { return from + t * (to - from); };
      ForEachCrossing(
          a.post.x(), a.post.y(), b.post.x(), b.post.y(),
          [&](double t, std::int64_t c, std::int64_t r, int right, int down, double share) {
            const double at = s + t * (next - s);
            if (at > first && at < this->Length_ - first) {
              const double h = this->Eye_.HeightOn(c, r, right, down, share);
              const double rise = mix(a.fall, b.fall, t) + bend * t * (1.0 - t) +
                                  mix(a.rise, b.rise, t) * h - this->Eye_.Height_;
              const double away = mix(a.away, b.away, t) + mix(a.spread, b.spread, t) * h;
              steepest = rise > steepest * away ? rise / away : steepest;
            }
          });
      s = next;
      a = b;
    }
  }

private:
  BodyLine(const ViewshedEye& eye, const Eigen::Vector2d&, double height, Memory& memory,
           const Eigen::Vector3d& from_S, const Eigen::Vector3d& to_S)
      : Eye_(eye), Height_(height), PostSize_(eye.Ground_.placement.CellSize(eye.Post_)),
        Path_(eye.Ground_.placement, eye.Post_,
              ChartDirectionAt(eye.Ground_.placement, eye.Post_, to_S - from_S).azimuth_deg),
        Points_(memory.points) {
    const Eigen::Vector3d up = eye.Ground_.placement.Up(from_S);
    const Eigen::Vector3d other = eye.Ground_.placement.Up(to_S);
    this->Angle_ = std::atan2(up.cross(other).norm(), up.dot(other));
    this->Length_ = this->Angle_ * eye.Ground_.placement.Radius();
    this->Stretches_ = std::max(int(std::ceil(this->Length_ / (Stretch * this->PostSize_))), 1);
    this->Points_.assign(std::size_t(this->Stretches()) + 1, std::nullopt);
  }

  double Distance(int stretch) const {
    return std::min(stretch * Stretch * this->PostSize_, this->Length_);
  }
  const HorizonPath::Point& Point(int stretch) {
    std::optional<HorizonPath::Point>& point = this->Points_[std::size_t(stretch)];
    if (!point) {
      point = this->Path_.At(this->Distance(stretch));
    }
    return *point;
  }

  const ViewshedEye& Eye_;
  double Height_; // of the ground at the target
  double PostSize_;
  HorizonPath Path_;
  double Angle_ = 0.0;
  double Length_ = 0.0;
  int Stretches_ = 1;
  std::vector<std::optional<HorizonPath::Point>>& Points_;
};

// Raises `steepest` to the steepest crossing of a line. With a target the search ends, and it is
// true, as soon as a crossing hides it.
template<class Line>
bool ViewshedEye::Search(Line& line, double& steepest, std::optional<double> target,
                         Memory& memory) const {
  const int count = line.Stretches();
  const int likely = memory.stretch > 0 && memory.stretch < count ? memory.stretch : 0;
  bool hidden = false;
  const auto follow = [&](int stretch) {
    const double before = steepest;
    line.Follow(stretch, steepest);
    if (steepest > before) {
      memory.stretch = stretch;
      hidden = target && line.Least(steepest) > *target;
    }
  };
  follow(0); // nothing bounds it
  if (likely > 0 && !hidden) {
    follow(likely);
  }
  std::array<std::pair<int, int>, 64> ranges; // that are left, each half of one before
  std::size_t left = 0;
  if (count > 1) {
    ranges[left++] = {1, count};
  }
  while (left > 0 && !hidden) {
    const auto [first, end] = ranges[--left];
    if (end - first == 1 && first == likely) {
      continue;
    }
    if (line.Bound(first, end) <= steepest) {
      continue;
    }
    if (end - first == 1) {
      follow(first);
      continue;
    }
    const int middle = (first + end) / 2;
    ranges[left++] = {middle, end};
    ranges[left++] = {first, middle};
  }
  return hidden;
}

double ViewshedEye::Least(const Eigen::Vector2d& to, double radius, Memory& memory) const {
  const auto least = [&](auto&& line) {
    if (line.Length() > radius) {
      return NoValue;
    }
    if (const std::optional<double> known = line.LeastAtOnce()) {
      return *known;
    }
    double steepest = -Infinity;
    this->Search(line, steepest, std::nullopt, memory);
    return line.Least(steepest);
  };
  const double height = this->HeightAt(std::llround(to.x()), std::llround(to.y()));
  if (std::isnan(height)) {
    return NoValue;
  }
  return this->Ground_.placement.OnBody() ? least(BodyLine(*this, to, height, memory))
                                          : least(PlaneLine(*this, to, height));
}

std::optional<bool> ViewshedEye::Sees(const Eigen::Vector2d& to, double radius, double targetHeight,
                                      Memory& memory) const {
  const auto sees = [&](auto&& line) -> std::optional<bool> {
    if (line.Length() > radius) {
      return {};
    }
    if (const std::optional<double> known = line.LeastAtOnce()) {
      return *known <= targetHeight;
    }
    double steepest = line.SlopeTo(targetHeight);
    return !this->Search(line, steepest, targetHeight, memory);
  };
  const double height = this->HeightAt(std::llround(to.x()), std::llround(to.y()));
  if (std::isnan(height)) {
    return {};
  }
  return this->Ground_.placement.OnBody() ? sees(BodyLine(*this, to, height, memory))
                                          : sees(PlaneLine(*this, to, height));
}

} // namespace dspace
