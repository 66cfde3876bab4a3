#include <dspace/horizon/HorizonPiece.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include <dspace/horizon/EdgeCrossings.h>
#include <dspace/horizon/EdgeRuns.h>
#include <dspace/horizon/HorizonKernel.h>
#include <dspace/horizon/HorizonPath.h>
#include <dspace/horizon/SweptPosts.h>

namespace dspace {
namespace {

constexpr int Band = 32;              // posts of distance that share what is read
constexpr double FarBand = 0.5;       // of the distance, where posts are held and paths straight
constexpr double FarRun = 128.0;      // posts away, from where on runs are longer
constexpr double RunPosts = 8.0;      // of edges whose heights are bounded together
constexpr double PerPost = 2.0;       // places of a coarser level in a post
constexpr double Widest = 2048;       // columns that are read at once
constexpr double WidestFine = 131072; // the same about a pole, with HorizonOptions::fine
constexpr double Polar = 87.0 * M_PI / 180.0; // latitude [rad] from which columns crowd
constexpr float Infinite = std::numeric_limits<float>::infinity();

// A place of the path of a row's first post, in posts of a level.
struct Knot {
  double x;
  double y;
  double s; // [m]
  HorizonPath::Point ground;
};

// Between two knots; `bend` [1/m]: the curvature of the ground's fall.
HorizonStep StepBetween(const Knot& a, const Knot& b, double t, double bend) {
  const auto mix = [t](double from, double to) { return from + t * (to - from); };
  const double length = b.s - a.s;
  return {float(mix(a.ground.fall, b.ground.fall) + 0.5 * bend * t * (1.0 - t) * length * length),
          float(mix(a.ground.rise, b.ground.rise)), float(mix(a.ground.away, b.ground.away)),
          float(mix(a.ground.spread, b.ground.spread))};
}

// At most HorizonLanes x HorizonRows posts of a level.
class Piece {
public:
  // `every`: posts of the level between lanes, and between rows.
  Piece(const HorizonSweep& sweep, const PostBlock& block, int every, double azimuth,
        double seconds, HorizonReport& report)
      : Sweep_(sweep), Placement_(sweep.Placement()), Pyramid_(*sweep.Pyramid()),
        Lattice_(sweep.Pyramid()->Lattice()), Block_(block), Every_(every), Deadline_(Clock::now()),
        Seconds_(seconds), Report_(report) {
    this->Spacing_ = std::ldexp(1.0, block.level);
    this->Lane_ = this->Placement_.GetKind() == PostPlacement::Kind::Pole
                      ? 0.5 * (block.width - 1) * every
                      : 0.0;
    const Eigen::Vector2d middle(
        double(this->Lattice_.ColumnPlace(block.level, block.column)) +
            0.5 * this->Spacing_ * block.width * every,
        double(this->Lattice_.RowPlace(block.level,
                                       block.row + std::int64_t(block.height / 2) * every)));
    this->Cell_ = this->Placement_.CellSize(middle);
    this->Metres_ = this->MetresOf(block.level);
    this->Slack_ = sweep.Options().fast ? HorizonOptions::FastSlack : 0.0f;
    for (int j = 0; j < block.height; ++j) {
      this->Starts_.emplace_back(
          double(this->Lattice_.ColumnPlace(block.level, block.column)),
          double(this->Lattice_.RowPlace(block.level, block.row + std::int64_t(j) * every)));
      this->Paths_.emplace_back(
          this->Placement_,
          this->Starts_.back() + Eigen::Vector2d(this->Lane_ * this->Spacing_, 0.0), azimuth);
    }
    if (this->Placement_.OnBody()) {
      const BodyEllipsoid& body = this->Placement_.Body();
      this->Bend_ = 1.0 / this->Placement_.Radius();
      this->Flattest_ = body.Equatorial() / (1.0 - body.Squash()); // no curvature is less
    }
  }

  // `stride`: of the results' rows.
  void Run(float* all, float* distant, std::size_t stride) {
    this->ReadPosts();
    if (this->Least_ > this->Greatest_) {
      this->Write(all, stride, this->Tangents_, this->Tangents_);
      if (distant) {
        this->Write(distant, stride, this->Tangents_, this->Tangents_);
      }
      return;
    }
    const HorizonOptions& options = this->Sweep_.Options();
    const double end = this->Reach();
    const double near = options.near * this->MetresOf(this->Block_.level);
    std::vector<float> close; // what is found in the near zone, once it is over
    int level = this->Block_.level;
    const double held = distant ? 0.0 : this->MarchHeldRows(near, end);
    for (double s = held; s < end;) {
      while (level < this->Lattice_.levels - 1 &&
             s >= (options.posts - 1e-6) * this->MetresOf(level)) {
        ++level;
      }
      const double to = this->BandEnd(s, near, level);
      const bool hidden = s > 0.0 && this->NothingHigherFrom(s, this->Tangents_.data(),
                                                             int(this->Tangents_.size()));
      if (s >= near && hidden) {
        break;
      }
      if (!hidden && !this->March(level, s, std::min(to, end))) {
        break;
      }
      s = to;
      if (distant && s == near) {
        close = this->Tangents_;
        this->Clear();
      }
    }
    if (!distant) {
      this->Write(all, stride, this->Tangents_, this->Tangents_);
      return;
    }
    if (close.empty()) { // the end came before
      close = this->Tangents_;
      this->Clear();
    }
    this->Write(distant, stride, this->Tangents_, this->Tangents_);
    this->Write(all, stride, this->Tangents_, close);
  }

private:
  using Clock = std::chrono::steady_clock;

