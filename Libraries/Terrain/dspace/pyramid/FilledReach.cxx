#include <dspace/pyramid/FilledReach.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dspace {
namespace {

constexpr double ReachPosts = 64.0; // distances are counted in posts no finer than that
constexpr int Far = 1 << 28;        // posts; no data in that row

} // namespace

FilledReach::FilledReach(std::shared_ptr<const RasterPosts> posts, double reach)
    : Posts_(std::move(posts)), Reach_(reach) {}

// Distances are between posts of this level or, where those are many, of a coarser one.
void FilledReach::Drop(const PostBlock& block, std::vector<float>& heights) const {
  const PostLattice& lattice = this->Posts_->GetLattice();
  std::vector<float> own(heights.size());
  this->Posts_->Read(block, own.data());
  const auto made = [&](std::size_t at) { return std::isnan(own[at]) && !std::isnan(heights[at]); };
  bool any = false;
  for (std::size_t at = 0; at < heights.size(); ++at) {
    any |= made(at);
  }
  if (!any) {
    return;
  }
  const int pixels = this->Posts_->Subdivisions();
  const int above = int(std::ceil(std::log2(std::max(1.0, this->Reach_ / ReachPosts))));
  const int level =
      above == 0 ? block.level : std::clamp(pixels + above, block.level, lattice.levels - 1);
  const int down = level - block.level;
  const double reach = std::ldexp(this->Reach_, pixels - level); // in its posts
  // No further than the lattice goes, or around it once.
  const std::int64_t columns = lattice.ColumnsAt(level);
  const std::int64_t rows = lattice.RowsAt(level);
  const auto most = std::int64_t(std::min(std::ceil(reach), double(std::max(columns, rows))));
  const std::int64_t step = std::int64_t(1) << down;
  const auto nearest = [&](std::int64_t k) { return FloorDiv(2 * k + step, 2 * step); };
  const auto within = [](std::int64_t at, std::int64_t count) {
    return std::clamp<std::int64_t>(at, 0, count - 1);
  };
  std::int64_t left = nearest(block.column);
  std::int64_t right = nearest(block.column + block.width - 1);
  if (lattice.periodic) {
    left -= std::min(most, columns / 2 + 1);
    right += std::min(most, columns / 2 + 1);
  } else {
    left = within(left - most, columns);
    right = within(right + most, columns);
  }
  const std::int64_t top = within(nearest(block.row) - most, rows);
  const std::int64_t bottom = within(nearest(block.row + block.height - 1) + most, rows);
  const PostBlock around{level, left, top, int(right - left) + 1, int(bottom - top) + 1};
  std::vector<float> data(std::size_t(around.width) * around.height);
  this->Posts_->Read(around, data.data());
  // Along each row, how far it is to data.
  std::vector<int> aside(data.size(), Far);
  for (int j = 0; j < around.height; ++j) {
    int* row = aside.data() + std::size_t(j) * around.width;
    const float* posts = data.data() + std::size_t(j) * around.width;
    for (int i = 0; i < around.width; ++i) {
      row[i] = !std::isnan(posts[i]) ? 0 : std::min(row[i], i > 0 ? row[i - 1] + 1 : row[i]);
    }
    for (int i = around.width - 2; i >= 0; --i) {
      row[i] = std::min(row[i], row[i + 1] + 1);
    }
  }
  for (int j = 0; j < block.height; ++j) {
    for (int i = 0; i < block.width; ++i) {
      const std::size_t at = std::size_t(j) * block.width + i;
      if (!made(at)) {
        continue;
      }
      const std::int64_t c = nearest(block.column + i) - around.column;
      const std::int64_t r = nearest(block.row + j) - around.row;
      bool near = false;
      const std::int64_t last = std::min<std::int64_t>(r + most, around.height - 1);
      for (std::int64_t k = std::max<std::int64_t>(r - most, 0); k <= last && !near; ++k) {
        const double away = aside[std::size_t(k) * around.width + std::size_t(c)];
        near = away * away + double((k - r) * (k - r)) <= reach * reach;
      }
      if (!near) {
        heights[at] = std::numeric_limits<float>::quiet_NaN();
      }
    }
  }
}

} // namespace dspace
