#include <dspace/raster/ElevationSource.h>

#include <cmath>
#include <limits>
#include <mutex>
#include <sstream>

#include <gdal_priv.h>

#include <dspace/Error.h>
#include <dspace/FilesRead.h>
#include <dspace/raster/ElevationCache.h>

#include <dspace/gdal/GdalErrors.h>
#include <dspace/raster/DeflateCheck.h>
#include <dspace/raster/ElevationMetadata.h>
#include <dspace/raster/NetworkScope.h>
#include <dspace/raster/OpenRaster.h>
#include <dspace/raster/OpeningLimit.h>
#include <dspace/raster/OverviewFile.h>

namespace dspace {

namespace {

constexpr int RowsAtOnce = 16; // while an OpeningLimit lives

const char* const Changed = "the file has changed since it was opened; open it again";

} // namespace

struct ElevationSource::Implementation {
  mutable std::mutex mutex;
  DatasetPointer dataset;
  GDALRasterBand* band = nullptr;
  int bandNumber = 1;
  NetworkLimits network;
  FilesGuard::Check look;       // of the guard under which it was opened
  bool remote = false;          // itself, or what it is a mosaic of
  bool suspect = false;         // a read failed
  std::optional<double> noData; // of the options, as the band's type holds it
  bool ownOverviews = false;    // overviews of the file may be used
  bool gaps = false;            // there may be some, see GivesZerosForGaps
  FileState file;
  std::unique_ptr<DeflateCheck> checksums; // of a file on a disk
  std::shared_ptr<const OverviewFile> overviews;
  std::string cached; // where they are, if they are; empty: nowhere