  // [m] Ground from s to there shares what is read.
  double BandEnd(double s, double near, int level) const {
    const double band = Band * this->MetresOf(level);
    const bool even = this->Placement_.OnBody() || !this->Sweep_.Held();
    const double to = s + (even ? band : std::max(band, FarBand * s));
    return s < near ? std::min(to, near) : to;
  }

  double MetresOf(int level) const { return std::ldexp(this->Cell_, level); }

  double Left() const {
    return std::max(0.0, this->Seconds_ -
                             std::chrono::duration<double>(Clock::now() - this->Deadline_).count());
  }

  void ReadQuietly(SweptPosts& ground) {
    const PostBlock& place = ground.place;
    ground.heights.resize(std::size_t(place.width) * place.height);
    this->Pyramid_.Read(place, ground.heights.data(), this->Left());
  }

  void Read(SweptPosts& ground) {
    this->ReadQuietly(ground);
    this->Report_.read.push_back(ground.place);
  }

  void ReadPosts() {
    SweptPosts ground;
    ground.place = this->Block_;
    ground.place.width = (this->Block_.width - 1) * this->Every_ + 1;
    ground.place.height = (this->Block_.height - 1) * this->Every_ + 1;
    this->Read(ground);
    const auto above = float(this->Sweep_.Options().above);
    this->Heights_.assign(std::size_t(HorizonRows) * HorizonLanes, 0.0f);
    this->Valid_.assign(this->Heights_.size(), 0);
    for (int j = 0; j < this->Block_.height; ++j) {
      float sum = 0.0f;
      int count = 0;
      for (int i = 0; i < this->Block_.width; ++i) {
        const float h = ground.heights[std::size_t(j) * this->Every_ * ground.place.width +
                                       std::size_t(i) * this->Every_] +
                        above;
        if (!std::isnan(h)) {
          const std::size_t at = std::size_t(j) * HorizonLanes + i;
          this->Heights_[at] = h;
          this->Valid_[at] = 1;
          this->Least_ = std::min(this->Least_, h);
          this->Greatest_ = std::max(this->Greatest_, h);
          sum += h;
          ++count;
        }
      }
      this->Bases_.push_back(sum / float(std::max(count, 1)));
    }
    const auto [low, high] = this->Sweep_.Options().heights;
    this->Span_ = {std::min(float(low), this->Least_), std::max(float(high), this->Greatest_)};
    this->Clear();
  }

  // Posts without data are never below a horizon.
  void Clear() {
    this->Tangents_.resize(this->Heights_.size());
    for (std::size_t k = 0; k < this->Tangents_.size(); ++k) {
      this->Tangents_[k] = this->Valid_[k] ? HorizonSweep::None : Infinite;
    }
  }

  void Write(float* out, std::size_t stride, const std::vector<float>& a,
             const std::vector<float>& b) const {
    for (int j = 0; j < this->Block_.height; ++j) {
      for (int i = 0; i < this->Block_.width; ++i) {
        const std::size_t at = std::size_t(j) * HorizonLanes + i;
        out[std::size_t(j) * stride + i] =
            this->Valid_[at] ? std::max(a[at], b[at]) : std::numeric_limits<float>::quiet_NaN();
      }
    }
  }

  // [m] beyond which nothing can be seen.
  double Reach() const {
    const auto [low, high] = this->Sweep_.Options().heights;
    if (!this->Placement_.OnBody()) {
      const Eigen::Vector2d last(double(this->Lattice_.columns), double(this->Lattice_.rows));
      const Eigen::Matrix2d& linear = this->Placement_.PostToScene().linear();
      return linear.col(0).norm() * last.x() + linear.col(1).norm() * last.y();
    }
    const double ground = this->Flattest_ + std::min<double>(low, this->Least_);
    const auto dip = [&](double height) {
      return std::acos(std::clamp(ground / (this->Flattest_ + height), -1.0, 1.0));
    };
    const double angle = dip(this->Greatest_) + dip(std::max<double>(high, this->Greatest_));
    return std::min(angle, HorizonFarthest) * this->Flattest_ +
           2.0 * this->MetresOf(this->Block_.level);
  }

