#include <dspace/posts/RasterMeans.h>

#include <algorithm>
#include <cmath>

namespace dspace {
namespace {

constexpr int FullReads = 3; // levels above the pixels whose means read every pixel

} // namespace

RasterMeans::RasterMeans(std::shared_ptr<const PixelWindows> pixels, const PostLattice& lattice,
                         int subdivisions, bool poles, double stretch)
    : Pixels_(std::move(pixels)), Lattice_(lattice), Subdivisions_(subdivisions), Poles_(poles),
      Stretch_(stretch) {}

int RasterMeans::FirstReducedLevel() const {
  return this->Subdivisions_ + FullReads + 1;
}

void RasterMeans::InvalidateReduced() {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->PoleHeights_.erase(this->PoleHeights_.lower_bound({this->FirstReducedLevel(), false}),
                           this->PoleHeights_.end());
}

double RasterMeans::PoleHeight(int level, bool last) const {
  const std::pair<int, bool> key(std::max(level, this->Subdivisions_), last);
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    const auto known = this->PoleHeights_.find(key);
    if (known != this->PoleHeights_.end()) {
      return known->second;
    }
  }
  const RasterWindow all = this->Pixels_->Whole();
  const int above = key.first - this->Subdivisions_;
  const int factor = 1 << std::max(0, above - FullReads);
  const int columns = 1 + (all.width - 1) / factor;
  const int rows = 1 + (all.height - 1) / factor;
  // In reduced pixels; a row of pixels is the least that is taken.
  const double reach = std::min(double(all.height), std::max(1.0, std::ldexp(0.5, above))) / factor;
  const double to = double(all.height) / factor;
  const int height = std::min(rows, int(std::ceil(reach)) + 1);
  const int top = last ? rows - height : 0;
  const std::vector<double> pixels = this->Pixels_->Read(0, top, columns, height, factor);
  const BoxSpan span = last ? BoxSpan{to - reach - top, to - top} : BoxSpan{0.0, reach};
  const double mean =
      BoxMeans(pixels, columns, height, {{0.0, double(all.width) / factor}}, {span}).front();
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  return this->PoleHeights_[key] = mean;
}

// BoxMeans of the raster at `factor`, its columns of any turn. The last reduced pixel of a row may
// be narrower than the others: each turn is summed by itself.
std::vector<double> RasterMeans::MeansAround(const std::vector<BoxSpan>& columns,
                                             const std::vector<BoxSpan>& rows, int factor,
                                             std::vector<double>& shares) const {
  const RasterWindow all = this->Pixels_->Whole();
  const auto top = std::int64_t(std::floor(rows.front().from / factor));
  const auto bottom = std::int64_t(std::ceil(rows.back().to / factor));
  std::vector<BoxSpan> down = rows;
  for (BoxSpan& span : down) {
    span = {span.from / factor - double(top), span.to / factor - double(top)};
  }
  BoxSums sums(columns.size() * rows.size());
  const auto firstTurn = std::int64_t(std::floor(columns.front().from / all.width));
  const auto lastTurn = std::int64_t(std::ceil(columns.back().to / all.width)) - 1;
  for (std::int64_t turn = firstTurn; turn <= lastTurn; ++turn) {
    std::vector<BoxSpan> along = columns;
    double from = all.width;
    double to = 0.0;
    for (BoxSpan& span : along) {
      span.from = std::max(span.from - double(turn) * all.width, 0.0);
      span.to = std::min(span.to - double(turn) * all.width, double(all.width));
      if (span.from < span.to) {
        from = std::min(from, span.from);
        to = std::max(to, span.to);
      } else {
        span = {0.0, 0.0};
      }
    }
    if (!(from < to)) {
      continue;
    }
    const auto left = std::int64_t(std::floor(from / factor));
    const auto right = std::int64_t(std::ceil(to / factor));
    for (BoxSpan& span : along) {
      if (span.from < span.to) {
        span = {span.from / factor - double(left), span.to / factor - double(left)};
      }
    }
    const int width = int(right - left);
    const int height = int(bottom - top);
    sums.Add(this->Pixels_->Read(left, top, width, height, factor), width, height, along, down);
  }
  const double area = (columns.front().to - columns.front().from) / factor;
  return sums.Means(std::vector<double>(columns.size(), area), down, &shares);
}

