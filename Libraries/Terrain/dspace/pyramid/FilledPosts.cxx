#include <dspace/pyramid/FilledPosts.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <dspace/Error.h>
#include <dspace/pyramid/ElevationPyramid.h>

#include <dspace/posts/PostsBetween.h>
#include <dspace/pyramid/FilledReach.h>
#include <dspace/pyramid/PyramidTiles.h>
#include <dspace/raster/LruCache.h>

namespace dspace {
namespace {

constexpr std::size_t KeptTiles = 256; // 64 KiB each
constexpr int Sweeps = 8;              // towards the mean of four neighbours, a level
constexpr int TopSweeps = 20000;       // at most; some thousand posts
constexpr double LeastShare = 0.75;    // of a cell that has data, for its mean to count
constexpr float None = std::numeric_limits<float>::quiet_NaN();

// How much a post's own height counts, from the share of its cell that has data.
float WeightOf(float share) {
  return float(std::clamp((double(share) - LeastShare) / (1.0 - LeastShare), 0.0, 1.0));
}

// A post's height drawn towards the mean of its neighbours `around`, of which those that are none
// are NaN.
template<typename Neighbours>
double Drawn(double here, float own, float weight, const Neighbours& around) {
  double sum = 0.0;
  int count = 0;
  for (const double height : around) {
    if (!std::isnan(height)) {
      sum += height;
      ++count;
    }
  }
  const double mean = count > 0 ? sum / count : here;
  return weight > 0.0f ? weight * double(own) + (1.0 - weight) * mean : mean;
}

} // namespace

FilledPosts::FilledPosts(std::shared_ptr<const RasterPosts> posts, double reach)
    : Posts_(std::move(posts)), Reach_(reach),
      Tiles_(std::make_unique<LruCache<Key, Heights>>(KeptTiles)) {
  if (!(reach > 0.0)) {
    throw Error(Error::Kind::InvalidArgument, this->GetName(),
                "holes filled within " + std::to_string(reach) +
                    " pixels of data are rejected; accepted is a positive number");
  }
}

FilledPosts::~FilledPosts() = default;

// The whole coarsest level: each post without data the mean of its neighbours, by over-relaxation.
FilledPosts::Heights FilledPosts::Top() const {
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    if (this->Top_) {
      return this->Top_;
    }
  }
  const PostLattice& lattice = this->GetLattice();
  const int top = lattice.levels - 1;
  const PostBlock all{top, 0, 0, int(lattice.ColumnsAt(top)), int(lattice.RowsAt(top))};
  std::vector<float> own(std::size_t(all.width) * all.height);
  std::vector<float> weights(own.size());
  this->Posts_->ReadWithShares(all, own.data(), weights.data());
  std::transform(weights.begin(), weights.end(), weights.begin(), WeightOf);
  if (std::all_of(weights.begin(), weights.end(), [](float w) { return w == 0.0f; })) {
    std::transform(own.begin(), own.end(), weights.begin(),
                   [](float h) { return std::isnan(h) ? 0.0f : 1.0f; });
  }
  double sum = 0.0;
  double count = 0.0;
  double least = std::numeric_limits<double>::infinity();
  double greatest = -least;
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (weights[i] > 0.0f) {
      sum += double(own[i]) * weights[i];
      count += weights[i];
      least = std::min(least, double(own[i]));
      greatest = std::max(greatest, double(own[i]));
    }
  }
  auto filled = std::make_shared<std::vector<float>>(own);
  if (count > 0.0) {
    std::vector<double> h(own.size(), sum / count);
    for (std::size_t i = 0; i < own.size(); ++i) {
      h[i] = weights[i] > 0.0f ? double(own[i]) : h[i];
    }
    const auto at = [&](int c, int r) {
      const bool inside = r >= 0 && r < all.height && c >= 0 && c < all.width;
      const bool around = lattice.periodic && r >= 0 && r < all.height;
      return inside || around ? h[std::size_t(r) * all.width + (c + all.width) % all.width]
                              : std::numeric_limits<double>::quiet_NaN();
    };
    const double enough = 1e-7 * (greatest - least);
    double change = std::numeric_limits<double>::infinity();
    for (int sweep = 0; sweep < TopSweeps && change > enough; ++sweep) {
      change = 0.0;
      for (int r = 0; r < all.height; ++r) {
        const bool last = r == all.height - 1;
        if (this->Posts_->Poles() && (r == 0 || last)) { // a pole has one height
          if (weights[std::size_t(r) * all.width] < 1.0f) {
            const double* next = h.data() + std::size_t(last ? r - 1 : 1) * all.width;
            std::fill_n(h.begin() + std::ptrdiff_t(r) * all.width, all.width,
                        std::accumulate(next, next + all.width, 0.0) / all.width);
          }
          continue;
        }
        for (int c = 0; c < all.width; ++c) {
          const std::size_t i = std::size_t(r) * all.width + c;
          if (weights[i] < 1.0f) {
            const std::array<double, 4> around = {at(c - 1, r), at(c + 1, r), at(c, r - 1),
                                                  at(c, r + 1)};
            const double step = 1.8 * (Drawn(h[i], own[i], weights[i], around) - h[i]);
            h[i] += step;
            change = std::max(change, std::abs(step));
          }
        }
      }
    }
    std::transform(h.begin(), h.end(), filled->begin(), [](double v) { return float(v); });
  }
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->Top_ = filled;
  return this->Top_;
}