  // Whether the terrain's greatest height could not raise any of `count` tangents from there on.
  bool NothingHigherFrom(double s, const float* tangents, int count) const {
    const float low = LeastOf(tangents, count);
    if (low == HorizonSweep::None) {
      return false;
    }
    const double least = double(low) + this->Slack_;
    const double high = std::max<double>(this->Sweep_.Options().heights[1], this->Greatest_);
    if (!this->Placement_.OnBody()) {
      return (high - this->Least_) / s <= least;
    }
    // (cos a - k) / sin a falls with the distance for k < 1, else from cos a = 1 / k on.
    const double k = (this->Flattest_ + this->Least_) / (this->Flattest_ + high);
    const double angle = s / this->Flattest_;
    return (std::cos(angle) - k) / std::sin(angle) <= least;
  }

  // Places of the path of row j's first lane from s0 to s1 [m], in posts of the level.
  void Follow(int j, int level, double s0, double s1, std::vector<Knot>& knots) const {
    if (this->Placement_.OnBody() && this->Sweep_.Options().fine) {
      this->FollowFinely(j, level, s0, s1, knots);
      return;
    }
    int count = 1;
    if (this->Placement_.OnBody()) {
      const double posts = (s1 - s0) / this->MetresOf(level);
      const Eigen::Vector2d angles = this->Placement_.Angles(this->Starts_[std::size_t(j)]);
      const bool steep = this->Placement_.GetKind() == PostPlacement::Kind::Sphere &&
                         8.0 * this->MetresOf(level) * std::abs(std::tan(angles.y())) >
                             0.02 * this->Placement_.Radius();
      count = std::max(1, int(std::ceil(posts / (steep ? 1.0 : 8.0))));
    }
    knots.clear();
    for (int k = 0; k <= count; ++k) {
      knots.push_back(this->KnotAt(j, level, s0 + (s1 - s0) * k / count));
    }
  }

  Knot KnotAt(int j, int level, double s) const {
    const double scale = std::ldexp(1.0, -level);
    Knot knot;
    knot.s = s;
    knot.ground = this->Paths_[std::size_t(j)].At(s);
    knot.x = (knot.ground.post.x() - this->Lane_ * this->Spacing_) * scale;
    knot.y = knot.ground.post.y() * scale;
    return knot;
  }

  void FollowFinely(int j, int level, double s0, double s1, std::vector<Knot>& knots) const {
    const double post = this->MetresOf(level);
    knots.clear();
    knots.push_back(this->KnotAt(j, level, s0));
    for (double s = s0; s < s1;) {
      s += this->Paths_[std::size_t(j)].FineStep(knots.back().ground, s, post);
      s = s > s1 - 0.005 * post ? s1 : s;
      knots.push_back(this->KnotAt(j, level, s));
    }
  }

  // What the paths may meet between two distances, in posts of a level. Near a pole of a degree
  // grid that is no box: false.
  bool FindBox(int level, double s0, double s1, PostBlock& box) const {
    double left = std::numeric_limits<double>::infinity();
    double top = left;
    double right = -left;
    double bottom = -left;
    const bool curved = this->Placement_.OnBody();
    const bool sphere = this->Placement_.GetKind() == PostPlacement::Kind::Sphere;
    const double scale = std::ldexp(1.0, -level);
    for (const int j : {0, this->Block_.height / 2, this->Block_.height - 1}) {
      for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        if (!curved && t > 0.0 && t < 1.0) {
          continue;
        }
        const Eigen::Vector2d post = this->Paths_[std::size_t(j)].At(s0 + t * (s1 - s0)).post;
        if (sphere && std::abs(this->Placement_.Angles(post).y()) > Polar) {
          return this->Sweep_.Options().fine && this->FindPolarBox(level, s0, s1, box);
        }
        const double x = (post.x() - this->Lane_ * this->Spacing_) * scale;
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, post.y() * scale);
        bottom = std::max(bottom, post.y() * scale);
      }
    }
    if (right - left > Widest) {
      return this->Sweep_.Options().fine && sphere && this->FindPolarBox(level, s0, s1, box);
    }
    this->PutBox(level, {left, top, right, bottom}, curved ? 4 : 2, box);
    return true;
  }

  // `range`: least x and y, greatest x and y of the first lanes, in posts of the level.
  void PutBox(int level, const std::array<double, 4>& range, int margin, PostBlock& box) const {
    const int lanes = this->Lanes(level);
    box.level = level;
    box.column = std::int64_t(std::floor(range[0])) - margin;
    box.row = std::int64_t(std::floor(range[1])) - margin;
    box.width = int(std::int64_t(std::floor(range[2])) + margin + 3 + lanes - box.column);
    box.height = int(std::int64_t(std::floor(range[3])) + margin + 2 - box.row);
    if (level == this->Block_.level && this->Every_ > 1) { // SweptPosts::Part
      box.width += (this->Every_ - box.width % this->Every_) % this->Every_;
    }
  }