  // After a failed read GDAL may take what it could not read for blocks that the file leaves out,
  // and give zeros. With the mutex held.
  void OpenAnew(const std::string& path) {
    std::vector<std::string> warnings;
    DatasetPointer fresh = OpenRaster(path, this->network, warnings);
    if (fresh->GetRasterXSize() != this->dataset->GetRasterXSize() ||
        fresh->GetRasterYSize() != this->dataset->GetRasterYSize() ||
        fresh->GetRasterCount() < this->bandNumber ||
        fresh->GetRasterBand(this->bandNumber)->GetRasterDataType() !=
            this->band->GetRasterDataType())
      throw Error(Error::Kind::Io, "raster '" + path + "'",
                  "it is another raster than when it was opened; open it again");
    this->dataset = std::move(fresh);
    this->band = this->dataset->GetRasterBand(this->bandNumber);
    if (this->checksums)
      this->checksums = std::make_unique<DeflateCheck>(*this->dataset, *this->band);
    this->suspect = false;
  }
};

ElevationSource::ElevationSource(const std::string& path, const ElevationOptions& options)
    : Impl_(std::make_unique<Implementation>()) {
  const std::string object = "raster '" + path + "'";
  this->Info_.path = path;
  CheckLimits(options.network, object);
  this->Impl_->network = options.network;
  this->Impl_->look = FilesGuard::Current();
  this->Impl_->file = FileState::Of(path);
  this->Impl_->dataset = OpenRaster(path, options.network, this->Info_.warnings);
  const NetworkScope scope(options.network, path);
  GDALDataset& dataset = *this->Impl_->dataset;
  this->Impl_->remote = IsRemote(path) || IsRemoteMosaic(dataset);
  this->Info_.remote = this->Impl_->remote;
  GdalErrors errors;
  const int bands = dataset.GetRasterCount();
  if (bands == 0)
    throw Error(Error::Kind::Unsupported, object,
                "it holds no band itself; name one of its subdatasets (gdalinfo lists them)");
  if (options.band < 1 || options.band > bands)
    throw Error(Error::Kind::InvalidArgument, object,
                "band " + std::to_string(options.band) + " asked for; accepted are 1 to " +
                    std::to_string(bands));
  this->Impl_->bandNumber = options.band;
  this->Impl_->band = dataset.GetRasterBand(options.band);
  GDALRasterBand& band = *this->Impl_->band;
  this->Info_.driver = dataset.GetDriver() ? dataset.GetDriver()->GetDescription() : "";
  this->Info_.dataType = GDALGetDataTypeName(band.GetRasterDataType());
  if (GDALDataTypeIsComplex(band.GetRasterDataType()))
    throw Error(Error::Kind::Unsupported, object,
                "complex values (" + this->Info_.dataType + ") are not heights");
  if (band.GetColorTable())
    this->Info_.warnings.push_back("band " + std::to_string(options.band) +
                                   " has a colour table: its indices are used as heights");
  if (!this->Impl_->remote)
    this->Impl_->checksums = std::make_unique<DeflateCheck>(dataset, band);
  this->Impl_->gaps = GivesZerosForGaps(band);
  if (options.noData && !std::isfinite(*options.noData))
    throw Error(Error::Kind::InvalidArgument, object,
                "its value without data is " + std::to_string(*options.noData) +
                    "; accepted: a finite number (NaN and infinities never are data)");
  this->Impl_->noData = options.noData;
  if (options.noData && band.GetRasterDataType() == GDT_Float32)
    this->Impl_->noData = double(float(*options.noData));
  this->Impl_->ownOverviews = !options.noData;
  this->Info_.overviews = this->Impl_->ownOverviews ? band.GetOverviewCount() : 0;
  ReadGeoreference(dataset, options, this->Info_);
  ReadVertical(band, options, this->Info_);
  const RasterWindow& all = this->Info_.window;
  // Of a mosaic each file would be opened, of a server's all offsets sent.
  if (this->Impl_->gaps && !this->Impl_->remote && this->Info_.driver == "GTiff" &&
      LeavesBlocksOut(band, all))
    this->Info_.warnings.push_back(
        "blocks of it are left out (a sparse or unfinished file): they are taken as no data; if "
        "they stand for 0, fill them (gdal_translate does)");
  errors.Check(Error::Kind::Corrupt, object);
  if (!options.overviewCache.empty() && this->Info_.overviews == 0) {
    this->Impl_->cached = ElevationCache::FileFor(options.overviewCache, path, options.band);
    try {
      this->Info_.overviews = this->LoadOverviews();
      this->Info_.overviewsAreCached = this->Info_.overviews > 0;
    } catch (const Error& error) {
      this->Info_.warnings.push_back(std::string(error.what()) +
                                     "; distant ground is read without it until it is rebuilt");
    }
  }
  this->Info_.warnings.insert(this->Info_.warnings.end(), errors.Warnings().begin(),
                              errors.Warnings().end());
}

ElevationSource::~ElevationSource() = default;

std::vector<double> ElevationSource::Read() const {
  return this->Read({0, 0, this->Info_.window.width, this->Info_.window.height});
}

std::vector<double> ElevationSource::Read(const RasterWindow& w) const {
  return this->ReadReduced(w, 1);
}

std::vector<double> ElevationSource::ReadReduced(const RasterWindow& w, int factor) const {
  const ElevationInfo& info = this->Info_;
  const std::string object = "raster '" + info.path + "'";
  if (w.column < 0 || w.row < 0 || w.width < 1 || w.height < 1 ||
      w.width > info.window.width - w.column || w.height > info.window.height - w.row)
    throw Error(Error::Kind::InvalidArgument, object, "the window to read does not lie within it");
  if (factor < 1)
    throw Error(Error::Kind::InvalidArgument, object,
                "factor " + std::to_string(factor) + " is rejected; accepted is 1 or more");
  const int width = 1 + (w.width - 1) / factor, height = 1 + (w.height - 1) / factor;
  const std::size_t count = static_cast<std::size_t>(width) * height;
  std::vector<double> heights;
  std::vector<std::uint8_t> mask;
  try {
    heights.resize(count);
    mask.resize(count);
  } catch (const std::exception&) {
    throw Error(Error::Kind::Resource, object,
                "no memory for " + std::to_string(width) + " x " + std::to_string(height) +
                    " posts; give a smaller window");
  }
  // A last column or row that is narrower than the others is read by itself.
  const int fullColumns = w.width / factor, fullRows = w.height / factor;
  const bool cached = factor > 1 && this->ReadCached(w, factor, heights.data());
  if (cached)
    std::fill(mask.begin(), mask.end(), std::uint8_t(255));
  for (const bool lastRow : {false, true})
    for (const bool lastColumn : {false, true}) {
      const int c = lastColumn ? fullColumns : 0, r = lastRow ? fullRows : 0;
      const int columns = lastColumn ? width - fullColumns : fullColumns;
      const int rows = lastRow ? height - fullRows : fullRows;
      if (cached || columns == 0 || rows == 0)
        continue;
      const RasterWindow part{info.window.column + w.column + c * factor,
                              info.window.row + w.row + r * factor,
                              lastColumn ? w.width - c * factor : columns * factor,
                              lastRow ? w.height - r * factor : rows * factor};
      const std::size_t at = static_cast<std::size_t>(r) * width + c;
      // A mosaic reads all of its sources in one call: in parts it can be stopped.
      const int some = OpeningLimit::IsActive() ? std::min(rows, RowsAtOnce) : rows;
      for (int done = 0; done < rows; done += some) {
        const int take = std::min(some, rows - done);
        const int pixels = part.height / rows; // a row
        const std::size_t to = at + std::size_t(done) * width;
        this->ReadPart({part.column, part.row + done * pixels, part.width, take * pixels}, columns,
                       take, width, heights.data() + to, mask.data() + to);
      }
    }
  const double datum =
      info.verticalDatum.kind == VerticalDatum::Kind::Radius ? info.verticalDatum.radius : 0.0;
  // The offset and the radius cancel before anything is rounded to their size.
  const double offset = info.verticalOffset - datum;
  for (std::size_t i = 0; i < count; ++i) {
    const double height = heights[i] * info.verticalScale + offset;
    heights[i] =
        mask[i] && std::isfinite(height) ? height : std::numeric_limits<double>::quiet_NaN();
  }
  return heights;
}

// False where the cache has nothing for it.
bool ElevationSource::ReadCached(const RasterWindow& w, int factor, double* values) const {
  Implementation& impl = *this->Impl_;
  std::shared_ptr<const OverviewFile> overviews;
  {
    const std::lock_guard<std::mutex> lock(impl.mutex);
    overviews = impl.overviews;
  }
  const int column = this->Info_.window.column + w.column;
  const int row = this->Info_.window.row + w.row;
  int level = 0;
  while (level < 30 && (2 << level) < factor)
    ++level;
  if (!overviews || (2 << level) != factor || level >= overviews->Header().levels ||
      column % factor != 0 || row % factor != 0)
    return false;
  // Cells at the window's edge reach beyond it where the raster does.
  const RasterWindow cells{column / factor, row / factor, 1 + (w.width - 1) / factor,
                           1 + (w.height - 1) / factor};
  if (impl.file.ChangedInPlace(this->Info_.path))
    throw Error(Error::Kind::Io, "raster '" + this->Info_.path + "'", Changed);
  try {
    overviews->Read(level, cells, values);
  } catch (const Error& error) {
    const std::lock_guard<std::mutex> lock(impl.mutex);
    if (impl.overviews == overviews)
      impl.overviews.reset();
    overviews->Remove();
    throw Error(error.GetKind(), "raster '" + this->Info_.path + "'",
                std::string(error.what()) +
                    "; it is removed, and distant ground is read without it until it is rebuilt");
  }
  return true;
}

int ElevationSource::LoadOverviews() {
  if (this->Impl_->cached.empty()) {
    return 0;
  }
  std::shared_ptr<const OverviewFile> overviews;
  try {
    overviews = std::make_shared<const OverviewFile>(this->Impl_->cached);
  } catch (const Error& error) {
    if (error.GetKind() != Error::Kind::NotFound)
      throw;
    return 0;
  }
  if (overviews->Header().identity != this->Identity()) {
    return 0;
  }
  const int levels = overviews->Header().levels;
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  this->Impl_->overviews = std::move(overviews);
  return levels;
}

std::string ElevationSource::Identity() const {
  const Implementation& impl = *this->Impl_;
  const std::lock_guard<std::mutex> lock(impl.mutex);
  const NetworkScope scope(impl.network, this->Info_.path);
  const FilesGuard guard(impl.look);
  const GdalErrors quiet;
  std::ostringstream without;
  without.precision(17);
  if (impl.noData)
    without << " without " << *impl.noData;
  return "band " + std::to_string(impl.bandNumber) + without.str() + " of " +
         std::to_string(impl.dataset->GetRasterXSize()) + " x " +
         std::to_string(impl.dataset->GetRasterYSize()) + " " + this->Info_.dataType +
         FilesOf(*impl.dataset);
}

// Pixels of the file, `columns` x `rows` of them or of an overview, into rows of `stride`.
void ElevationSource::ReadPart(const RasterWindow& part, int columns, int rows, int stride,
                               double* values, std::uint8_t* mask) const {
  Implementation& impl = *this->Impl_;
  const std::string object = "raster '" + this->Info_.path + "'";
  const std::lock_guard<std::mutex> lock(impl.mutex);
  if (impl.file.ChangedInPlace(this->Info_.path))
    throw Error(Error::Kind::Io, object, Changed);
  const NetworkScope scope(impl.network, this->Info_.path);
  const FilesGuard guard(impl.look);
  if (impl.suspect)
    impl.OpenAnew(this->Info_.path);
  const bool reduced = columns != part.width || rows != part.height;
  if (reduced && !impl.ownOverviews && impl.band->GetOverviewCount() > 0) {
    this->ReadSparse(part, columns, rows, stride, values, mask);
    return;
  }
  this->ReadPixels(part, columns, rows, stride, values, mask);
}

// As ReadPart, with the pixels in the middle, past the file's overviews. With the mutex held.
void ElevationSource::ReadSparse(const RasterWindow& part, int columns, int rows, int stride,
                                 double* values, std::uint8_t* mask) const {
  std::vector<double> line(part.width);
  std::vector<std::uint8_t> there(part.width);
  const int across = part.width / columns, down = part.height / rows;
  for (int r = 0; r < rows; ++r) {
    const RasterWindow row{part.column, part.row + r * down + down / 2, part.width, 1};
    this->ReadPixels(row, part.width, 1, part.width, line.data(), there.data());
    for (int c = 0; c < columns; ++c) {
      const std::size_t to = std::size_t(r) * stride + c;
      values[to] = line[c * across + across / 2];
      mask[to] = there[c * across + across / 2];
    }
  }
}

// With the mutex held.
void ElevationSource::ReadPixels(const RasterWindow& part, int columns, int rows, int stride,
                                 double* values, std::uint8_t* mask) const {
  Implementation& impl = *this->Impl_;
  const std::string object = "raster '" + this->Info_.path + "'";
  GdalErrors errors;
  GDALRasterBand& band = *impl.band;
  const auto line = static_cast<GSpacing>(stride);
  GDALRasterIOExtraArg argument = OpeningLimit::Argument();
  const CPLErr read =
      band.RasterIO(GF_Read, part.column, part.row, part.width, part.height, values, columns, rows,
                    GDT_Float64, sizeof(double), line * GSpacing(sizeof(double)), &argument);
  // The mask knows no-data, alpha and the special pixels of each format.
  impl.suspect = read != CE_None || errors.Failed();
  if (!impl.suspect && impl.gaps) {
    // All are valid but those of gaps. GDAL's own mask takes a block of memory for each of them.
    for (int r = 0; r < rows; ++r) {
      std::fill_n(mask + std::size_t(r) * stride, columns, std::uint8_t(255));
    }
    MaskGaps(band, part, columns, rows, stride, mask);
    impl.suspect = errors.Failed();
  } else if (!impl.suspect) {
    impl.suspect =
        band.GetMaskBand()->RasterIO(GF_Read, part.column, part.row, part.width, part.height, mask,
                                     columns, rows, GDT_Byte, 1, line, nullptr) != CE_None ||
        errors.Failed();
  }
  if (!impl.suspect && impl.noData) {
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c) {
        const std::size_t i = std::size_t(r) * stride + c;
        mask[i] = values[i] == *impl.noData ? std::uint8_t(0) : mask[i];
      }
  }
  if (impl.file.ChangedInPlace(this->Info_.path))
    throw Error(Error::Kind::Io, object, Changed);
  const std::string damage = impl.suspect || !impl.checksums || part.width != columns
                                 ? std::string()
                                 : impl.checksums->Check(band, part);
  if (!damage.empty())
    throw Error(Error::Kind::Corrupt, object, "cannot be read: " + damage);
  OpeningLimit::Check(object);
  if (!impl.suspect)
    return;
  if (impl.remote)
    ClearNetworkCache(this->Info_.path);
  const std::string message = errors.Message("GDAL gave no reason");
  if (impl.remote && IsNetworkFailure(message))
    throw Error(Error::Kind::Io, object, "cannot be read: " + ExplainHttpStatus(message));
  throw Error(Error::Kind::Corrupt, object, "cannot be read: " + message);
}

} // namespace dspace