// Of levels above the full one: they are asked for again and again by finer ones.
FilledPosts::Heights FilledPosts::TileOf(const Key& key) const {
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    if (const Heights* kept = this->Tiles_->Find(key)) {
      return *kept;
    }
  }
  const auto heights = std::make_shared<const std::vector<float>>(
      this->Fill({int(key[0]), key[1] * PyramidTileSize, key[2] * PyramidTileSize, PyramidTileSize,
                  PyramidTileSize}));
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->Tiles_->Insert(key, heights);
  return heights;
}

std::vector<float> FilledPosts::FromTiles(const PostBlock& block) const {
  const PostLattice& lattice = this->GetLattice();
  const std::int64_t columns = lattice.ColumnsAt(block.level);
  const std::int64_t rows = lattice.RowsAt(block.level);
  std::vector<float> heights(std::size_t(block.width) * block.height, None);
  const std::int64_t end = block.column + block.width;
  for (std::int64_t c = lattice.periodic ? block.column : std::max<std::int64_t>(block.column, 0);
       c < end && (lattice.periodic || c < columns);) {
    const std::int64_t in = lattice.Wrapped(block.level, c);
    const std::int64_t run =
        std::min({PyramidTileSize - in % PyramidTileSize, columns - in, end - c});
    for (std::int64_t r = std::max<std::int64_t>(block.row, 0);
         r < std::min(block.row + block.height, rows);) {
      const std::int64_t to = std::min({(r / PyramidTileSize + 1) * PyramidTileSize, rows,
                                        std::int64_t(block.row + block.height)});
      const Heights tile = this->TileOf({block.level, in / PyramidTileSize, r / PyramidTileSize});
      for (; r < to; ++r) {
        std::copy_n(tile->data() + r % PyramidTileSize * PyramidTileSize + in % PyramidTileSize,
                    run, heights.data() + (r - block.row) * block.width + (c - block.column));
      }
    }
    c += run;
  }
  return heights;
}

// Between the posts of the next coarser level, where a post's own height does not count in full.
void FilledPosts::StartFromCoarser(const PostBlock& block, const std::vector<float>& weights,
                                   std::vector<double>& heights) const {
  const PostLattice& lattice = this->GetLattice();
  const int level = block.level;
  PostBlock coarse{level + 1, FloorDiv(block.column, 2), FloorDiv(block.row, 2), 0, 0};
  coarse.width = int(FloorDiv(block.column + block.width - 1, 2) - coarse.column) + 2;
  coarse.height = int(FloorDiv(block.row + block.height - 1, 2) - coarse.row) + 2;
  const std::vector<float> posts = this->FromTiles(coarse);
  // The last post of a level stands at the lattice's edge.
  const auto between = [](std::int64_t place, std::int64_t before, std::int64_t after) {
    return after > before ? double(place - before) / double(after - before) : 0.0;
  };
  for (int j = 0; j < block.height; ++j) {
    const std::int64_t r = FloorDiv(block.row + j, 2);
    const double v = between(lattice.RowPlace(level, block.row + j), lattice.RowPlace(level + 1, r),
                             lattice.RowPlace(level + 1, r + 1));
    for (int i = 0; i < block.width; ++i) {
      const std::size_t at = std::size_t(j) * block.width + i;
      if (!(weights[at] < 1.0f)) {
        continue;
      }
      const std::int64_t c = FloorDiv(block.column + i, 2);
      const double u =
          between(lattice.ColumnPlace(level, block.column + i), lattice.ColumnPlace(level + 1, c),
                  lattice.ColumnPlace(level + 1, c + 1));
      double sum = 0.0;
      double total = 0.0;
      for (const int b : {0, 1}) {
        for (const int a : {0, 1}) {
          const float post = posts[std::size_t(r - coarse.row + b) * coarse.width +
                                   std::size_t(c - coarse.column + a)];
          const double share = (a ? u : 1.0 - u) * (b ? v : 1.0 - v);
          if (share > 0.0 && !std::isnan(post)) {
            sum += share * post;
            total += share;
          }
        }
      }
      const double start = total > 0.0 ? sum / total : std::numeric_limits<double>::quiet_NaN();
      const double weight = std::isnan(start) ? (std::isnan(heights[at]) ? 0.0 : 1.0) : weights[at];
      heights[at] = weight > 0.0
                        ? weight * heights[at] + (weight < 1.0 ? (1.0 - weight) * start : 0.0)
                        : start;
    }
  }
}