  // Posts of the level that the lanes reach over.
  int Lanes(int level) const { return int(std::ceil(this->LaneOf(level) * float(HorizonLanes))); }
  float LaneOf(int level) const {
    return std::ldexp(float(this->Every_), this->Block_.level - level);
  }

  // The longitude of a great circle goes one way: its ends are its least and greatest column.
  bool FindPolarBox(int level, double s0, double s1, PostBlock& box) const {
    constexpr int Places = 32;
    const double scale = std::ldexp(1.0, -level);
    const double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 4> range = {infinity, infinity, -infinity, -infinity};
    for (const HorizonPath& path : this->Paths_) {
      for (int i = 0; i <= Places; ++i) {
        const Eigen::Vector2d post = path.At(s0 + (s1 - s0) * i / Places).post;
        const double x = (post.x() - this->Lane_ * this->Spacing_) * scale;
        const double y = post.y() * scale;
        range = {std::min(range[0], x), std::min(range[1], y), std::max(range[2], x),
                 std::max(range[3], y)};
      }
    }
    if (range[2] - range[0] > WidestFine) {
      return false;
    }
    this->PutBox(level, range, 4, box);
    return true;
  }

  bool IsOutside(const PostBlock& box) const {
    return box.row >= this->Lattice_.RowsAt(box.level) || box.row + box.height <= 0 ||
           (!this->Lattice_.periodic &&
            (box.column >= this->Lattice_.ColumnsAt(box.level) || box.column + box.width <= 0));
  }

  // The posts that are held, if they are those of the block.
  const HeldPosts* Held() const {
    const HeldPosts* held = this->Sweep_.Held();
    return this->Block_.level == 0 && held && held->Every() == this->Every_ ? held : nullptr;
  }

  // Its posts; false where it is outside the lattice.
  bool ReadBox(SweptPosts& ground) {
    const int level = ground.place.level;
    const std::int64_t columns = this->Lattice_.ColumnsAt(level);
    const std::int64_t rows = this->Lattice_.RowsAt(level);
    if (this->IsOutside(ground.place)) {
      return false;
    }
    const HeldPosts* held = this->Held();
    if (level == 0 && held) {
      ground.span = held->SpanOf(ground.place);
      ground.held = held;
      ground.place = held->Place();
      return true;
    }
    this->Read(ground);
    if (level > this->Block_.level) {
      this->HoldEdges(ground, columns, rows);
    } else if (this->Every_ > 1) {
      ground.every = this->Every_;
      ground.Part();
    }
    ground.span = SpanOf(ground.heights);
    return true;
  }

  // Places on a coarse level's last column and row have a cell to lie in.
  void HoldEdges(SweptPosts& ground, std::int64_t columns, std::int64_t rows) const {
    const PostBlock& place = ground.place;
    if (!this->Lattice_.periodic && columns > place.column &&
        columns < place.column + place.width) {
      for (std::int64_t r = place.row; r < place.row + place.height; ++r) {
        ground.heights[std::size_t(ground.At(columns, r))] =
            ground.heights[std::size_t(ground.At(columns - 1, r))];
      }
    }
    if (rows > place.row && rows < place.row + place.height) {
      std::copy_n(ground.heights.begin() + ground.At(place.column, rows - 1), place.width,
                  ground.heights.begin() + ground.At(place.column, rows));
    }
  }

  // Groups of lanes, a bit each.
  using Groups = unsigned;
  static constexpr int GroupCount = HorizonLanes / HorizonGroup;

  // Those that hold posts of the block.
  Groups AllGroups() const {
    return (1u << ((this->Block_.width + HorizonGroup - 1) / HorizonGroup)) - 1u;
  }

  // Of `groups` of row j, those whose horizon may be raised by ground between posts of level 0,
  // which are those of lane 0.
  Groups MayRaiseBy(int j, const SweptPosts& ground, const PostExtent& posts,
                    const GroundBounds& bounds, const LaneReach& reach, Groups groups) const {
    GroupCrests crests;
    crests.fill(-Infinite);
    for (int g = 0; g < GroupCount; ++g) {
      if (!(groups & 1u << g)) {
        continue;
      }
      const PostBlock seen = {0, posts.left + std::int64_t(g) * HorizonGroup * this->Every_,
                              posts.top,
                              int(posts.right - posts.left) + 1 + (HorizonGroup - 1) * this->Every_,
                              int(posts.bottom - posts.top) + 1};
      crests[std::size_t(g)] = bounds.Crest(ground.held->GreatestOf(seen));
    }
    return this->MayRaise(j, crests, reach);
  }

