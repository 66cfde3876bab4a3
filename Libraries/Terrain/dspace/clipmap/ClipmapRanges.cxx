#include <dspace/clipmap/ClipmapRanges.h>

#include <algorithm>
#include <limits>

#include <dspace/clipmap/arithmetic/ClipmapIndices.h>

namespace dspace {
namespace {

constexpr double Infinity = std::numeric_limits<double>::infinity();

void Extend(ClipmapRanges::Range& range, const ClipmapTexel& texel) {
  if (texel.hole < 1.0f) {
    range[0] = std::min<double>(range[0], texel.height);
    range[1] = std::max<double>(range[1], texel.height);
  }
}

// Posts [first, last] of a window, along the columns or rows.
struct Span {
  std::int64_t first;
  std::int64_t last;
};

// Without those beyond the last of a lattice; it may hold none.
Span SpanOf(int block, std::int64_t first, int cells, std::int64_t posts, bool periodic) {
  const int from = block * ClipmapIndices::BlockCells;
  Span span{first + from, first + std::min(from + ClipmapIndices::BlockCells, cells)};
  if (!periodic) {
    span.first = std::max<std::int64_t>(span.first, 0);
    span.last = std::min(span.last, posts - 1);
  }
  return span;
}

ClipmapRanges::Range RangeOf(const ClipmapLevels& levels, int level, int column, int row) {
  const int cells = levels.Geometry().Cells();
  const ClipmapWindow& window = levels.Window(level);
  const PostLattice& lattice = levels.Lattice();
  const Span columns =
      SpanOf(column, window.column, cells, lattice.ColumnsAt(level), lattice.periodic);
  const Span rows = SpanOf(row, window.row, cells, lattice.RowsAt(level), false);
  ClipmapRanges::Range range = {Infinity, -Infinity};
  for (std::int64_t r = rows.first; r <= rows.last; ++r) {
    for (std::int64_t c = columns.first; c <= columns.last; ++c) {
      Extend(range, levels.Texel(level, c, r));
    }
  }
  if (level + 1 == levels.Count() || range[0] > range[1]) {
    return range;
  }
  // The window of the coarser level holds these, a post more where the lattice ends between two.
  const ClipmapWindow& coarser = levels.Window(level + 1);
  const auto within = [cells](std::int64_t post, std::int64_t first) {
    return std::clamp<std::int64_t>(post, first, first + cells);
  };
  for (std::int64_t r = within(rows.first >> 1, coarser.row);
       r <= within((rows.last >> 1) + 1, coarser.row); ++r) {
    for (std::int64_t c = within(columns.first >> 1, coarser.column);
         c <= within((columns.last >> 1) + 1, coarser.column); ++c) {
      Extend(range, levels.Texel(level + 1, c, r));
    }
  }
  return range;
}

} // namespace

void ClipmapRanges::Changed(int level) {
  this->Levels_.resize(std::max(this->Levels_.size(), std::size_t(level) + 1));
  this->Levels_[std::size_t(level)].clear();
  if (level > 0) {
    this->Levels_[std::size_t(level) - 1].clear();
  }
}

ClipmapRanges::Range ClipmapRanges::Of(const ClipmapLevels& levels, int level, int column,
                                       int row) {
  const int across = ClipmapIndices::BlocksOf(levels.Geometry().Cells());
  this->Levels_.resize(std::size_t(levels.Count()));
  std::vector<Range>& ranges = this->Levels_[std::size_t(level)];
  if (ranges.empty()) {
    for (int r = 0; r < across; ++r) {
      for (int c = 0; c < across; ++c) {
        ranges.push_back(RangeOf(levels, level, c, r));
      }
    }
  }
  return ranges[std::size_t(row) * across + column];
}

} // namespace dspace
