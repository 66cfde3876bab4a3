#include <dspace/groups/PatchRanges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dspace {
namespace {

constexpr int Bits = 3; // of a square's side in pixels
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr std::array<float, 2> Nothing = {HUGE_VALF, -HUGE_VALF};

void Widen(std::array<float, 2>& range, const std::array<float, 2>& by) {
  range = {std::min(range[0], by[0]), std::max(range[1], by[1])};
}

} // namespace

PatchRanges::PatchRanges(int columns, int rows) {
  Level level;
  level.columns = 1 + ((columns - 1) >> Bits);
  level.rows = 1 + ((rows - 1) >> Bits);
  level.heights.assign(std::size_t(level.columns) * level.rows, Nothing);
  this->Levels_.push_back(std::move(level));
}

void PatchRanges::Take(int column, int row, double height) {
  Level& finest = this->Levels_.front();
  // Floats are rounded to either side.
  Widen(finest.heights[std::size_t(row >> Bits) * finest.columns + (column >> Bits)],
        {std::nextafter(float(height), -HUGE_VALF), std::nextafter(float(height), HUGE_VALF)});
}

void PatchRanges::Finish() {
  while (this->Levels_.back().columns > 1 || this->Levels_.back().rows > 1) {
    const Level& fine = this->Levels_.back();
    Level coarse;
    coarse.columns = (fine.columns + 1) / 2;
    coarse.rows = (fine.rows + 1) / 2;
    coarse.heights.assign(std::size_t(coarse.columns) * coarse.rows, Nothing);
    for (int r = 0; r < fine.rows; ++r) {
      for (int c = 0; c < fine.columns; ++c) {
        Widen(coarse.heights[std::size_t(r / 2) * coarse.columns + c / 2],
              fine.heights[std::size_t(r) * fine.columns + c]);
      }
    }
    this->Levels_.push_back(std::move(coarse));
  }
}

std::array<double, 2> PatchRanges::Of(const Eigen::AlignedBox2d& pixels) const {
  if (this->Levels_.empty()) {
    return {-Infinity, Infinity};
  }
  // The level of which the box meets a few squares.
  const double longest = std::ldexp(pixels.sizes().maxCoeff(), -Bits);
  std::size_t k = 0;
  while (k + 1 < this->Levels_.size() && std::ldexp(longest, -int(k)) > 3.0) {
    ++k;
  }
  const Level& level = this->Levels_[k];
  const auto square = [k](double pixel, int count) {
    const double at = std::ldexp(pixel, -Bits - int(k));
    return int(std::clamp(std::floor(at), 0.0, double(count - 1)));
  };
  std::array<float, 2> range = Nothing;
  for (int r = square(pixels.min().y(), level.rows); r <= square(pixels.max().y(), level.rows);
       ++r) {
    for (int c = square(pixels.min().x(), level.columns);
         c <= square(pixels.max().x(), level.columns); ++c) {
      Widen(range, level.heights[std::size_t(r) * level.columns + c]);
    }
  }
  return {range[0], range[1]};
}

} // namespace dspace