  Groups MayRaise(int j, const GroupCrests& crests, const LaneReach& reach) const {
    const std::size_t at = std::size_t(j) * HorizonLanes;
    return dspace::MayRaise(crests, reach, this->Slack_, &this->Heights_[at], &this->Tangents_[at]);
  }

  // The same for ground between knots.
  Groups MayRaiseBetween(int j, const SweptPosts& ground, const std::vector<Knot>& knots) const {
    GroundBounds bounds;
    for (const Knot* knot : {&knots.front(), &knots.back()}) {
      const HorizonPath::Point& at = knot->ground;
      bounds.Add({float(at.fall), float(at.rise), float(at.away), float(at.spread)});
    }
    const LaneReach reach = bounds.Reach(this->Span_);
    if (!ground.held) {
      GroupCrests crests;
      crests.fill(bounds.Crest(ground.span.greatest));
      return this->MayRaise(j, crests, reach);
    }
    PostExtent posts;
    for (const Knot& knot : knots) {
      posts.Add(FloorOf(knot.x), FloorOf(knot.y));
      posts.Add(FloorOf(knot.x) + 1, FloorOf(knot.y) + 1);
    }
    return this->MayRaiseBy(j, ground, posts, bounds, reach, this->AllGroups());
  }

  // A place at a time, of which all lanes are read: where columns crowd.
  void MarchPlaces(int level, double s0, double s1) {
    const int count = std::max(1, int(std::lround(4.0 * (s1 - s0) / this->MetresOf(level))));
    const float lane = this->LaneOf(level);
    const double scale = std::ldexp(1.0, -level);
    const double end = double(this->Lattice_.RowsAt(level) - 2);
    SweptPosts ground;
    ground.place.level = level;
    ground.place.width = int(std::ceil(lane * float(HorizonLanes))) + 3;
    ground.place.height = 2;
    std::vector<CellStep> cells(1);
    std::int64_t top = std::numeric_limits<std::int64_t>::max();
    std::int64_t bottom = 0;
    for (int j = 0; j < this->Block_.height; ++j) {
      for (int i = 1; i <= count; ++i) {
        const HorizonPath::Point p = this->Paths_[std::size_t(j)].At(s0 + (s1 - s0) * i / count);
        const double x = p.post.x() * scale;
        const double r = std::clamp(std::floor(p.post.y() * scale), 0.0, end);
        ground.place.column = std::int64_t(std::floor(x));
        ground.place.row = std::int64_t(r);
        this->ReadQuietly(ground);
        top = std::min(top, ground.place.row);
        bottom = std::max(bottom, ground.place.row + 2);
        cells[0] = {{float(p.fall), float(p.rise), float(p.away), float(p.spread)},
                    0,
                    float(x - std::floor(x)),
                    float(p.post.y() * scale - r)};
        MarchCells(cells, ground.heights.data(), ground.place.width, lane,
                   &this->Heights_[std::size_t(j) * HorizonLanes],
                   &this->Tangents_[std::size_t(j) * HorizonLanes]);
      }
    }
    this->Report_.read.push_back(
        {level, 0, top, int(this->Lattice_.ColumnsAt(level)), int(bottom - top)});
    this->Report_.steps += std::uint64_t(count) * this->Block_.height * HorizonLanes;
  }

  // False where the paths have left the data for good.
  bool March(int level, double s0, double s1) {
    SweptPosts ground;
    if (!this->FindBox(level, s0, s1, ground.place)) {
      this->MarchPlaces(level, s0, s1);
      return true;
    }
    if (!this->ReadBox(ground)) {
      // On a plane and in a periodic grid what is outside stays outside, but a great circle may
      // come back.
      return this->Placement_.OnBody() || s0 == 0.0;
    }
    if (!(ground.span.least <= ground.span.greatest)) {
      return true;
    }
    std::vector<Knot> knots;
    std::vector<CellStep> cells;
    std::optional<std::int64_t> runsRow; // the row that the runs are of, on a plane
    for (int j = 0; j < this->Block_.height; ++j) {
      this->Follow(j, level, s0, s1, knots);
      Groups groups = this->AllGroups();
      if (s0 > 0.0) {
        groups = this->MayRaiseBetween(j, ground, knots);
      }
      if (!groups) {
        this->Report_.skipped +=
            std::uint64_t(HorizonLanes * PerPost * (s1 - s0) / this->MetresOf(level));
        continue;
      }
      float* tangents = &this->Tangents_[std::size_t(j) * HorizonLanes];
      const float* z = &this->Heights_[std::size_t(j) * HorizonLanes];
      if (level > this->Block_.level) {
        cells.clear();
        this->AddCells(ground, level, knots, cells);
        MarchCells(cells, ground.heights.data(), ground.place.width, this->LaneOf(level), z,
                   tangents);
        this->Report_.steps += cells.size() * HorizonLanes;
        continue;
      }
      if (!this->IsRegular(j)) {
        this->MarchParts(j, ground, knots, groups);
        continue;
      }
      if (!runsRow) {
        this->FindRuns(ground, knots, this->Runs_);
        runsRow = this->RowOf(j);
      }
      this->MarchRuns(j, ground, this->Runs_, this->RowOf(j) - *runsRow, s0 > 0.0, groups);
    }
    return true;
  }