std::vector<double> RasterMeans::MeansOf(std::vector<BoxSpan> columns, std::vector<BoxSpan> rows,
                                         int factor, std::vector<double>& shares) const {
  const std::int64_t left = FloorDiv(std::int64_t(std::floor(columns.front().from)), factor);
  const std::int64_t right = FloorDiv(std::int64_t(std::ceil(columns.back().to)) - 1, factor) + 1;
  const std::int64_t top = FloorDiv(std::int64_t(std::floor(rows.front().from)), factor);
  const std::int64_t bottom = FloorDiv(std::int64_t(std::ceil(rows.back().to)) - 1, factor) + 1;
  const int width = int(right - left);
  const int height = int(bottom - top);
  const std::vector<double> pixels = this->Pixels_->Read(left, top, width, height, factor);
  for (BoxSpan& span : columns) {
    span = {span.from / factor - double(left), span.to / factor - double(left)};
  }
  for (BoxSpan& span : rows) {
    span = {span.from / factor - double(top), span.to / factor - double(top)};
  }
  BoxSums sums(columns.size() * rows.size());
  sums.Add(pixels, width, height, columns, rows);
  std::vector<double> widths;
  for (const BoxSpan& span : columns) {
    widths.push_back(span.to - span.from);
  }
  return sums.Means(widths, rows, &shares);
}

void RasterMeans::Read(const PostBlock& block, float* heights, float* shares) const {
  const RasterWindow all = this->Pixels_->Whole();
  const int above = block.level - this->Subdivisions_;
  const double half = std::ldexp(0.5, above); // of a box [pixels]
  // Pixels are taken `factor` together where the means would read too many of them.
  const int factor = 1 << std::max(0, above - FullReads);
  // `offset` is the first post's place, in pixels from the raster's edge.
  const auto spans = [&](std::int64_t first, int count, bool periodic, std::int64_t pixels,
                         double offset) {
    const std::int64_t last = offset > 0.0 ? pixels - 1 : pixels;
    std::vector<BoxSpan> result(count);
    for (int i = 0; i < count; ++i) {
      const std::int64_t k = (first + i) * (std::int64_t(1) << above);
      const double center = offset + double(periodic ? k : std::clamp<std::int64_t>(k, 0, last));
      result[i] = {center - half, center + half};
      if (!periodic) {
        result[i].from = std::max(result[i].from, 0.0);
        result[i].to = std::min(result[i].to, double(pixels));
      }
    }
    return result;
  };
  std::vector<BoxSpan> columns =
      spans(block.column, block.width, this->Lattice_.periodic, all.width, 0.5);
  std::vector<BoxSpan> rows =
      spans(block.row, block.height, false, all.height, this->Poles_ ? 0.0 : 0.5);
  std::vector<double> means;
  std::vector<double> parts;
  if (this->Stretch_ == 1.0) {
    means = this->MeansOf(columns, rows, factor, parts);
  } else {
    for (int i = 0; i < block.width; ++i) {
      const double center = 0.5 + std::ldexp(double(block.column + i), above) * this->Stretch_;
      columns[i] = {center - half * this->Stretch_, center + half * this->Stretch_};
    }
    means = this->MeansAround(columns, rows, factor, parts);
  }
  const auto toFloat = [](double h) { return float(h); };
  std::transform(means.begin(), means.end(), heights, toFloat);
  std::transform(parts.begin(), parts.end(), shares, toFloat);
  const std::int64_t last = this->Lattice_.RowsAt(block.level) - 1;
  for (int j = 0; this->Poles_ && j < block.height; ++j) {
    if (block.row + j == 0 || block.row + j == last) {
      const auto pole = float(this->PoleHeight(block.level, block.row + j == last));
      std::fill_n(heights + std::size_t(j) * block.width, block.width, pole);
      std::fill_n(shares + std::size_t(j) * block.width, block.width,
                  std::isnan(pole) ? 0.0f : 1.0f);
    }
  }
}

} // namespace dspace
