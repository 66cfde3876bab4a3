#include "RasterLevels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Error.h>
#include <dspace/layers/ImageLayer.h>

#include "../terrain/NetworkScope.h"

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

// Some rows of pixels of a level.
struct RasterLevels::Strip {
  std::vector<float> pixels; // channels times opacity, opacity
  std::vector<double> values;
  std::vector<std::uint8_t> mask;
  std::vector<std::uint8_t> other;
};

void RasterLevels::ReadPixels(const Level& level, const RasterWindow& part, int columns, int rows,
                              Strip& strip) const {
  const std::size_t count = std::size_t(columns) * rows;
  const int step = this->Channels_ + 1;
  const auto pixel = GSpacing(step * sizeof(float));
  GdalErrors errors;
  const auto check = [&](CPLErr result) {
    if (result == CE_None && !errors.Failed()) {
      return;
    }
    const std::string message = errors.Message("GDAL gave no reason");
    if (level.cached) {
      this->RemoveOverviews();
      throw Error(Error::Kind::Corrupt, this->Object_,
                  "its overviews in the cache are damaged; they are made anew: " + message);
    }
    if (this->Remote_) {
      ForgetAnswers(this->Path_);
      if (IsUnanswered(message)) {
        throw Error(Error::Kind::Io, this->Object_, "cannot be read: " + InWords(message));
      }
    }
    throw Error(Error::Kind::Corrupt, this->Object_, "cannot be read: " + message);
  };
  strip.pixels.resize(count * step);
  const auto read = [&](GDALRasterBand* band, int channel) {
    check(band->RasterIO(GF_Read, part.column, part.row, part.width, part.height,
                         strip.pixels.data() + channel, columns, rows, GDT_Float32, pixel,
                         pixel * columns, nullptr));
  };
  const auto readMask = [&](GDALRasterBand* band, std::vector<std::uint8_t>& mask) {
    mask.resize(count);
    check(band->GetMaskBand()->RasterIO(GF_Read, part.column, part.row, part.width, part.height,
                                        mask.data(), columns, rows, GDT_Byte, 0, 0, nullptr));
  };
  const bool values = this->Band_ > 0;
  if (values) { // may need more digits than a float has, until the bias is gone
    strip.values.resize(count);
    check(level.colors[0]->RasterIO(GF_Read, part.column, part.row, part.width, part.height,
                                    strip.values.data(), columns, rows, GDT_Float64, 0, 0,
                                    nullptr));
  } else {
    for (std::size_t k = 0; k < level.colors.size(); ++k) {
      read(level.colors[k], int(k));
    }
  }
  strip.mask.assign(count, 255);
  if (level.alpha) {
    read(level.alpha, this->Channels_);
  } else if (level.gaps) {
    MaskGaps(*level.colors[0], part, columns, rows, columns, strip.mask.data());
    check(CE_None);
  } else if (!level.masks.empty()) {
    readMask(level.masks[0], strip.mask);
    for (std::size_t k = 1; k < level.masks.size(); ++k) {
      readMask(level.masks[k], strip.other);
      for (std::size_t i = 0; i < count; ++i) {
        strip.mask[i] = std::max(strip.mask[i], strip.other[i]);
      }
    }
  }
  const float scale = level.cached || values ? 1.0f : float(this->Scale_);
  const float alphaScale = level.cached ? 1.0f / 255.0f : float(this->AlphaScale_);
  for (std::size_t i = 0; i < count; ++i) {
    float* p = &strip.pixels[i * step];
    float opacity = level.alpha ? p[this->Channels_] * alphaScale : strip.mask[i] / 255.0f;
    if (values) {
      const double value =
          level.cached ? strip.values[i] : strip.values[i] * this->Scale_ + this->Offset_;
      opacity = std::isfinite(value) ? opacity : 0.0f;
      p[0] = opacity > 0.0f ? float(value - this->Bias_) * opacity : 0.0f;
    } else if (!this->Palette_.empty() && !level.cached) {
      const auto index = std::clamp<long>(std::lround(p[0]), 0, long(this->Palette_.size()) - 1);
      const std::array<float, 4>& color = this->Palette_[std::size_t(index)];
      opacity *= color[3];
      for (int k = 0; k < 3; ++k) {
        p[k] = color[std::size_t(k)] * opacity;
      }
    } else {
      for (int k = 0; k < this->Channels_; ++k) {
        p[k] = opacity > 0.0f ? p[k] * scale * opacity : 0.0f;
      }
    }
    p[this->Channels_] = opacity;
  }
}

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
  const std::size_t count = std::size_t(window.width) * window.height * step;
  std::vector<Cover> across;
  for (int i = 0; i < window.width; ++i) {
    across.push_back(CoverOf(window.column + i, pixelsX, level->width));
  }
  const int top = CoverOf(window.row, pixelsY, level->height).first;
  const int bottom = CoverOf(window.row + window.height - 1, pixelsY, level->height).last + 1;
  RasterWindow part{across.front().first, top, across.back().last + 1 - across.front().first, 0};
  Strip strip;
  if (this->Remote_ && std::max(pixelsX, pixelsY) > ManyPixels) {
    part.height = bottom - top;
    this->ReadPixels(*level, part, window.width, window.height, strip);
    std::copy_n(strip.pixels.begin(), count, cells);
    return;
  }
  std::fill_n(cells, count, 0.0f);
  std::vector<float> line(std::size_t(window.width) * step);
  int cell = 0; // the first whose rows are not all there
  const int most = int(std::clamp<std::size_t>(StripPixels / part.width, 1, 65536));
  for (part.row = top; part.row < bottom; part.row += part.height) {
    part.height = std::min(most, bottom - part.row);
    this->ReadPixels(*level, part, part.width, part.height, strip);
    for (int y = part.row; y < part.row + part.height; ++y) {
      const float* pixels = &strip.pixels[std::size_t(y - part.row) * part.width * step];
      std::fill(line.begin(), line.end(), 0.0f);
      for (int i = 0; i < window.width; ++i) {
        const Cover& cover = across[std::size_t(i)];
        for (int x = cover.first; x <= cover.last; ++x) {
          const auto partX = float(cover.Part(x) / pixelsX);
          for (int k = 0; k < step; ++k) {
            line[std::size_t(i) * step + k] += partX * pixels[(x - part.column) * step + k];
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
