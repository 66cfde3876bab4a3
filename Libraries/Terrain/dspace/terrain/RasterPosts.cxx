#include <dspace/terrain/RasterPosts.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Error.h>
#include <dspace/terrain/BoxFilter.h>

namespace dspace {
namespace {

constexpr int FullReads = 3; // levels above the pixels whose means read every pixel
constexpr double NoData = std::numeric_limits<double>::quiet_NaN();

PostLattice LatticeOf(const ElevationInfo& info, const RasterPostsOptions& options) {
  const std::string object = "raster '" + info.path + "'";
  const int width = info.window.width;
  const int height = info.window.height;
  if (width < 2 || height < 2) {
    throw Error(Error::Kind::InvalidArgument, object,
                std::to_string(width) + " x " + std::to_string(height) +
                    " posts span no surface; at least 2 x 2 are needed");
  }
  if (options.subdivisions < 0 || options.subdivisions > 24) {
    throw Error(Error::Kind::InvalidArgument, object,
                "subdivisions " + std::to_string(options.subdivisions) +
                    " is refused; accepted is 0 to 24");
  }
  if (options.poles && (!options.periodic || options.subdivisions < 1)) {
    throw Error(Error::Kind::InvalidArgument, object,
                "poles need a raster that goes once around and subdivisions of 1 or more");
  }
  PostLattice lattice;
  const std::int64_t parts = std::int64_t(1) << options.subdivisions;
  lattice.periodic = options.periodic;
  lattice.columns = options.periodic ? width * parts : (width - 1) * parts + 1;
  lattice.rows = (options.poles ? height : height - 1) * parts + 1;
  lattice.levels = options.levels > 0 ? options.levels : LevelsFor(lattice, options.coarsest);
  const bool halved = lattice.periodic
                          ? lattice.columns % (std::int64_t(1) << (lattice.levels - 1)) == 0
                          : lattice.levels <= 50;
  if (!halved) {
    throw Error(Error::Kind::InvalidArgument, object,
                std::to_string(width) + " columns around a body cannot be halved for " +
                    std::to_string(lattice.levels) + " levels");
  }
  return lattice;
}

// Height at (u, v) of a cell whose corners are a (0, 0), b (1, 0), c (0, 1), d (1, 1): triangles A
// (below the diagonal a-d) and B, as in HeightGrid.
double OnTriangles(double a, double b, double c, double d, double u, double v) {
  if (u == 0.0 && v == 0.0) {
    return a;
  }
  if (u == v) { // the diagonal needs only its ends
    return a + u * (d - a);
  }
  if (v > u) {
    return u == 0.0 ? a + v * (c - a) : a + u * (d - c) + v * (c - a);
  }
  return v == 0.0 ? a + u * (b - a) : a + u * (b - a) + v * (d - b);
}

} // namespace

int LevelsFor(const PostLattice& lattice, int coarsest) {
  PostLattice probe = lattice;
  int levels = 1;
  while (levels < 50) {
    const std::int64_t cells =
        std::max(probe.periodic ? probe.ColumnsAt(levels - 1) : probe.ColumnsAt(levels - 1) - 1,
                 probe.RowsAt(levels - 1) - 1);
    const bool odd = probe.periodic && probe.ColumnsAt(levels - 1) % 2 != 0;
    if (cells <= coarsest || odd) {
      break;
    }
    ++levels;
  }
  return levels;
}

RasterPosts::RasterPosts(std::shared_ptr<const ElevationSource> source,
                         const RasterPostsOptions& options)
    : Source_(std::move(source)), Name_("raster '" + Source_->Info().path + "'"),
      Lattice_(LatticeOf(Source_->Info(), options)), Subdivisions_(options.subdivisions),
      Poles_(options.poles) {}

// Pixels of any window of the raster reduced by `factor`; NaN outside it, wrapped where periodic.
std::vector<double> RasterPosts::ReadPixels(std::int64_t column, std::int64_t row, int width,
                                            int height, int factor) const {
  const RasterWindow all = this->Source_->Info().window;
  const std::int64_t columns = 1 + (all.width - 1) / factor;
  const std::int64_t rows = 1 + (all.height - 1) / factor;
  std::vector<double> pixels(static_cast<std::size_t>(width) * height, NoData);
  const std::int64_t top = std::clamp<std::int64_t>(row, 0, rows);
  const std::int64_t bottom = std::clamp<std::int64_t>(row + height, 0, rows);
  std::int64_t c = column;
  std::int64_t end = column + width;
  if (!this->Lattice_.periodic) {
    c = std::clamp<std::int64_t>(c, 0, columns);
    end = std::clamp<std::int64_t>(end, 0, columns);
  }
  while (top < bottom && c < end) {
    const std::int64_t from = c - FloorDiv(c, columns) * columns; // in the raster
    const std::int64_t run = std::min(columns - from, end - c);
    RasterWindow window;
    window.column = int(from * factor);
    window.row = int(top * factor);
    window.width = int(std::min<std::int64_t>(run * factor, all.width - window.column));
    window.height = int(std::min<std::int64_t>((bottom - top) * factor, all.height - window.row));
    const std::vector<double> part = this->Source_->ReadReduced(window, factor);
    for (std::int64_t r = top; r < bottom; ++r) {
      std::copy_n(part.begin() + (r - top) * run, run,
                  pixels.begin() + (r - row) * width + (c - column));
    }
    c += run;
  }
  return pixels;
}

// Of all that a level's boxes about a pole reach; up to the raster's own posts, of the row next to
// it.
double RasterPosts::PoleHeight(int level, bool last) const {
  const std::pair<int, bool> key(std::max(level, this->Subdivisions_), last);
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    const auto known = this->PoleHeights_.find(key);
    if (known != this->PoleHeights_.end()) {
      return known->second;
    }
  }
  const RasterWindow all = this->Source_->Info().window;
  const int above = key.first - this->Subdivisions_;
  const int factor = 1 << std::max(0, above - FullReads);
  const int columns = 1 + (all.width - 1) / factor;
  const int rows = 1 + (all.height - 1) / factor;
  // In reduced pixels; a row of pixels is the least that is taken.
  const double reach = std::min(double(all.height), std::max(1.0, std::ldexp(0.5, above))) / factor;
  const double to = double(all.height) / factor;
  const int height = std::min(rows, int(std::ceil(reach)) + 1);
  const int top = last ? rows - height : 0;
  const std::vector<double> pixels = this->ReadPixels(0, top, columns, height, factor);
  const BoxSpan span = last ? BoxSpan{to - reach - top, to - top} : BoxSpan{0.0, reach};
  const double mean =
      BoxMeans(pixels, columns, height, {{0.0, double(all.width) / factor}}, {span}).front();
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  return this->PoleHeights_[key] = mean;
}

