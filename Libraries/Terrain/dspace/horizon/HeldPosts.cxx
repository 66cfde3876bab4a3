#include <dspace/horizon/HeldPosts.h>

#include <algorithm>
#include <limits>

namespace dspace {
namespace {

constexpr int Margin = 4; // posts around the lattice
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
  held->SpanColumns_ = (place.width + SpanSide - 1) / SpanSide;
  const float infinity = std::numeric_limits<float>::infinity();
  held->Spans_.assign(std::size_t(held->SpanColumns_) *
                          std::size_t((place.height + SpanSide - 1) / SpanSide),
                      {infinity, -infinity});
  std::vector<float> rows(std::size_t(place.width) * SpanSide);
  for (int r = 0; r < place.height; r += SpanSide) {
    if (proceed && !proceed()) {
      return nullptr;
    }
    const int count = std::min(SpanSide, place.height - r);
    pyramid.Read({0, place.column, place.row + r, place.width, count}, rows.data());
    for (int j = 0; j < count; ++j) {
      const float* from = &rows[std::size_t(j) * std::size_t(place.width)];
      float* to = &held->Heights_[std::size_t(r + j) * std::size_t(place.width)];
      HeightSpan* spans = &held->Spans_[std::size_t(r / SpanSide * held->SpanColumns_)];
      for (int c = 0; c < place.width; ++c) {
        const float h = from[c];
        to[c % every * held->Share_ + c / every] = h;
        HeightSpan& span = spans[c / SpanSide];
        span.least = h < span.least ? h : span.least;
        span.greatest = h > span.greatest ? h : span.greatest;
      }
    }
  }
  return held;
}

HeightSpan HeldPosts::SpanOf(const PostBlock& block) const {
  const float infinity = std::numeric_limits<float>::infinity();
  HeightSpan all = {infinity, -infinity};
  const auto clamped = [](std::int64_t value, int most) {
    return std::clamp<std::int64_t>(value, 0, most - 1) / SpanSide;
  };
  const std::int64_t left = block.column - this->Place_.column;
  const std::int64_t top = block.row - this->Place_.row;
  const std::int64_t c1 = clamped(left + block.width - 1, this->Place_.width);
  const std::int64_t r1 = clamped(top + block.height - 1, this->Place_.height);
  for (std::int64_t r = clamped(top, this->Place_.height); r <= r1; ++r) {
    for (std::int64_t c = clamped(left, this->Place_.width); c <= c1; ++c) {
      const HeightSpan& span = this->Spans_[std::size_t(r * this->SpanColumns_ + c)];
      all.least = std::min(all.least, span.least);
      all.greatest = std::max(all.greatest, span.greatest);
    }
  }
  return all;
}

} // namespace dspace