  std::int64_t RowOf(int j) const { return this->Block_.row + std::int64_t(j) * this->Every_; }
  // Whether the path of a row is that of the others, shifted by posts.
  bool IsRegular(int j) const {
    return this->Placement_.GetKind() == PostPlacement::Kind::Plane &&
           this->Starts_[std::size_t(j)].y() == double(this->RowOf(j)) * this->Spacing_;
  }

  // A band of distance over posts that are held.
  struct HeldBand {
    double s0;
    double s1;
    bool outside;
    EdgeRuns runs;
    std::optional<std::int64_t> row; // that the runs are of
  };
  // Where a group of a row was raised last: the ground that it sees, or nearly so.
  struct Sight {
    HeldBand* band = nullptr;
    std::size_t run = 0;
    bool operator==(const Sight& other) const {
      return this->band == other.band && this->run == other.run;
    }
  };
  // The latest first: lanes along a path see the same crest at other distances.
  static constexpr int SightCount = 3;
  using Sights = std::array<std::array<Sight, GroupCount>, SightCount>;

  // Marches over posts of level 0 that are held, a regular row after the other. Each begins with
  // what the row before saw: most of the rest cannot raise its horizon then. Returns the distance
  // [m] up to which that is done; 0 where it is not: on a body it takes longer than it saves.
  double MarchHeldRows(double near, double end) {
    bool regular = this->Held() != nullptr;
    for (int j = 0; j < this->Block_.height; ++j) {
      regular = regular && this->IsRegular(j);
    }
    if (!regular) {
      return 0.0;
    }
    std::vector<HeldBand> bands;
    const double last = (this->Sweep_.Options().posts - 1e-6) * this->Metres_;
    double done = 0.0;
    while (done < end && done < last) {
      const double to = this->BandEnd(done, near, 0);
      PostBlock box;
      if (!this->FindBox(0, done, std::min(to, end), box)) {
        return 0.0;
      }
      bands.push_back({done, std::min(to, end), this->IsOutside(box), {}, {}});
      done = to;
      if (bands.back().outside && bands.back().s0 > 0.0) {
        done = end; // what is outside stays outside
      }
    }
    SweptPosts ground;
    ground.held = this->Held();
    ground.place = ground.held->Place();
    Sights before;
    for (int j = 0; j < this->Block_.height; ++j) {
      Sights now;
      this->Seen_ = &now;
      this->MarchSights(j, ground, before);
      this->MarchBands(j, ground, bands);
      before = now;
    }
    this->Seen_ = nullptr;
    return done;
  }

  void MarchBands(int j, const SweptPosts& ground, std::vector<HeldBand>& bands) {
    const float* tangents = &this->Tangents_[std::size_t(j) * HorizonLanes];
    for (HeldBand& band : bands) {
      if (band.outside) {
        continue;
      }
      if (band.s0 > 0.0 && this->NothingHigherFrom(band.s0, tangents, HorizonLanes)) {
        return;
      }
      this->Band_ = &band;
      this->Follow(j, 0, band.s0, band.s1, this->Knots_);
      const Groups groups =
          band.s0 > 0.0 ? this->MayRaiseBetween(j, ground, this->Knots_) : this->AllGroups();
      if (!groups) {
        this->Report_.skipped +=
            std::uint64_t(HorizonLanes * PerPost * (band.s1 - band.s0) / this->Metres_);
        continue;
      }
      if (!band.row) {
        this->FindRuns(ground, this->Knots_, band.runs);
        band.row = this->RowOf(j);
      }
      this->MarchRuns(j, ground, band.runs, this->RowOf(j) - *band.row, band.s0 > 0.0, groups);
    }
  }

  void MarchSights(int j, const SweptPosts& ground, const Sights& sights) {
    for (const std::array<Sight, GroupCount>& each : sights) {
      Groups left = this->AllGroups();
      for (int g = 0; g < GroupCount; ++g) {
        const Sight& sight = each[std::size_t(g)];
        Groups same = 0;
        for (int k = g; k < GroupCount; ++k) {
          same |= each[std::size_t(k)] == sight ? left & 1u << k : 0u;
        }
        left &= ~same;
        if (sight.band && same) {
          this->Band_ = sight.band;
          this->MarchRun(j, ground, sight.band->runs, sight.run, this->RowOf(j) - *sight.band->row,
                         same);
        }
      }
    }
  }

  // [m] of a path whose edges are bounded together.
  double RunFrom(double s) const {
    const double sparse = this->Sweep_.Options().fast ? 0.5 * HorizonOptions::FastExact : FarRun;
    return RunPosts * std::max(this->Metres_, s / sparse);
  }