void RasterPosts::ReadSubdivided(const PostBlock& block, float* heights) const {
  const int step = 1 << (this->Subdivisions_ - block.level); // parts a pixel
  const std::int64_t shift = this->Poles_ ? step / 2 : 0;    // rows from the pole to the pixels
  const std::int64_t first = block.row - shift;
  const std::int64_t column = FloorDiv(block.column, step);
  const std::int64_t row = FloorDiv(first, step);
  const int width = int(FloorDiv(block.column + block.width - 1, step) - column) + 2;
  const int height = int(FloorDiv(first + block.height - 1, step) - row) + 2;
  const std::vector<double> pixels = this->ReadPixels(column, row, width, height, 1);
  const std::int64_t lastRow = this->Source_->Info().window.height - 1;
  for (int j = 0; j < block.height; ++j) {
    const std::int64_t r = FloorDiv(first + j, step) - row;
    const double v = double(first + j - (r + row) * step) / step;
    const bool north = r + row == -1;
    const bool south = r + row == lastRow && v > 0.0;
    if (this->Poles_ && (north || south)) {
      const double pole = this->PoleHeight(block.level, south);
      const double share = north ? 2.0 * v - 1.0 : 1.0 - 2.0 * v; // of the row of pixels
      for (int i = 0; i < block.width; ++i) {
        const std::int64_t c = FloorDiv(block.column + i, step) - column;
        const double u = double(block.column + i - (c + column) * step) / step;
        const double* p = pixels.data() + (r + (north ? 1 : 0)) * width + c;
        const double along = u == 0.0 ? p[0] : p[0] + u * (p[1] - p[0]);
        heights[std::size_t(j) * block.width + i] =
            float(share == 0.0 ? pole : pole + share * (along - pole));
      }
      continue;
    }
    for (int i = 0; i < block.width; ++i) {
      const std::int64_t c = FloorDiv(block.column + i, step) - column;
      const double u = double(block.column + i - (c + column) * step) / step;
      const double* p = pixels.data() + r * width + c;
      heights[std::size_t(j) * block.width + i] =
          float(OnTriangles(p[0], p[1], p[width], p[width + 1], u, v));
    }
  }
}

void RasterPosts::ReadMeans(const PostBlock& block, float* heights) const {
  const RasterWindow all = this->Source_->Info().window;
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
  const std::int64_t left = FloorDiv(std::int64_t(std::floor(columns.front().from)), factor);
  const std::int64_t right = FloorDiv(std::int64_t(std::ceil(columns.back().to)) - 1, factor) + 1;
  const std::int64_t top = FloorDiv(std::int64_t(std::floor(rows.front().from)), factor);
  const std::int64_t bottom = FloorDiv(std::int64_t(std::ceil(rows.back().to)) - 1, factor) + 1;
  const int width = int(right - left);
  const int height = int(bottom - top);
  const std::vector<double> pixels = this->ReadPixels(left, top, width, height, factor);
  for (BoxSpan& span : columns) {
    span = {span.from / factor - double(left), span.to / factor - double(left)};
  }
  for (BoxSpan& span : rows) {
    span = {span.from / factor - double(top), span.to / factor - double(top)};
  }
  const std::vector<double> means = BoxMeans(pixels, width, height, columns, rows);
  std::transform(means.begin(), means.end(), heights, [](double h) { return float(h); });
  const std::int64_t last = this->Lattice_.RowsAt(block.level) - 1;
  for (int j = 0; this->Poles_ && j < block.height; ++j) {
    if (block.row + j == 0 || block.row + j == last) {
      std::fill_n(heights + std::size_t(j) * block.width, block.width,
                  float(this->PoleHeight(block.level, block.row + j == last)));
    }
  }
}

void RasterPosts::Read(const PostBlock& block, float* heights) const {
  // With poles, the rows of level `subdivisions` already stand between those of pixels.
  if (block.level <= this->Subdivisions_ - (this->Poles_ ? 1 : 0)) {
    this->ReadSubdivided(block, heights);
  } else {
    this->ReadMeans(block, heights);
  }
  // What lies outside the lattice is no post.
  const std::int64_t columns = this->Lattice_.ColumnsAt(block.level);
  const std::int64_t posts = this->Lattice_.RowsAt(block.level);
  for (int j = 0; j < block.height; ++j) {
    const bool rowOutside = block.row + j < 0 || block.row + j >= posts;
    for (int i = 0; i < block.width; ++i) {
      const bool outside =
          !this->Lattice_.periodic && (block.column + i < 0 || block.column + i >= columns);
      if (rowOutside || outside) {
        heights[std::size_t(j) * block.width + i] = std::numeric_limits<float>::quiet_NaN();
      }
    }
  }
}

} // namespace dspace