// A block of the full level or a coarser one.
std::vector<float> FilledPosts::Fill(const PostBlock& block) const {
  const PostLattice& lattice = this->GetLattice();
  std::vector<float> own(std::size_t(block.width) * block.height);
  std::vector<float> shares(own.size());
  this->Posts_->ReadWithShares(block, own.data(), shares.data());
  const auto inside = [&](const PostBlock& b, int i, int j) {
    return b.row + j >= 0 && b.row + j < lattice.RowsAt(b.level) &&
           (lattice.periodic || (b.column + i >= 0 && b.column + i < lattice.ColumnsAt(b.level)));
  };
  bool complete = true;
  for (int j = 0; j < block.height; ++j) {
    for (int i = 0; i < block.width; ++i) {
      complete &= shares[std::size_t(j) * block.width + i] >= 1.0f || !inside(block, i, j);
    }
  }
  if (complete) {
    return own;
  }
  const Heights top = this->Top();
  const std::int64_t columnsOfTop = lattice.ColumnsAt(lattice.levels - 1);
  if (block.level == lattice.levels - 1) {
    for (int j = 0; j < block.height; ++j) {
      for (int i = 0; i < block.width; ++i) {
        if (inside(block, i, j)) {
          own[std::size_t(j) * block.width + i] = (*top)[std::size_t(
              (block.row + j) * columnsOfTop + lattice.Wrapped(block.level, block.column + i))];
        }
      }
    }
    return own;
  }
  // What a post becomes depends on those within as many posts as there are sweeps.
  const PostBlock grown{block.level, block.column - Sweeps, block.row - Sweeps,
                        block.width + 2 * Sweeps, block.height + 2 * Sweeps};
  own.resize(std::size_t(grown.width) * grown.height);
  std::vector<float> weights(own.size());
  this->Posts_->ReadWithShares(grown, own.data(), weights.data());
  std::transform(weights.begin(), weights.end(), weights.begin(), WeightOf);
  for (int j = 0; j < grown.height; ++j) {
    for (int i = 0; i < grown.width; ++i) {
      if (!inside(grown, i, j)) {
        weights[std::size_t(j) * grown.width + i] = 1.0f; // is none, and stays so
      }
    }
  }
  std::vector<double> heights(own.begin(), own.end());
  this->StartFromCoarser(grown, weights, heights);
  const std::int64_t lastRow = lattice.RowsAt(block.level) - 1;
  for (int j = 0; this->Posts_->Poles() && j < grown.height; ++j) {
    const std::int64_t r = grown.row + j;
    if ((r == 0 || r == lastRow) && weights[std::size_t(j) * grown.width] < 1.0f) {
      const float pole = r == 0 ? top->front() : top->back();
      std::fill_n(heights.begin() + std::ptrdiff_t(j) * grown.width, grown.width, pole);
      std::fill_n(own.begin() + std::ptrdiff_t(j) * grown.width, grown.width, pole);
      std::fill_n(weights.begin() + std::ptrdiff_t(j) * grown.width, grown.width, 1.0f);
    }
  }
  std::vector<double> next = heights;
  for (int sweep = 0; sweep < Sweeps; ++sweep) {
    for (int j = 1; j + 1 < grown.height; ++j) {
      for (int i = 1; i + 1 < grown.width; ++i) {
        const std::size_t at = std::size_t(j) * grown.width + i;
        if (weights[at] < 1.0f) {
          const std::array<double, 4> around = {heights[at - 1], heights[at + 1],
                                                heights[at - grown.width],
                                                heights[at + grown.width]};
          next[at] = Drawn(heights[at], own[at], weights[at], around);
        }
      }
    }
    heights.swap(next);
  }
  std::vector<float> filled(std::size_t(block.width) * block.height);
  for (int j = 0; j < block.height; ++j) {
    for (int i = 0; i < block.width; ++i) {
      filled[std::size_t(j) * block.width + i] =
          float(heights[std::size_t(j + Sweeps) * grown.width + i + Sweeps]);
    }
  }
  return filled;
}

void FilledPosts::Read(const PostBlock& block, float* heights) const {
  const int full = this->Posts_->FullLevel();
  if (block.level < full) {
    const auto read = [this](const PostBlock& wanted, float* posts) { this->Read(wanted, posts); };
    ReadBetweenPosts(this->GetLattice(), this->Posts_->Poles(), full, read, block, heights);
    // What lies outside the lattice is no post.
    const PostLattice& lattice = this->GetLattice();
    for (int j = 0; j < block.height; ++j) {
      for (int i = 0; i < block.width; ++i) {
        const std::int64_t c = block.column + i;
        const std::int64_t r = block.row + j;
        if (r < 0 || r >= lattice.RowsAt(block.level) ||
            (!lattice.periodic && (c < 0 || c >= lattice.ColumnsAt(block.level)))) {
          heights[std::size_t(j) * block.width + i] = None;
        }
      }
    }
    return;
  }
  std::vector<float> filled =
      block.level > full && std::isinf(this->Reach_) ? this->FromTiles(block) : this->Fill(block);
  if (std::isfinite(this->Reach_)) {
    FilledReach(this->Posts_, this->Reach_).Drop(block, filled);
  }
  std::copy(filled.begin(), filled.end(), heights);
}

} // namespace dspace
