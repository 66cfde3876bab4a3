#include <dspace/tracks/TrackPosts.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <dspace/pyramid/ElevationPyramid.h>

#include <dspace/raster/LruCache.h>
#include <dspace/tracks/TrackMap.h>
#include <dspace/tracks/TrackProbe.h>

namespace dspace {
namespace {

constexpr int Size = ElevationPyramid::TileSize;
constexpr std::size_t KeptTiles = 128; // 64 KiB each
constexpr int MaximumPlaces = 8;       // along a side of a cell
constexpr double Widest = 4.0;         // rut widths that posts may be apart

// Depths at places within the cells of a block, where there are any.
class Canvas {
public:
  // `places` along a side of each cell; 1 is the post's own.
  Canvas(const PostLattice& lattice, const PostBlock& block, int places)
      : Lattice_(lattice), Block_(block), Places_(places),
        First_(std::size_t(block.width) * block.height, None) {}

  // `heights` are those of the ground, without tracks.
  void Draw(const TrackSegment& segment, const TrackMap& map, const float* heights);
  // Lowers heights and sets weights.
  void Apply(float* heights, float* weights) const;

private:
  static constexpr std::size_t None = std::numeric_limits<std::size_t>::max();
  const PostLattice& Lattice_;
  PostBlock Block_;
  int Places_;                     // along a side
  std::vector<std::size_t> First_; // of a post's places
  std::vector<TrackDepth> Depths_;
};

void Canvas::Draw(const TrackSegment& segment, const TrackMap& map, const float* heights) {
  const double step = std::ldexp(1.0, this->Block_.level);
  const Eigen::AlignedBox2d posts =
      map.PostsIn(segment.Box(), step * (double(this->Block_.column) + 0.5 * this->Block_.width));
  const double half = this->Block_.level == 0 ? 0.0 : 0.5;
  // Posts whose cells may reach into it; the lattice's last one stands nearer than its number says.
  const auto first = [&](double place, std::int64_t from, int count) {
    return int(std::clamp(std::ceil(place / step - half) - double(from), 0.0, double(count)));
  };
  const auto end = [&](double place, std::int64_t from, int count) {
    return int(
        std::clamp(std::floor(place / step + half) + 2.0 - double(from), 0.0, double(count)));
  };
  const int left = first(posts.min().x(), this->Block_.column, this->Block_.width);
  const int right = end(posts.max().x(), this->Block_.column, this->Block_.width);
  const int top = first(posts.min().y(), this->Block_.row, this->Block_.height);
  const int bottom = end(posts.max().y(), this->Block_.row, this->Block_.height);
  const int n = this->Places_;
  for (int j = top; j < bottom; ++j) {
    const auto r = double(this->Lattice_.RowPlace(this->Block_.level, this->Block_.row + j));
    for (int i = left; i < right; ++i) {
      const auto c =
          double(this->Lattice_.ColumnPlace(this->Block_.level, this->Block_.column + i));
      std::size_t& at = this->First_[std::size_t(j) * this->Block_.width + i];
      const float height = heights[std::size_t(j) * this->Block_.width + i];
      const double scale = map.Scale({c, r}, std::isnan(height) ? 0.0 : double(height));
      for (int k = 0; k < n * n; ++k) {
        const int place[2] = {k % n, k / n};
        const double dc = n == 1 ? 0.0 : ((place[0] + 0.5) / n - 0.5) * step;
        const double dr = n == 1 ? 0.0 : ((place[1] + 0.5) / n - 0.5) * step;
        TrackDepth depth;
        if (!segment.At(map.ToTracks({c + dc, r + dr}), depth, scale)) {
          continue;
        }
        if (at == None) {
          at = this->Depths_.size();
          this->Depths_.resize(at + std::size_t(n) * n);
        }
        this->Depths_[at + std::size_t(k)].Join(depth);
      }
    }
  }
}

void Canvas::Apply(float* heights, float* weights) const {
  const std::size_t n = std::size_t(this->Places_) * this->Places_;
  for (std::size_t i = 0; i < this->First_.size(); ++i) {
    if (this->First_[i] == None || std::isnan(heights[i])) {
      continue;
    }
    double depth = 0.0;
    double weight = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      const TrackDepth& place = this->Depths_[this->First_[i] + k];
      depth += place.depth;
      weight += place.weight;
    }
    heights[i] = float(double(heights[i]) - depth / double(n));
    if (weights) {
      weights[i] = float(weight / double(n));
    }
  }
}

} // namespace

TrackPosts::TrackPosts(std::shared_ptr<const PostSource> source,
                       std::shared_ptr<const WheelTracks> tracks,
                       const Eigen::Affine2d& postToScene)
    : TrackPosts(std::move(source), std::move(tracks), PostPlacement::OnPlane(postToScene)) {}

TrackPosts::TrackPosts(std::shared_ptr<const PostSource> source,
                       std::shared_ptr<const WheelTracks> tracks, const PostPlacement& placement)
    : Source_(std::move(source)), Tracks_(std::move(tracks)), Placement_(placement),
      Tiles_(
          std::make_unique<LruCache<Key, std::shared_ptr<const std::vector<float>>>>(KeptTiles)) {}

TrackPosts::~TrackPosts() = default;

double TrackPosts::Spacing(int level) const {
  // Columns of a body crowd at its poles: its rows count.
  using Kind = PostPlacement::Kind;
  const double own = this->Placement_.GetKind() == Kind::Plane
                         ? this->Placement_.PostToScene().linear().colwise().norm().minCoeff()
                     : this->Placement_.GetKind() == Kind::Pole
                         ? 2.0 * this->Placement_.Radius() * this->Placement_.PlaneStep()
                         : this->Placement_.Radius() * std::abs(this->Placement_.Step().y());
  return std::ldexp(own, level);
}

