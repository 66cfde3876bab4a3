#include <dspace/pyramid/PostSurface.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <mutex>
#include <utility>

#include <dspace/Error.h>

#include <dspace/posts/PostProbe.h>
#include <dspace/pyramid/PyramidTiles.h>
#include <dspace/raster/LruCache.h>

namespace dspace {
namespace {

constexpr std::size_t MaximumSinglePosts = 16; // of a tile, in blocks; for more, the tile is read
constexpr std::size_t MaximumProbed = 1000;    // places in a tile, with a probe

// Posts with one of margin, so that the rims of holes can look around.
struct Block {
  PostBlock place;
  std::vector<float> heights;

  double operator()(std::int64_t c, std::int64_t r) const {
    const std::int64_t i = c - this->place.column;
    const std::int64_t j = r - this->place.row;
    return i < 0 || j < 0 || i >= this->place.width || j >= this->place.height
               ? std::numeric_limits<double>::quiet_NaN()
               : double(this->heights[std::size_t(j) * this->place.width + i]);
  }
};

CellRange CellsOf(const PostLattice& lattice, int level) {
  constexpr std::int64_t Around = std::int64_t(1) << 60;
  return {lattice.periodic ? -Around : 0, lattice.periodic ? Around : lattice.ColumnsAt(level) - 2,
          0, lattice.RowsAt(level) - 2};
}

} // namespace

// Number of single posts that were read from each of the most recent tiles.
struct PostSurface::SinglePostCounts {
  std::mutex mutex;
  LruCache<std::pair<std::int64_t, std::int64_t>, std::shared_ptr<std::size_t>> tiles{4096};
};

PostSurface::PostSurface(std::shared_ptr<ElevationPyramid> pyramid, int level, bool poles,
                         double deadline, bool scattered)
    : Pyramid_(std::move(pyramid)), Level_(level), Poles_(poles), Deadline_(deadline),
      SinglePostCounts_(scattered ? std::make_unique<SinglePostCounts>() : nullptr) {}

PostSurface::~PostSurface() = default;

// Whether `count` more places of a tile should be read as single posts: not after many others.
bool PostSurface::PrefersSingleBlocks(std::size_t count, std::int64_t tileColumn,
                                      std::int64_t tileRow) const {
  if (!this->SinglePostCounts_ || count > MaximumSinglePosts) {
    return false;
  }
  const std::pair<std::int64_t, std::int64_t> key(tileColumn, tileRow);
  const std::lock_guard<std::mutex> lock(this->SinglePostCounts_->mutex);
  this->SinglePostCounts_->tiles.Insert(key, std::make_shared<std::size_t>(0));
  std::size_t& before = **this->SinglePostCounts_->tiles.Find(key);
  before += count;
  return before <= MaximumSinglePosts;
}

HeightGrid::Facet PostSurface::At(const Eigen::Vector2d& post) const {
  Facet result;
  this->At(std::vector<Eigen::Vector2d>{post},
           [&result](std::size_t, const Facet& facet) { result = facet; });
  return result;
}

void PostSurface::At(const std::vector<Eigen::Vector2d>& posts,
                     const std::function<void(std::size_t, const Facet&)>& take) const {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const double scale = std::ldexp(1.0, -this->Level_);
  const CellRange cells = CellsOf(this->Lattice(), this->Level_);
  struct Item {
    std::int64_t tileRow;
    std::int64_t tileColumn;
    std::size_t index;
  };
  std::vector<Item> items;
  items.reserve(posts.size());
  const auto cellOf = [&](const Eigen::Vector2d& post) {
    const Eigen::Vector2d p = post * scale;
    return std::array<std::int64_t, 2>{
        std::clamp(std::int64_t(std::floor(p.x())), cells.firstColumn, cells.lastColumn),
        std::clamp(std::int64_t(std::floor(p.y())), cells.firstRow, cells.lastRow)};
  };
  for (std::size_t i = 0; i < posts.size(); ++i) {
    const Eigen::Vector2d p = posts[i] * scale;
    const bool inside = p.x() >= double(cells.firstColumn) - 1.0 &&
                        p.x() <= double(cells.lastColumn) + 2.0 && p.y() >= -1.0 &&
                        p.y() <= double(cells.lastRow) + 2.0;
    if (!inside) {
      take(i, {});
      continue;
    }
    const auto [c, r] = cellOf(posts[i]);
    items.push_back({r / PyramidTileSize, FloorDiv(c, PyramidTileSize), i});
  }
  const auto before = [](const Item& a, const Item& b) {
    return a.tileRow != b.tileRow ? a.tileRow < b.tileRow : a.tileColumn < b.tileColumn;
  };
  std::sort(items.begin(), items.end(), before);
  const std::unique_ptr<PostProbe> probe =
      this->SinglePostCounts_ && this->Level_ == 0 ? this->Pyramid_->Source().MakeProbe() : nullptr;
  const auto probed = [&](std::int64_t c, std::int64_t r, bool below, double u, double v) {
    const auto at = [&](std::int64_t i, std::int64_t j) -> double { return probe->At(i, j); };
    return this->OfCell(at, c, r, below, u, v);
  };
  Block block;
  std::vector<Facet> facets;
  for (std::size_t from = 0; from < items.size();) {
    std::size_t to = from;
    std::array<std::int64_t, 2> low = cellOf(posts[items[from].index]);
    std::array<std::int64_t, 2> high = low;
    for (; to < items.size() && !before(items[from], items[to]); ++to) {
      const auto cell = cellOf(posts[items[to].index]);
      for (const int k : {0, 1}) {
        low[k] = std::min(low[k], cell[k]);
        high[k] = std::max(high[k], cell[k]);
      }
    }
    if (probe && to - from <= MaximumProbed && probe->HasRows(low[1] - 1, high[1] + 2)) {
      for (; from < to; ++from) {
        const std::size_t i = items[from].index;
        take(i, FacetNear(cells, posts[i] * scale, probed));
      }
      continue;
    }
    block.place = {this->Level_, low[0] - 1, low[1] - 1, int(high[0] - low[0]) + 4,
                   int(high[1] - low[1]) + 4};
    block.heights.resize(std::size_t(block.place.width) * block.place.height);
    const double spent = std::chrono::duration<double>(Clock::now() - start).count();
    const double left = std::max(0.0, this->Deadline_ - spent);
    const auto cell = [&](std::int64_t c, std::int64_t r, bool below, double u, double v) {
      return this->OfCell(block, c, r, below, u, v);
    };
    const bool singly =
        left > 0.0 &&
        this->PrefersSingleBlocks(to - from, items[from].tileColumn, items[from].tileRow) &&
        !this->Pyramid_->ReadHeld(block.place, block.heights.data());
    if (singly) {
      try {
        Block few;
        for (std::size_t k = from; k < to; ++k) {
          const auto [c, r] = cellOf(posts[items[k].index]);
          few.place = {this->Level_, c - 1, r - 1, 4, 4};
          few.heights.resize(16);
          this->Pyramid_->Source().Read(few.place, few.heights.data());
          const auto ofFew = [&](std::int64_t cc, std::int64_t rr, bool below, double u, double v) {
            return this->OfCell(few, cc, rr, below, u, v);
          };
          facets.push_back(FacetNear(cells, posts[items[k].index] * scale, ofFew));
        }
        for (std::size_t k = 0; k < facets.size(); ++k) {
          take(items[from + k].index, facets[k]);
        }
        facets.clear();
        from = to;
        continue;
      } catch (const Error&) { // the pyramid tries again and reports errors
        facets.clear();
      }
    }
    this->Pyramid_->Read(block.place, block.heights.data(), left);
    for (; from < to; ++from) {
      const std::size_t i = items[from].index;
      take(i, FacetNear(cells, posts[i] * scale, cell));
    }
  }
}

} // namespace dspace
