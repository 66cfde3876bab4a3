#include <dspace/layers/raster/RasterLevels.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Error.h>
#include <dspace/layers/raster/ImageLayer.h>
#include <dspace/layers/raster/RasterOverviews.h>
#include <dspace/layers/raster/RasterPixels.h>
#include <dspace/raster/NetworkScope.h>
#include <dspace/raster/OpeningLimit.h>

namespace dspace {
namespace {

const char* const Changed = "the file has changed since it was opened; open it again";
constexpr int Large = 4096;                               // pixels a side
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

RasterLevels::RasterLevels(std::string object, std::string path, int band,
                           const RasterLayerOptions& options, RasterShown shown)
    : Object_(std::move(object)), Path_(std::move(path)), Network_(options.network),
      Check_(FilesGuard::Current()) {
  CheckLimits(options.network, this->Object_);
  this->File_ = FileState::Of(this->Path_);
  DatasetPointer file = OpenRaster(this->Path_, this->Network_, this->Warnings_, this->Object_);
  const NetworkScope scope(this->Network_, this->Path_);
  this->Remote_ = IsRemote(this->Path_) || IsRemoteMosaic(*file);
  this->Content_ = RasterContent::Of(*file, band, shown, this->Object_, this->Warnings_);
  auto handle = std::make_unique<RasterHandle>();
  handle->levels = this->Content_.LevelsOf(*file);
  this->FileLevels_ = handle->levels.size();
  const bool alone = this->FileLevels_ == 1;
  if (this->Remote_ && alone && std::max(this->Width(), this->Height()) > Large) {
    this->Warnings_.push_back(this->Object_ +
                              " has no overviews and is on a server: distant views show single "
                              "pixels instead of means; build overviews (gdaladdo -r average)");
  }
  this->Overviews_ = std::make_unique<RasterOverviews>(this->Object_, this->Path_, this->File_,
                                                       this->Content_, shown);
  if (!this->Remote_ && alone) {
    this->Overviews_->Plan(*file, options.cacheFolder);
  }
  this->Pixels_ = std::make_unique<RasterPixels>(this->Object_, this->Path_, this->Content_, shown,
                                                 this->Remote_, *this->Overviews_);
  this->Pixels_->PlanCaching(*file, this->FileLevels_, this->Warnings_);
  handle->file = std::move(file);
  this->Idle_.push_back(std::move(handle));
}

RasterLevels::~RasterLevels() = default;

std::size_t RasterLevels::KeptBytes() const {
  return this->Pixels_->CachedBytes();
}

void RasterLevels::SetBias(double bias) {
  this->Pixels_->SetBias(bias);
}

double RasterLevels::Bias() const {
  return this->Pixels_->Bias();
}

std::unique_ptr<RasterHandle> RasterLevels::Open() const {
  std::vector<std::string> known; // the constructor has reported them
  auto handle = std::make_unique<RasterHandle>();
  handle->file = OpenRaster(this->Path_, this->Network_, known, this->Object_);
  if (!this->Content_.Matches(*handle->file)) {
    throw Error(Error::Kind::Io, this->Object_,
                "it is another raster than when it was opened; open it again");
  }
  handle->levels = this->Content_.LevelsOf(*handle->file);
  if (handle->levels.size() != this->FileLevels_) {
    throw Error(Error::Kind::Io, this->Object_,
                "it has other overviews than when it was opened; open it again");
  }
  return handle;
}

// After a failed read GDAL may treat unread blocks as blocks that the file leaves out. The handle
// is then not used again.
void RasterLevels::WithHandle(const std::function<void(RasterHandle&)>& use) const {
  if (this->File_.ChangedInPlace(this->Path_)) {
    throw Error(Error::Kind::Io, this->Object_, Changed);
  }
  const NetworkScope scope(this->Network_, this->Path_);
  const FilesGuard guard(this->Check_);
  std::unique_ptr<RasterHandle> handle;
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    if (!this->Idle_.empty()) {
      handle = std::move(this->Idle_.back());
      this->Idle_.pop_back();
    }
  }
  if (!handle) {
    handle = this->Open();
  }
  this->Overviews_->Add(*handle);
  use(*handle);
  if (this->File_.ChangedInPlace(this->Path_)) {
    throw Error(Error::Kind::Io, this->Object_, Changed);
  }
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->Idle_.push_back(std::move(handle));
}

void RasterLevels::Read(const LevelWindow& window, float* cells) const {
  const auto read = [this](RasterHandle& handle, const LevelWindow& part, float* to) {
    this->ReadCells(handle, part, to);
  };
  this->Overviews_->Make(window, {[this] { return this->Open(); }, read, this->Bias()});
  this->WithHandle([&](RasterHandle& handle) { this->ReadCells(handle, window, cells); });
}

void RasterLevels::ReadValues(const RasterWindow& part, double* values) const {
  const std::size_t count = std::size_t(part.width) * part.height;
  std::vector<float> opacities(count);
  this->WithHandle([&](RasterHandle& handle) {
    const RasterLevel& level = handle.levels[0];
    if (const auto kept = this->Pixels_->CachedLevel(level, 0)) {
      for (int y = 0; y < part.height; ++y) {
        const std::size_t to = std::size_t(y) * part.width;
        this->Pixels_->Values(level, *kept, std::size_t(part.row + y) * level.width + part.column,
                              part.width, values + to, &opacities[to]);
      }
      return;
    }
    RasterPixels::Raw raw;
    this->Pixels_->Read(level, part, part.width, part.height, raw);
    this->Pixels_->Values(level, raw, 0, count, values, opacities.data());
  });
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = opacities[i] > 0.0f ? values[i] : std::numeric_limits<double>::quiet_NaN();
  }
}

