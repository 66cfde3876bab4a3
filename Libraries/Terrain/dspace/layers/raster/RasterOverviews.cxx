#include <dspace/layers/raster/RasterOverviews.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>

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

RasterOverviews::RasterOverviews(std::string object, std::string path, FileState state,
                                 const RasterContent& content, RasterShown shown)
    : Object_(std::move(object)), Path_(std::move(path)), File_(state), Content_(content),
      Shown_(shown) {}

RasterOverviews::~RasterOverviews() {
  if (this->InMemory_) {
    this->Remove();
  }
}

void RasterOverviews::Plan(GDALDataset& file, const std::string& folder) {
  const RasterContent& content = this->Content_;
  if (std::max(content.width, content.height) <= NeedsOverviews) {
    return;
  }
  const bool holes = this->Shown_ == RasterShown::Holes;
  this->Identity_ = std::string("1: ") +
                    (holes             ? "holes of "
                     : content.vectors ? "vectors of "
                                       : "") +
                    "band " + std::to_string(content.band) + " of " +
                    std::to_string(content.width) + " x " + std::to_string(content.height) + " x " +
                    std::to_string(content.bands) + FilesOf(file);
  this->InMemory_ = folder.empty();
  this->Folder_ = folder;
  if (this->InMemory_) {
    std::ostringstream own; // no other object has this address at the same time
    own << "/vsimem/dspace-layer-" << this;
    this->Folder_ = own.str();
  }
  const std::string name = ElevationCache::FileFor(this->Folder_, this->Path_, content.band);
  this->Stem_ = name.substr(0, name.rfind('.')) + (holes             ? "-layer-holes-"
                                                   : content.vectors ? "-layer-vectors-"
                                                                     : "-layer-");
}

bool RasterOverviews::IsCoarsest(int level) const {
  return std::max(this->Content_.ColumnsAt(level), this->Content_.RowsAt(level)) <= Smallest;
}

std::string RasterOverviews::FileOf(int level) const {
  return this->Stem_ + std::to_string(level) + ".tif";
}

void RasterOverviews::Remove() {
  const GdalErrors quiet;
  this->Ready_ = false;
  for (int level = FirstLevel; !this->Stem_.empty() && level < 31; ++level) {
    VSIUnlink(this->FileOf(level).c_str());
  }
}

bool RasterOverviews::AddLevel(RasterHandle& handle, int level) {
  const GdalErrors quiet;
  DatasetPointer file = OpenOwnTiff(this->FileOf(level));
  const char* identity = file ? file->GetMetadataItem(IdentityItem) : nullptr;
  if (!identity || identity != this->Identity_ ||
      file->GetRasterXSize() != this->Content_.ColumnsAt(level) ||
      file->GetRasterYSize() != this->Content_.RowsAt(level) ||
      file->GetRasterCount() != this->Content_.channels + 1) {
    return false;
  }
  RasterLevel cells;
  cells.width = file->GetRasterXSize();
  cells.height = file->GetRasterYSize();
  cells.cached = true;
  for (int k = 1; k <= this->Content_.channels; ++k) {
    cells.colors.push_back(file->GetRasterBand(k));
  }
  cells.alpha = file->GetRasterBand(this->Content_.channels + 1);
  handle.levels.push_back(std::move(cells));
  handle.overviews.push_back(std::move(file));
  return true;
}

void RasterOverviews::Add(RasterHandle& handle) {
  if (!this->Ready_ || !handle.overviews.empty()) {
    return;
  }
  for (int level = FirstLevel; this->AddLevel(handle, level); ++level) {
    if (this->IsCoarsest(level)) {
      return;
    }
  }
  this->Ready_ = false; // they were removed: Make() builds them again
}

void RasterOverviews::Make(const LevelWindow& window, const Access& access) {
  if (this->Stem_.empty() || this->Ready_ || std::min(window.levelX, window.levelY) < FirstLevel) {
    return;
  }
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  if (this->Ready_) {
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
  const std::unique_ptr<RasterHandle> handle = access.open();
  for (int level = FirstLevel;; ++level) {
    if (!this->AddLevel(*handle, level)) {
      this->WriteLevel(*handle, level, access);
      if (!this->AddLevel(*handle, level)) {
        throw Error(Error::Kind::Io, this->Object_,
                    "its overviews in '" + this->Folder_ + "' cannot be read back");
      }
    }
    if (this->IsCoarsest(level)) {
      break;
    }
  }
  this->Ready_ = true;
}

// Straight colours of 8 bits, or values or vectors as doubles; opacity 0 to 255.
void RasterOverviews::WriteLevel(RasterHandle& handle, int level, const Access& access) {
  const int step = this->Content_.channels + 1;
  const int columns = this->Content_.ColumnsAt(level);
  const int rows = this->Content_.RowsAt(level);
  const std::string target = this->FileOf(level);
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
                                              this->Content_.band > 0 || this->Content_.vectors
                                                  ? GDT_Float64
                                                  : GDT_Byte,
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
      access.read(handle, {level, level, 0, row, columns, some}, cells.data());
    } catch (const Error&) {
      file.reset();
      discard();
      throw;
    }
    for (std::size_t i = 0; i < size; ++i) {
      const double opacity = cells[i * step + this->Content_.channels];
      for (int k = 0; k < this->Content_.channels; ++k) {
        straight[i * step + k] = opacity > 0.0 ? cells[i * step + k] / opacity + access.bias : 0.0;
      }
      straight[i * step + this->Content_.channels] = 255.0 * opacity;
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
