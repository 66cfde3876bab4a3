#include <dspace/horizon/HeldPosts.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace dspace {
namespace {

constexpr int Margin = 4;      // posts around the lattice
constexpr int RowsAtOnce = 32; // that are read
constexpr int RowMargin = 2 * HeldPosts::RowsToSpare;

} // namespace

std::int64_t HeldPosts::CountOf(const PostLattice& lattice) {
  return (lattice.periodic ? 2 : 1) * lattice.columns * lattice.rows;
}

std::shared_ptr<const HeldPosts> HeldPosts::Read(ElevationPyramid& pyramid, int every, int reach,
                                                 const std::function<bool()>& proceed) {
  const PostLattice& lattice = pyramid.Lattice();
  const auto held = std::make_shared<HeldPosts>();
  const std::int64_t half = lattice.periodic ? lattice.columns / 2 : 0;
  PostBlock& place = held->Place_;
  place.column = -half - Margin - reach;
  place.row = -RowMargin;
  place.height = int(lattice.rows + 2 * RowMargin);
  const std::int64_t width = lattice.columns + 2 * half + 2 * (Margin + reach);
  place.width = int((width + every - 1) / every * every);
  held->Every_ = every;
  held->Share_ = place.width / every;
  held->Heights_.resize(std::size_t(place.width) * std::size_t(place.height));
  const float infinity = std::numeric_limits<float>::infinity();
  SpanLevel finest;
  finest.columns = (place.width + SpanSide - 1) / SpanSide;
  finest.rows = (place.height + SpanSide - 1) / SpanSide;
  finest.spans.assign(std::size_t(finest.columns) * std::size_t(finest.rows),
                      {infinity, -infinity});
  std::vector<float> rows(std::size_t(place.width) * RowsAtOnce);
  for (int r = 0; r < place.height; r += RowsAtOnce) {
    if (proceed && !proceed()) {
      return nullptr;
    }
    const int count = std::min(RowsAtOnce, place.height - r);
    pyramid.Read({0, place.column, place.row + r, place.width, count}, rows.data());
    for (int j = 0; j < count; ++j) {
      const float* from = &rows[std::size_t(j) * std::size_t(place.width)];
      float* to = &held->Heights_[std::size_t(r + j) * std::size_t(place.width)];
      HeightSpan* spans = &finest.spans[std::size_t((r + j) / SpanSide * finest.columns)];
      for (int c = 0; c < place.width; ++c) {
        const float h = from[c];
        to[c % every * held->Share_ + c / every] = h;
        HeightSpan& span = spans[c / SpanSide];
        span.least = h < span.least ? h : span.least;
        span.greatest = h > span.greatest ? h : span.greatest;
      }
    }
  }
  held->Spans_.push_back(std::move(finest));
  held->AddSpanLevels();
  return held;
}

void HeldPosts::AddSpanLevels() {
  while (std::max(this->Spans_.back().columns, this->Spans_.back().rows) > 1) {
    const SpanLevel& fine = this->Spans_.back();
    SpanLevel coarse;
    coarse.columns = (fine.columns + 1) / 2;
    coarse.rows = (fine.rows + 1) / 2;
    for (int r = 0; r < coarse.rows; ++r) {
      for (int c = 0; c < coarse.columns; ++c) {
        HeightSpan all =
            fine.spans[std::size_t(2 * r) * std::size_t(fine.columns) + std::size_t(2 * c)];
        for (int k = 1; k < 4; ++k) {
          const int column = std::min(2 * c + k % 2, fine.columns - 1);
          const int row = std::min(2 * r + k / 2, fine.rows - 1);
          const HeightSpan& span =
              fine.spans[std::size_t(row) * std::size_t(fine.columns) + std::size_t(column)];
          all.least = std::min(all.least, span.least);
          all.greatest = std::max(all.greatest, span.greatest);
        }
        coarse.spans.push_back(all);
      }
    }
    this->Spans_.push_back(std::move(coarse));
  }
}

template<typename Take>
void HeldPosts::ForEachSquare(const PostBlock& block, const Take& take) const {
  // Of the level at which the block takes four squares a side at most.
  std::size_t level = 0;
  int shift = SpanShift;
  while (std::max(block.width, block.height) > 3 << shift && level + 1 < this->Spans_.size()) {
    ++level;
    ++shift;
  }
  const SpanLevel& squares = this->Spans_[level];
  const auto clamped = [shift](std::int64_t value, int most) {
    return int(std::clamp<std::int64_t>(value, 0, most - 1)) >> shift;
  };
  const std::int64_t left = block.column - this->Place_.column;
  const std::int64_t top = block.row - this->Place_.row;
  const int c0 = clamped(left, this->Place_.width);
  const int c1 = clamped(left + block.width - 1, this->Place_.width);
  const int r1 = clamped(top + block.height - 1, this->Place_.height);
  for (int r = clamped(top, this->Place_.height); r <= r1; ++r) {
    const HeightSpan* row = &squares.spans[std::size_t(r) * std::size_t(squares.columns)];
    for (int c = c0; c <= c1; ++c) {
      take(row[c]);
    }
  }
}

HeightSpan HeldPosts::SpanOf(const PostBlock& block) const {
  const float infinity = std::numeric_limits<float>::infinity();
  HeightSpan all = {infinity, -infinity};
  this->ForEachSquare(block, [&](const HeightSpan& square) {
    all.least = std::min(all.least, square.least);
    all.greatest = std::max(all.greatest, square.greatest);
  });
  return all;
}

float HeldPosts::GreatestOf(const PostBlock& block) const {
  float greatest = -std::numeric_limits<float>::infinity();
  this->ForEachSquare(
      block, [&](const HeightSpan& square) { greatest = std::max(greatest, square.greatest); });
  return greatest;
}

} // namespace dspace
