// Averaged overviews of a large raster without any: a TIFF a level, beside nothing but themselves.
#include <dspace/layers/raster/RasterLevels.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <cpl_vsi.h>

#include <dspace/AtomicFile.h>
#include <dspace/Error.h>
#include <dspace/layers/raster/ImageLayer.h>
#include <dspace/raster/ElevationCache.h>

#include <dspace/raster/CachedLayers.h>

namespace dspace {
namespace {

constexpr int FirstLevel = 2; // a sixteenth of the pixels; finer ones are read from the raster
constexpr int Smallest = 512; // cells a side of the coarsest
constexpr int NeedsOverviews = 4096; // pixels a side, of a raster that needs them
constexpr std::size_t PartCells = std::size_t(1) << 20; // that are written at once
const char* const IdentityItem = "DSPACE_SOURCE";

} // namespace

void RasterLevels::PlanOverviews(GDALDataset& file, const std::string& folder, bool hasOwn) {
  if (this->Remote_ || hasOwn || std::max(this->Width_, this->Height_) <= NeedsOverviews) {
    return;
  }
  static std::atomic<int> count{0};
  const bool holes = this->Shown_ == Shown::Holes;
  this->Identity_ = std::string("1: ") + (holes ? "holes of " : "") + "band " +
                    std::to_string(this->Band_) + " of " + std::to_string(this->Width_) + " x " +
                    std::to_string(this->Height_) + " x " + std::to_string(this->Bands_) +
                    FilesOf(file);
  this->InMemory_ = folder.empty();
  const std::string place =
      this->InMemory_ ? "/vsimem/dspace-layer-" + std::to_string(count++) : folder;
  const std::string name = ElevationCache::FileFor(place, this->Path_, this->Band_);
  this->OverviewStem_ = name.substr(0, name.rfind('.')) + (holes ? "-layer-holes-" : "-layer-");
  this->Folder_ = place;
}

std::string RasterLevels::OverviewFileOf(int level) const {
  return this->OverviewStem_ + std::to_string(level) + ".tif";
}

void RasterLevels::RemoveOverviews() const {
  const GdalErrors quiet;
  this->OverviewsReady_ = false;
  for (int level = FirstLevel; !this->OverviewStem_.empty() && level < 31; ++level) {
    VSIUnlink(this->OverviewFileOf(level).c_str());
  }
}

bool RasterLevels::AddOverview(Handle& handle, int level) const {
  const GdalErrors quiet;
  DatasetPointer file = OpenOwnTiff(this->OverviewFileOf(level));
  const char* identity = file ? file->GetMetadataItem(IdentityItem) : nullptr;
  if (!identity || identity != this->Identity_ ||
      file->GetRasterXSize() != this->ColumnsAt(level) ||
      file->GetRasterYSize() != this->RowsAt(level) ||
      file->GetRasterCount() != this->Channels_ + 1) {
    return false;
  }
  Level cells;
  cells.width = file->GetRasterXSize();
  cells.height = file->GetRasterYSize();
  cells.cached = true;
  for (int k = 1; k <= this->Channels_; ++k) {
    cells.colors.push_back(file->GetRasterBand(k));
  }
  cells.alpha = file->GetRasterBand(this->Channels_ + 1);
  handle.levels.push_back(std::move(cells));
  handle.overviews.push_back(std::move(file));
  return true;
}

// All that there are, once they are ready.
void RasterLevels::AddOverviews(Handle& handle) const {
  if (!this->OverviewsReady_ || !handle.overviews.empty()) {
    return;
  }
  for (int level = FirstLevel; this->AddOverview(handle, level); ++level) {
    if (std::max(this->ColumnsAt(level), this->RowsAt(level)) <= Smallest) {
      return;
    }
  }
  this->OverviewsReady_ = false; // somebody has removed them: they are made again
}

// Whoever comes first makes them, the others wait.
void RasterLevels::MakeOverviews(const LevelWindow& window) const {
  if (this->OverviewStem_.empty() || this->OverviewsReady_ ||
      std::min(window.levelX, window.levelY) < FirstLevel) {
    return;
  }
  const std::lock_guard<std::mutex> lock(this->Making_);
  if (this->OverviewsReady_) {
    return;
  }
  if (!this->InMemory_) {
    std::error_code failure;
    std::filesystem::create_directories(this->Folder_, failure);
    if (failure) {
      throw Error(Error::Kind::Io, "cache folder '" + this->Folder_ + "'",
                  "cannot be made: " + failure.message());
    }
  }
  std::vector<std::string> known;
  const std::unique_ptr<Handle> handle = this->Open(known);
  for (int level = FirstLevel;; ++level) {
    if (!this->AddOverview(*handle, level)) {
      this->WriteOverview(*handle, level);
      if (!this->AddOverview(*handle, level)) {
        throw Error(Error::Kind::Io, this->Object_,
                    "its overviews in '" + this->Folder_ + "' cannot be read back");
      }
    }
    if (std::max(this->ColumnsAt(level), this->RowsAt(level)) <= Smallest) {
      break;
    }
  }
  this->OverviewsReady_ = true;
}

// Straight colours of 8 bits, or values as doubles; opacity 0 to 255.
void RasterLevels::WriteOverview(Handle& handle, int level) const {
  const int step = this->Channels_ + 1;
  const int columns = this->ColumnsAt(level);
  const int rows = this->RowsAt(level);
  const std::string target = this->OverviewFileOf(level);
  std::optional<AtomicFile> disk; // removes what is not committed
  if (!this->InMemory_) {
    disk.emplace(target, this->Object_ + ", overviews '" + target + "'");
  }
  const std::string part = disk ? disk->TemporaryPath() : target + ".part";
  const auto discard = [&] {
    if (!disk) {
      VSIUnlink(part.c_str());
    }
  };
  GdalErrors errors;
  const auto check = [&](bool good) {
    if (!good || errors.Failed()) {
      discard();
      throw Error(Error::Kind::Io, this->Object_,
                  "its overviews cannot be written to '" + this->Folder_ +
                      "': " + errors.Message("GDAL gave no reason"));
    }
  };
  const char* const options[] = {"TILED=YES",        "COMPRESS=DEFLATE", "ZLEVEL=1",
                                 "BIGTIFF=IF_SAFER", "INTERLEAVE=BAND",  nullptr};
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  DatasetPointer file(driver ? driver->Create(part.c_str(), columns, rows, step,
                                              this->Band_ > 0 ? GDT_Float64 : GDT_Byte,
                                              const_cast<char**>(options))
                             : nullptr);
  check(file != nullptr);
  file->SetMetadataItem(IdentityItem, this->Identity_.c_str());
  file->SetMetadataItem(LayerPathItem, this->Path_.c_str());
  const int height = int(std::clamp<std::size_t>(PartCells / columns / 256 * 256, 256, 4096));
  std::vector<float> cells;
  std::vector<double> straight;
  for (int row = 0; row < rows; row += height) {
    const int some = std::min(height, rows - row);
    const std::size_t size = std::size_t(columns) * some;
    cells.resize(size * step);
    straight.resize(size * step);
    try {
      this->ReadCells(handle, {level, level, 0, row, columns, some}, cells.data());
    } catch (const Error&) {
      file.reset();
      discard();
      throw;
    }
    for (std::size_t i = 0; i < size; ++i) {
      const double opacity = cells[i * step + this->Channels_];
      for (int k = 0; k < this->Channels_; ++k) {
        straight[i * step + k] = opacity > 0.0 ? cells[i * step + k] / opacity + this->Bias_ : 0.0;
      }
      straight[i * step + this->Channels_] = 255.0 * opacity;
    }
    const auto pixel = GSpacing(step * sizeof(double));
    check(file->RasterIO(GF_Write, 0, row, columns, some, straight.data(), columns, some,
                         GDT_Float64, step, nullptr, pixel, pixel * columns, sizeof(double),
                         nullptr) == CE_None);
  }
  file.reset(); // writes what is left
  check(!this->File_.ChangedInPlace(this->Path_));
  if (disk) {
    disk->Commit();
  } else {
    check(VSIRename(part.c_str(), target.c_str()) == 0);
  }
}

} // namespace dspace