  // Finds the edges of a path of its own only where they may count.
  void MarchParts(int j, const SweptPosts& ground, const std::vector<Knot>& knots, Groups groups) {
    for (std::size_t a = 0; a + 1 < knots.size();) {
      const double enough = 0.75 * this->RunFrom(knots[a].s);
      std::size_t b = a + 1;
      while (b + 1 < knots.size() && knots[b].s - knots[a].s < enough) {
        ++b;
      }
      this->Part_.assign(knots.begin() + std::ptrdiff_t(a), knots.begin() + std::ptrdiff_t(b) + 1);
      Groups raised = groups;
      if (knots[a].s > 0.0 && ground.held) {
        raised &= this->MayRaiseBetween(j, ground, this->Part_);
      }
      if (raised) {
        this->FindRuns(ground, this->Part_, this->Runs_);
        this->MarchRuns(j, ground, this->Runs_, 0, this->Runs_.Runs().size() > 1, raised);
      } else {
        this->Report_.skipped +=
            std::uint64_t(HorizonLanes * PerPost * (knots[b].s - knots[a].s) / this->Metres_);
      }
      a = b;
    }
  }

  // The runs, `down` rows below those that they are of. `far`: not all of the first run counts.
  void MarchRuns(int j, const SweptPosts& ground, const EdgeRuns& runs, std::int64_t down, bool far,
                 Groups groups) {
    for (std::size_t k = 0; k < runs.Runs().size(); ++k) {
      const EdgeRuns::Run& run = runs.Runs()[k];
      if (run.edges.empty()) {
        continue;
      }
      Groups raised = groups;
      if (ground.held && (far || k > 0)) {
        PostExtent posts = run.posts;
        posts.top += down;
        posts.bottom += down;
        raised = this->MayRaiseBy(j, ground, posts, run.ground, run.reach, groups);
      }
      if (raised) {
        this->MarchRun(j, ground, runs, k, down, raised);
      } else {
        this->Report_.skipped += run.edges.size() * HorizonLanes;
      }
    }
  }

  void See(std::size_t group, const Sight& sight) {
    Sights& seen = *this->Seen_;
    for (int k = 0; k < SightCount; ++k) {
      if (seen[std::size_t(k)][group] == sight) {
        return;
      }
    }
    for (std::size_t k = SightCount - 1; k > 0; --k) {
      seen[k][group] = seen[k - 1][group];
    }
    seen[0][group] = sight;
  }

  void MarchRun(int j, const SweptPosts& ground, const EdgeRuns& runs, std::size_t index,
                std::int64_t down, Groups groups) {
    const EdgeRuns::Run& run = runs.Runs()[index];
    const float* heights = ground.Heights() +
                           ground.At(ground.place.column, ground.place.row + down) -
                           ground.At(ground.place.column, ground.place.row);
    const float* z = &this->Heights_[std::size_t(j) * HorizonLanes];
    float* tangents = &this->Tangents_[std::size_t(j) * HorizonLanes];
    std::array<float, HorizonLanes> before;
    std::copy_n(tangents, HorizonLanes, before.begin());
    if (this->Sweep_.Options().fast) {
      MarchEdgesFast(run.edges, groups, this->Bases_[std::size_t(j)], heights, z, tangents);
    } else {
      MarchEdges(run.edges, groups, heights, z, tangents);
    }
    for (int g = 0; g < GroupCount; ++g) {
      const bool marched = (groups & 1u << g) != 0;
      (marched ? this->Report_.steps : this->Report_.skipped) += run.edges.size() * HorizonGroup;
      const std::ptrdiff_t lane = std::ptrdiff_t(g) * HorizonGroup;
      if (this->Seen_ && marched &&
          std::memcmp(tangents + lane, before.data() + lane, HorizonGroup * sizeof(float)) != 0) {
        this->See(std::size_t(g), {this->Band_, index});
      }
    }
  }