void RasterLevels::ReadCells(RasterHandle& handle, const LevelWindow& window, float* cells) const {
  const int columns = this->ColumnsAt(window.levelX);
  const int rows = this->RowsAt(window.levelY);
  const RasterLevel* level = &handle.levels[0];
  for (const RasterLevel& other : handle.levels) { // ever coarser
    if (other.width >= columns && other.height >= rows) {
      level = &other;
    }
  }
  const double pixelsX = double(level->width) / columns;
  const double pixelsY = double(level->height) / rows;
  const int step = this->Channels() + 1;
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
  RasterPixels::Raw raw;
  if (this->Remote_ && std::max(pixelsX, pixelsY) > ManyPixels) {
    part.height = bottom - top;
    this->Pixels_->Read(*level, part, window.width, window.height, raw);
    this->Pixels_->Convert(*level, raw, 0, std::size_t(window.width) * window.height, cells);
    return;
  }
  const std::shared_ptr<const RasterPixels::Raw> kept =
      this->Pixels_->CachedLevel(*level, std::size_t(level - handle.levels.data()));
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
      this->Pixels_->Read(*level, part, part.width, part.height, raw);
    }
    for (int y = part.row; y < part.row + part.height; ++y) {
      const std::size_t first = kept ? std::size_t(y) * level->width + part.column
                                     : std::size_t(y - part.row) * part.width;
      if (same) {
        this->Pixels_->Convert(*level, kept ? *kept : raw, first, part.width,
                               cells + std::size_t(y - top) * row.size());
        continue;
      }
      this->Pixels_->Convert(*level, kept ? *kept : raw, first, part.width, row.data());
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
  const OpeningLimit limit;
  const double pixels = double(this->Width()) * this->Height();
  exact = pixels <= Most;
  int level = 0;
  this->WithHandle([&](RasterHandle& handle) {
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
  std::vector<float> cells(std::size_t(columns) * height * (this->Channels() + 1));
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int row = 0; row < rows; row += height * every) {
    const int some = std::min(height, rows - row);
    this->Read({level, level, 0, row, columns, some}, cells.data());
    for (std::size_t i = 0; i < std::size_t(columns) * some; ++i) {
      const double opacity = cells[2 * i + 1];
      if (opacity > 0.0) {
        const double value = cells[2 * i] / opacity + this->Bias();
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
  }
  if (!(low <= high)) {
    throw Error(Error::Kind::Corrupt, this->Object_, "all of its values are no-data");
  }
  return {low, high};
}

} // namespace dspace
