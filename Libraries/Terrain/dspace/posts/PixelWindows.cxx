#include <dspace/posts/PixelWindows.h>

#include <algorithm>
#include <limits>
#include <utility>

#include <dspace/posts/PostLattice.h>

namespace dspace {

PixelWindows::PixelWindows(std::shared_ptr<const ElevationSource> source, bool periodic)
    : Source_(std::move(source)), Few_(Source_), Periodic_(periodic) {}

std::vector<double> PixelWindows::Read(std::int64_t column, std::int64_t row, int width, int height,
                                       int factor) const {
  const RasterWindow all = this->Whole();
  const std::int64_t columns = 1 + (all.width - 1) / factor;
  const std::int64_t rows = 1 + (all.height - 1) / factor;
  std::vector<double> pixels(static_cast<std::size_t>(width) * height,
                             std::numeric_limits<double>::quiet_NaN());
  const std::int64_t top = std::clamp<std::int64_t>(row, 0, rows);
  const std::int64_t bottom = std::clamp<std::int64_t>(row + height, 0, rows);
  std::int64_t c = column;
  std::int64_t end = column + width;
  if (!this->Periodic_) {
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
    const bool few = factor == 1 && window.width * std::int64_t(window.height) <= PixelTiles::Most;
    const std::vector<double> part =
        few ? this->Few_.Read(window) : this->Source_->ReadReduced(window, factor);
    for (std::int64_t r = top; r < bottom; ++r) {
      std::copy_n(part.begin() + (r - top) * run, run,
                  pixels.begin() + (r - row) * width + (c - column));
    }
    c += run;
  }
  return pixels;
}

} // namespace dspace