  // The edges of the level's triangles that a row crosses between its knots.
  void FindRuns(const SweptPosts& ground, const std::vector<Knot>& knots, EdgeRuns& runs) const {
    constexpr double Snap = 1e-6; // posts
    const double s0 = knots.front().s;
    const double s1 = knots.back().s;
    runs.Clear(std::max(1, int((s1 - s0) / this->RunFrom(s0))), s0, s1);
    const double least = 1e-6 * this->MetresOf(this->Block_.level);
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
      const Knot& a = knots[k];
      const Knot& b = knots[k + 1];
      const double dx = b.x - a.x;
      const double dy = b.y - a.y;
      const auto add = [&](double t, std::int64_t c, std::int64_t r, int right, int down,
                           double share) {
        if (a.s + t * (b.s - a.s) < least) {
          return;
        }
        if (this->Sweep_.Options().fast &&
            !this->Counts(a.s + t * (b.s - a.s), std::abs(dx) >= std::abs(dy), c, r, right, down)) {
          return;
        }
        // The other end may lie outside the data: on a post it does not count.
        const std::ptrdiff_t first = ground.At(c, r);
        const std::ptrdiff_t second = ground.At(c + right, r + down);
        if (ground.Has(c, r, (HorizonLanes - 1) * this->Every_)) {
          runs.Add(a.s + t * (b.s - a.s),
                   {StepBetween(a, b, t, this->Bend_), share > 1.0 - Snap ? second : first,
                    share < Snap ? first : second, float(share)},
                   c, r, right, down);
        }
      };
      // Near a pole a step along a parallel crosses any number of columns.
      const double posts = (b.s - a.s) / this->MetresOf(this->Block_.level);
      if (!this->Sweep_.Options().fine && std::abs(dx) > 16.0 * posts + 16.0) {
        const int count = std::max(2, int(4.0 * posts));
        for (int i = 1; i <= count; ++i) {
          const double t = double(i) / count;
          const double y = a.y + t * dy;
          const auto c = std::int64_t(std::llround(a.x + t * dx));
          const auto r = std::int64_t(std::floor(y));
          add(t, c, r, 0, 1, y - double(r));
        }
        continue;
      }
      ForEachCrossing(a.x, a.y, b.x, b.y, add);
    }
    runs.Close(this->Span_);
  }

  // With HorizonOptions::fast: whether an edge that is crossed at a distance [m] counts. Of distant
  // ones only those between columns, or between rows, that lie steps apart. `across`: columns.
  bool Counts(double s, bool across, std::int64_t c, std::int64_t r, int right, int down) const {
    const double posts = s / (HorizonOptions::FastExact * this->Metres_);
    if (posts < 1.0) {
      return true;
    }
    if (across ? right != 0 : down != 0) {
      return false;
    }
    std::int64_t step = 1;
    while (2.0 * double(step) <= posts) {
      step *= 2;
    }
    return ((across ? c : r) & (step - 1)) == 0;
  }

  // Places of a row on a coarser level.
  void AddCells(const SweptPosts& ground, int level, const std::vector<Knot>& knots,
                std::vector<CellStep>& cells) const {
    const int lanes = this->Lanes(level);
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
      const Knot& a = knots[k];
      const Knot& b = knots[k + 1];
      const int count =
          std::max(1, int(std::lround(PerPost * (b.s - a.s) / this->MetresOf(level))));
      for (int i = 1; i <= count; ++i) {
        const double t = double(i) / count;
        const double x = a.x + t * (b.x - a.x);
        const double y = a.y + t * (b.y - a.y);
        const double c = std::floor(x);
        const double r = std::floor(y);
        if (ground.Has(std::int64_t(c), std::int64_t(r), lanes)) {
          cells.push_back({StepBetween(a, b, t, this->Bend_),
                           ground.At(std::int64_t(c), std::int64_t(r)), float(x - c),
                           float(y - r)});
        }
      }
    }
  }

  const HorizonSweep& Sweep_;
  const PostPlacement& Placement_;
  ElevationPyramid& Pyramid_;
  const PostLattice& Lattice_;
  PostBlock Block_;
  int Every_;
  Clock::time_point Deadline_; // counted from then
  double Seconds_;
  HorizonReport& Report_;
  double Spacing_ = 1.0; // level-0 posts between lanes
  double Lane_ = 0.0;    // from the first to the one whose path is followed
  double Cell_ = 1.0;    // [m] of level 0
  double Metres_ = 1.0;  // [m] of the block's level
  float Slack_ = 0.0f;   // of tangents
  double Bend_ = 0.0;
  double Flattest_ = 0.0;
  std::vector<Eigen::Vector2d> Starts_; // the first post of each row, level-0 posts
  std::vector<HorizonPath> Paths_;
  std::vector<float> Heights_; // rows of HorizonLanes
  std::vector<char> Valid_;
  std::vector<float> Tangents_;
  std::vector<float> Bases_; // the mean height of each row
  EdgeRuns Runs_;
  std::vector<Knot> Knots_; // of a path
  std::vector<Knot> Part_;
  HeldBand* Band_ = nullptr;       // that is marched over
  Sights* Seen_ = nullptr;         // of the row that is marched, if that is of use
  HeightSpan Span_ = {0.0f, 0.0f}; // that all ground lies between
  float Least_ = Infinite;
  float Greatest_ = -Infinite;
};

} // namespace

void SweepPiece(const HorizonSweep& sweep, const PostBlock& block, int every, double azimuth_deg,
                double seconds, HorizonReport& report, float* all, float* distant,
                std::size_t stride) {
  Piece piece(sweep, block, every, azimuth_deg, seconds, report);
  piece.Run(all, distant, stride);
}

} // namespace dspace
