// Opening a raster, what it holds, and handles for threads.
#include <dspace/layers/raster/RasterLevels.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>
#include <dspace/Utf8.h>
#include <dspace/layers/raster/ImageLayer.h>

#include <dspace/raster/NetworkScope.h>

namespace dspace {
namespace {

const char* const Changed = "the file has changed since it was opened; open it anew";
constexpr int Large = 4096; // pixels a side

// The greatest value of a colour channel.
double Most(GDALRasterBand& band) {
  const int bits = band.GetRasterDataType() == GDT_Byte ? 8 : 16;
  const char* fewer = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
  const int used = fewer ? std::clamp(std::atoi(fewer), 1, bits) : bits;
  return std::ldexp(1.0, used) - 1.0;
}

} // namespace

RasterLevels::RasterLevels(std::string object, std::string path, int band,
                           const RasterLayerOptions& options, Shown shown)
    : Object_(std::move(object)), Path_(std::move(path)), Band_(band), Shown_(shown),
      Network_(options.network), Look_(FilesGuard::Current()) {
  CheckLimits(options.network, this->Object_);
  this->File_ = FileState::Of(this->Path_);
  DatasetPointer file = OpenRaster(this->Path_, this->Network_, this->Warnings_, this->Object_);
  const NetworkScope scope(this->Network_, this->Path_);
  this->Remote_ = IsRemote(this->Path_) || IsRemoteMosaic(*file);
  this->Inspect(*file);
  auto handle = std::make_unique<Handle>();
  this->AddLevels(*file, handle->levels);
  if (this->Remote_ && handle->levels.size() == 1 &&
      std::max(this->Width_, this->Height_) > Large) {
    this->Warnings_.push_back(this->Object_ +
                              " has no overviews and lies on a server: far away single pixels of "
                              "it are shown, no means; build overviews (gdaladdo -r average)");
  }
  this->PlanOverviews(*file, options.cacheFolder, handle->levels.size() > 1);
  this->PlanKeeping(*file);
  this->Kept_.resize(handle->levels.size());
  handle->file = std::move(file);
  this->Idle_.push_back(std::move(handle));
}

RasterLevels::~RasterLevels() {
  this->Idle_.clear();
  if (this->InMemory_) {
    this->RemoveOverviews();
  }
}

void RasterLevels::Inspect(GDALDataset& file) {
  GdalErrors errors;
  this->Width_ = file.GetRasterXSize();
  this->Height_ = file.GetRasterYSize();
  this->Bands_ = file.GetRasterCount();
  if (this->Bands_ < 1) {
    throw Error(Error::Kind::Unsupported, this->Object_,
                "it holds no band itself; name one of its subdatasets (gdalinfo lists them)");
  }
  if (this->Band_ > 0) {
    if (this->Band_ > this->Bands_) {
      throw Error(Error::Kind::InvalidArgument, this->Object_,
                  "band " + std::to_string(this->Band_) + " asked for; accepted are 1 to " +
                      std::to_string(this->Bands_));
    }
    this->InspectBand(*file.GetRasterBand(this->Band_));
  } else {
    this->InspectImage(file);
  }
  double g[6];
  if (file.GetGeoTransform(g) == CE_None) {
    this->Place_.placed = true;
    this->Place_.pixelToMap.linear() << g[1], g[2], g[4], g[5];
    this->Place_.pixelToMap.translation() << g[0], g[3];
  } else if (file.GetGCPCount() > 0) {
    this->Warnings_.push_back(this->Object_ + " has ground control points, which are not used: "
                                              "warp it first (gdalwarp)");
  }
  if (const OGRSpatialReference* srs = file.GetSpatialRef()) {
    this->Place_.crs = Crs::FromOgr(*srs);
  }
  errors.Check(Error::Kind::Corrupt, this->Object_);
  this->Warnings_.insert(this->Warnings_.end(), errors.Warnings().begin(), errors.Warnings().end());
}

void RasterLevels::InspectBand(GDALRasterBand& band) {
  this->Type_ = band.GetRasterDataType();
  if (GDALDataTypeIsComplex(this->Type_)) {
    throw Error(Error::Kind::Unsupported, this->Object_,
                std::string("complex values (") + GDALGetDataTypeName(this->Type_) +
                    ") have no order to be coloured by");
  }
  this->Channels_ = 1;
  int stated = 0;
  const double scale = band.GetScale(&stated);
  this->Scale_ = stated ? scale : 1.0;
  const double offset = band.GetOffset(&stated);
  this->Offset_ = stated ? offset : 0.0;
  if (!std::isfinite(this->Scale_) || this->Scale_ == 0.0 || !std::isfinite(this->Offset_)) {
    throw Error(Error::Kind::Corrupt, this->Object_,
                "its scale of " + std::to_string(this->Scale_) + " and offset of " +
                    std::to_string(this->Offset_) + " are no numbers to be used");
  }
  this->AlphaScale_ = 1.0 / 255.0;
  this->Unit_ = ToUtf8(band.GetUnitType() ? band.GetUnitType() : "");
}

void RasterLevels::InspectImage(GDALDataset& file) {
  if (this->Bands_ > 4) {
    throw Error(Error::Kind::Unsupported, this->Object_,
                "it has " + std::to_string(this->Bands_) +
                    " bands; accepted are 1 (grey) to 4 (RGBA), or one of them in false colour");
  }
  GDALRasterBand& first = *file.GetRasterBand(1);
  this->Type_ = first.GetRasterDataType();
  for (int k = 1; k <= this->Bands_; ++k) {
    const GDALDataType type = file.GetRasterBand(k)->GetRasterDataType();
    if (type != this->Type_ || (type != GDT_Byte && type != GDT_UInt16)) {
      throw Error(Error::Kind::Unsupported, this->Object_,
                  std::string("its values are ") + GDALGetDataTypeName(type) +
                      "; accepted are Byte or UInt16 in all bands, 8 or 16 bits a channel; other "
                      "values show in false colour");
    }
  }
  this->Channels_ = this->Bands_ < 3 ? 1 : 3;
  this->Alpha_ = this->Bands_ == 2 || this->Bands_ == 4;
  this->Scale_ = 255.0 / Most(first);
  if (this->Alpha_) {
    GDALRasterBand& alpha = *file.GetRasterBand(this->Bands_);
    this->AlphaScale_ = 1.0 / Most(alpha);
    if (alpha.GetColorInterpretation() != GCI_AlphaBand) {
      this->Warnings_.push_back(this->Object_ + " has " + std::to_string(this->Bands_) +
                                " bands: the last is taken as opacity");
    }
  }
  const GDALColorTable* table = this->Bands_ == 1 ? first.GetColorTable() : nullptr;
  if (table && table->GetColorEntryCount() > 0) {
    this->Channels_ = 3;
    for (int i = 0; i < table->GetColorEntryCount(); ++i) {
      GDALColorEntry rgb = {};
      table->GetColorEntryAsRGB(i, &rgb);
      this->Palette_.push_back({float(rgb.c1), float(rgb.c2), float(rgb.c3),
                                float(table->GetColorEntry(i)->c4) / 255.0f});
    }
  }
}

// Overviews count where every band has them, and the mask as well.
void RasterLevels::AddLevels(GDALDataset& file, std::vector<Level>& levels) const {
  const int first = this->Band_ > 0 ? this->Band_ : 1;
  const int colors = this->Band_ > 0 ? 1 : this->Bands_ - (this->Alpha_ ? 1 : 0);
  const int overviews = file.GetRasterBand(first)->GetOverviewCount();
  for (int i = -1; i < overviews; ++i) {
    const auto bandOf = [&](int number) {
      GDALRasterBand* band = file.GetRasterBand(number);
      return i < 0 ? band : i < band->GetOverviewCount() ? band->GetOverview(i) : nullptr;
    };
    Level level;
    bool whole = true;
    const auto add = [&](int number) {
      GDALRasterBand* band = bandOf(number);
      whole = whole && band &&
              (level.width == 0 ||
               (band->GetXSize() == level.width && band->GetYSize() == level.height));
      if (whole) {
        level.width = band->GetXSize();
        level.height = band->GetYSize();
      }
      return band;
    };
    for (int k = 0; k < colors; ++k) {
      level.colors.push_back(add(first + k));
    }
    level.alpha = this->Alpha_ ? add(this->Bands_) : nullptr;
    const int flags = file.GetRasterBand(first)->GetMaskFlags();
    whole = whole && (this->Alpha_ || level.colors[0]->GetMaskFlags() == flags);
    whole = whole &&
            (i < 0 || (level.width < levels.back().width && level.height <= levels.back().height));
    if (!whole) {
      continue;
    }
    if (!level.alpha) {
      level.gaps = GivesZerosForGaps(*level.colors[0]);
      const auto masks = level.gaps                ? level.colors.begin()
                         : flags & GMF_PER_DATASET ? level.colors.begin() + 1
                                                   : level.colors.end();
      level.masks.assign(level.colors.begin(), masks);
    }
    levels.push_back(std::move(level));
  }
}

std::unique_ptr<RasterLevels::Handle> RasterLevels::Open(std::vector<std::string>& warnings) const {
  auto handle = std::make_unique<Handle>();
  handle->file = OpenRaster(this->Path_, this->Network_, warnings, this->Object_);
  GDALDataset& file = *handle->file;
  if (file.GetRasterXSize() != this->Width_ || file.GetRasterYSize() != this->Height_ ||
      file.GetRasterCount() != this->Bands_ ||
      file.GetRasterBand(std::max(1, this->Band_))->GetRasterDataType() != this->Type_) {
    throw Error(Error::Kind::Io, this->Object_,
                "it is another raster than when it was opened; open it anew");
  }
  this->AddLevels(file, handle->levels);
  if (handle->levels.size() != this->Kept_.size()) {
    throw Error(Error::Kind::Io, this->Object_,
                "it has other overviews than when it was opened; open it anew");
  }
  return handle;
}

// After a failed read GDAL may take what it could not read for what the file leaves out: such a
// handle is not used again.
void RasterLevels::With(const std::function<void(Handle&)>& use) const {
  if (this->File_.ChangedInPlace(this->Path_)) {
    throw Error(Error::Kind::Io, this->Object_, Changed);
  }
  const NetworkScope scope(this->Network_, this->Path_);
  const FilesGuard guard(this->Look_);
  std::unique_ptr<Handle> handle;
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    if (!this->Idle_.empty()) {
      handle = std::move(this->Idle_.back());
      this->Idle_.pop_back();
    }
  }
  if (!handle) {
    std::vector<std::string> known;
    handle = this->Open(known);
  }
  this->AddOverviews(*handle);
  use(*handle);
  if (this->File_.ChangedInPlace(this->Path_)) {
    throw Error(Error::Kind::Io, this->Object_, Changed);
  }
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->Idle_.push_back(std::move(handle));
}

} // namespace dspace
