#include <dspace/layers/raster/RasterLevels.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Error.h>

namespace dspace {
namespace {

constexpr std::size_t StripPixels = std::size_t(1) << 20; // that are in memory at once
constexpr double Tiny = 1e-9;                             // of a pixel
constexpr double ManyPixels = 8.0; // a side of a cell: too many to ask a server for

// Pixels of a line that a cell covers, and how much of the first and the last of them.
struct Cover {
  int first = 0;
  int last = 0;
  double firstPart = 1.0;
  double lastPart = 1.0;
  double Part(int pixel) const {
    return pixel == this->first ? this->firstPart : pixel == this->last ? this->lastPart : 1.0;
  }
};

Cover CoverOf(int cell, double pixelsACell, int pixels) {
  const double from = cell * pixelsACell;
  const double to = from + pixelsACell;
  Cover cover;
  cover.first = std::clamp(int(std::floor(from + Tiny)), 0, pixels - 1);
  cover.last = std::clamp(int(std::ceil(to - Tiny)) - 1, cover.first, pixels - 1);
  cover.firstPart = std::min(to, cover.first + 1.0) - from;
  cover.lastPart = cover.last == cover.first ? cover.firstPart : to - cover.last;
  return cover;
}

} // namespace

void RasterLevels::Read(const LevelWindow& window, float* cells) const {
  this->MakeOverviews(window);
  this->With([&](Handle& handle) { this->ReadCells(handle, window, cells); });
}

void RasterLevels::ReadCells(Handle& handle, const LevelWindow& window, float* cells) const {
  const int columns = this->ColumnsAt(window.levelX);
  const int rows = this->RowsAt(window.levelY);
  const Level* level = &handle.levels[0];
  for (const Level& other : handle.levels) { // ever coarser
    if (other.width >= columns && other.height >= rows) {
      level = &other;
    }
  }
  const double pixelsX = double(level->width) / columns;
  const double pixelsY = double(level->height) / rows;
  const int step = this->Channels_ + 1;
  std::vector<Cover> across;
  std::vector<float> parts; // of all pixels of all of them
  for (int i = 0; i < window.width; ++i) {
    across.push_back(CoverOf(window.column + i, pixelsX, level->width));
    for (int x = across.back().first; x <= across.back().last; ++x) {
      parts.push_back(float(across.back().Part(x) / pixelsX));
    }
  }
  const int top = CoverOf(window.row, pixelsY, level->height).first;
  const int bottom = CoverOf(window.row + window.height - 1, pixelsY, level->height).last + 1;
  RasterWindow part{across.front().first, top, across.back().last + 1 - across.front().first, 0};
  Raw raw;
  if (this->Remote_ && std::max(pixelsX, pixelsY) > ManyPixels) {
    part.height = bottom - top;
    this->ReadRaw(*level, part, window.width, window.height, raw);
    this->Convert(*level, raw, 0, std::size_t(window.width) * window.height, cells);
    return;
  }
  const std::shared_ptr<const Raw> kept = this->KeptOf(handle, *level);
  const bool same = level->width == columns && level->height == rows;
  if (!same) {
    std::fill_n(cells, std::size_t(window.width) * window.height * step, 0.0f);
  }
  std::vector<float> row(std::size_t(part.width) * step);
  std::vector<float> line(std::size_t(window.width) * step);
  int cell = 0; // the first whose rows are not all there
  const int most = int(std::clamp<std::size_t>(StripPixels / part.width, 1, 65536));
  for (part.row = top; part.row < bottom; part.row += part.height) {
    part.height = std::min(most, bottom - part.row);
    if (!kept) {
      this->ReadRaw(*level, part, part.width, part.height, raw);
    }
    for (int y = part.row; y < part.row + part.height; ++y) {
      const std::size_t first = kept ? std::size_t(y) * level->width + part.column
                                     : std::size_t(y - part.row) * part.width;
      if (same) {
        this->Convert(*level, kept ? *kept : raw, first, part.width,
                      cells + std::size_t(y - top) * row.size());
        continue;
      }
      this->Convert(*level, kept ? *kept : raw, first, part.width, row.data());
      std::fill(line.begin(), line.end(), 0.0f);
      const float* share = parts.data();
      for (int i = 0; i < window.width; ++i) {
        const Cover& cover = across[std::size_t(i)];
        float* to = &line[std::size_t(i) * step];
        for (int x = cover.first; x <= cover.last; ++x, ++share) {
          const float* pixel = &row[std::size_t(x - part.column) * step];
          for (int k = 0; k < step; ++k) {
            to[k] += *share * pixel[k];
          }
        }
      }
      for (int j = cell; j < window.height; ++j) {
        const Cover cover = CoverOf(window.row + j, pixelsY, level->height);
        if (cover.first > y) {
          break;
        }
        cell = cover.last < y ? j + 1 : cell;
        if (cover.last >= y) {
          const auto partY = float(cover.Part(y) / pixelsY);
          float* to = cells + std::size_t(j) * line.size();
          for (std::size_t i = 0; i < line.size(); ++i) {
            to[i] += partY * line[i];
          }
        }
      }
    }
  }
}

std::array<double, 2> RasterLevels::FindRange(bool& exact) const {
  constexpr double Most = double(1 << 24); // pixels that are all looked at
  constexpr double Few = double(1 << 22);
  const double pixels = double(this->Width_) * this->Height_;
  exact = pixels <= Most;
  int level = 0;
  this->With([&](Handle& handle) {
    while (!exact && pixels > std::ldexp(Few, 2 * level) &&
           handle.levels.back().width <= this->ColumnsAt(level + 1)) {
      ++level;
    }
  });
  // Without such an overview some rows of it.
  const int columns = this->ColumnsAt(level);
  const int rows = this->RowsAt(level);
  const int every = exact ? 1 : int(std::ceil(double(columns) * rows / Few));
  const int height = every > 1 ? 1 : int(std::clamp<std::size_t>(StripPixels / columns, 1, rows));
  std::vector<float> cells(std::size_t(columns) * height * (this->Channels_ + 1));
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int row = 0; row < rows; row += height * every) {
    const int some = std::min(height, rows - row);
    this->Read({level, level, 0, row, columns, some}, cells.data());
    for (std::size_t i = 0; i < std::size_t(columns) * some; ++i) {
      const double opacity = cells[2 * i + 1];
      if (opacity > 0.0) {
        const double value = cells[2 * i] / opacity + this->Bias_;
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
  }
  if (!(low <= high)) {
    throw Error(Error::Kind::Corrupt, this->Object_, "it holds no value that is not no-data");
  }
  return {low, high};
}

} // namespace dspace
