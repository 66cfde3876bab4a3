#include <dspace/rays/RayTiles.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include <dspace/pyramid/PyramidTiles.h>

namespace dspace {
namespace {

constexpr std::size_t Kept = 256; // tiles; 110 kB each

std::shared_ptr<RayTile> ReadTile(ElevationPyramid& pyramid, const RayTiles::Key& key,
                                  double seconds) {
  auto tile = std::make_shared<RayTile>();
  tile->column = key[1] * RayTile::Cells;
  tile->row = key[2] * RayTile::Cells;
  tile->heights.resize(std::size_t(RayTile::Posts) * RayTile::Posts);
  pyramid.Read({int(key[0]), tile->column, tile->row, RayTile::Posts, RayTile::Posts},
               tile->heights.data(), seconds);
  for (int k = 0; k < RayTile::Bits; ++k) {
    const int side = RayTile::Cells >> (k + 1);
    tile->ranges[k].resize(std::size_t(side) * side);
    for (int r = 0; r < side; ++r) {
      for (int c = 0; c < side; ++c) {
        RayTile::Range& range = tile->ranges[k][std::size_t(r) * side + c];
        for (int j = 2 * r; j <= 2 * r + (k == 0 ? 2 : 1); ++j) {
          for (int i = 2 * c; i <= 2 * c + (k == 0 ? 2 : 1); ++i) {
            if (k > 0) {
              range.Widen(tile->ranges[k - 1][std::size_t(j) * 2 * side + i]);
              continue;
            }
            const float h = tile->heights[std::size_t(j) * RayTile::Posts + i];
            if (!std::isnan(h)) {
              range.Widen({h, h});
            }
          }
        }
      }
    }
  }
  return tile;
}

} // namespace

RayTile::Range RayTile::Of(int bits, std::int64_t c, std::int64_t r) const {
  const int side = Cells >> bits;
  const std::int64_t i = c - (this->column >> bits);
  const std::int64_t j = r - (this->row >> bits);
  return this->ranges[bits - 1][std::size_t(j) * side + i];
}

RayTiles::RayTiles(std::shared_ptr<ElevationPyramid> pyramid)
    : Pyramid_(std::move(pyramid)), Tiles_(Kept) {}

void RayTiles::Refresh() {
  if (this->Pyramid_->LatestChange() != this->Seen_) {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    this->DropChanged();
  }
}

void RayTiles::DropChanged() {
  const PyramidChanges changes = this->Pyramid_->Changes(this->Seen_);
  this->Seen_ = changes.stamp;
  const auto touched = [&](const Key& key) {
    return std::any_of(changes.rectangles.begin(), changes.rectangles.end(),
                       [&](const PostRectangle& base) {
                         PostRectangle posts = PostsTouched(base, int(key[0]));
                         ++posts.width; // tiles share the posts at their borders
                         ++posts.height;
                         --posts.column;
                         --posts.row;
                         return key[0] >= base.from && key[0] < base.levels &&
                                !TouchedOfTile(this->Pyramid_->Lattice(), posts, key).Empty();
                       });
  };
  if (changes.rectangles.empty()) {
    return;
  }
  this->Tiles_.EraseIf(touched);
  for (auto it = this->Ranges_.begin(); it != this->Ranges_.end();) {
    it = touched(it->first) ? this->Ranges_.erase(it) : std::next(it);
  }
}

std::shared_ptr<const RayTile> RayTiles::Get(const Key& key, double seconds) {
  std::uint64_t seen = 0;
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    seen = this->Seen_;
    if (const std::shared_ptr<const RayTile>* kept = this->Tiles_.Find(key)) {
      return *kept;
    }
  }
  std::shared_ptr<const RayTile> tile = ReadTile(*this->Pyramid_, key, seconds);
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->DropChanged();
  if (this->Seen_ != seen) {
    return tile; // of a moment that has passed
  }
  this->Ranges_[key] = tile->ranges.back().front();
  this->Tiles_.Insert(key, tile);
  return tile;
}

RayTile::Range RayTiles::RangeOf(const Key& key, double seconds) {
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    const auto found = this->Ranges_.find(key);
    if (found != this->Ranges_.end()) {
      return found->second;
    }
  }
  return this->Get(key, seconds)->ranges.back().front();
}

} // namespace dspace