Eigen::AlignedBox2d TrackPosts::Around(const PostBlock& block, const TrackMap& map) const {
  const double step = std::ldexp(1.0, block.level);
  const Eigen::Vector2d first(double(block.column) - 2.0, double(block.row) - 2.0);
  const Eigen::Vector2d last(double(block.column + block.width) + 1.0,
                             double(block.row + block.height) + 1.0);
  return map.BoxOf({first * step, last * step});
}

bool TrackPosts::Reaches(const PostBlock& block) const {
  const std::optional<TrackMap> map = TrackMap::Of(this->Placement_, *this->Tracks_);
  return map && this->Tracks_->Reaches(this->Around(block, *map));
}

// What reaches into the cells of its posts.
std::vector<TrackSegment> TrackPosts::Near(const PostBlock& block, const TrackMap& map,
                                           double width) const {
  return this->Tracks_->Near(this->Around(block, map), width);
}

std::unique_ptr<PostProbe> TrackPosts::MakeProbe() const {
  std::unique_ptr<PostProbe> bare = this->Source_->MakeProbe();
  if (!bare || this->Tracks_->Empty()) {
    return bare;
  }
  return std::make_unique<TrackProbe>(*this, std::move(bare));
}

std::shared_ptr<const std::vector<float>> TrackPosts::TileOf(const Key& key) const {
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    if (const auto* kept = this->Tiles_->Find(key)) {
      return *kept;
    }
  }
  auto heights = std::make_shared<std::vector<float>>(std::size_t(Size) * Size);
  this->Source_->Read({int(key[0]), key[1] * Size, key[2] * Size, Size, Size}, heights->data());
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->Tiles_->Insert(key, heights);
  return heights;
}

// From a tile that is kept where the block lies in one, as a pyramid's do.
void TrackPosts::ReadSource(const PostBlock& block, float* heights) const {
  if (block.column < 0 || block.row < 0 || block.column % Size + block.width > Size ||
      block.row % Size + block.height > Size) {
    this->Source_->Read(block, heights);
    return;
  }
  const auto tile = this->TileOf({block.level, block.column / Size, block.row / Size});
  for (int j = 0; j < block.height; ++j) {
    std::copy_n(tile->data() + (block.row % Size + j) * Size + block.column % Size, block.width,
                heights + std::size_t(j) * block.width);
  }
}

void TrackPosts::Read(const PostBlock& block, float* heights) const {
  this->ReadWithTracks(block, heights, nullptr);
}

bool TrackPosts::ReadWithTracks(const PostBlock& block, float* heights, float* tracks) const {
  const std::optional<TrackMap> map = TrackMap::Of(this->Placement_, *this->Tracks_);
  std::vector<TrackSegment> segments;
  if (map) {
    segments = this->Near(block, *map, this->Spacing(block.level) / Widest);
  }
  if (segments.empty()) {
    this->Source_->Read(block, heights);
    return false;
  }
  this->ReadSource(block, heights);
  Canvas canvas(this->GetLattice(), block, std::min(1 << std::min(block.level, 16), MaximumPlaces));
  for (const TrackSegment& segment : segments) {
    canvas.Draw(segment, *map, heights);
  }
  if (tracks) {
    std::fill_n(tracks, std::size_t(block.width) * block.height, 0.0f);
  }
  canvas.Apply(heights, tracks);
  return true;
}

void TrackPosts::Lower(const PostBlock& block, float* heights, float* tracks) const {
  const std::optional<TrackMap> map = TrackMap::Of(this->Placement_, *this->Tracks_);
  if (!map) {
    return;
  }
  Canvas canvas(this->GetLattice(), block, 1);
  for (const TrackSegment& segment : this->Near(block, *map, this->Spacing(0) / Widest)) {
    canvas.Draw(segment, *map, heights);
  }
  canvas.Apply(heights, tracks);
}

std::vector<PostRectangle> TrackPosts::RectanglesOf(const std::vector<TrackReach>& changed) const {
  const PostLattice& lattice = this->GetLattice();
  std::vector<PostRectangle> rectangles;
  const std::optional<TrackMap> map = TrackMap::Of(this->Placement_, *this->Tracks_);
  if (!map) {
    return rectangles;
  }
  for (const TrackReach& reach : changed) {
    const Eigen::AlignedBox2d posts = map->PostsIn(reach.box, 0.5 * double(lattice.columns - 1));
    const auto clamped = [](double v, std::int64_t count) {
      return std::int64_t(std::clamp(std::floor(v), -1.0, double(count)));
    };
    PostRectangle rectangle;
    if (lattice.periodic) { // they may begin in any turn
      rectangle.column = std::int64_t(std::floor(posts.min().x()));
      rectangle.width = std::min(std::int64_t(std::floor(posts.max().x())) + 2 - rectangle.column,
                                 lattice.columns);
    } else {
      rectangle.column = clamped(posts.min().x(), lattice.columns);
      rectangle.width = clamped(posts.max().x(), lattice.columns) + 2 - rectangle.column;
    }
    rectangle.row = clamped(posts.min().y(), lattice.rows);
    rectangle.height = clamped(posts.max().y(), lattice.rows) + 2 - rectangle.row;
    rectangle.levels = 0;
    while (rectangle.levels < lattice.levels &&
           this->Spacing(rectangle.levels) <= Widest * reach.width) {
      ++rectangle.levels;
    }
    rectangles.push_back(rectangle);
  }
  return rectangles;
}

} // namespace dspace
