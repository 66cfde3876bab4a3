#include <dspace/terrain/ElevationSource.h>

#include <cmath>
#include <limits>
#include <mutex>

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <sys/stat.h>

#include <dspace/Error.h>
#include <dspace/terrain/ElevationCache.h>

#include "ElevationMetadata.h"
#include "GdalErrors.h"
#include "NetworkScope.h"
#include "OverviewFile.h"

namespace dspace {

namespace {

struct CloseDataset {
  void operator()(GDALDataset* dataset) const {
    const GdalErrors quiet;
    GDALClose(dataset);
  }
};
using DatasetPointer = std::unique_ptr<GDALDataset, CloseDataset>;

// Why a server's file did not open, from GDAL's messages.
Error::Kind KindOfAnswer(const std::string& message) {
  const auto has = [&](const char* words) { return message.find(words) != std::string::npos; };
  if (has("timed out"))
    return Error::Kind::DeadlineExceeded;
  if (has("response code: 404") || has("response code: 410") || has("does not exist"))
    return Error::Kind::NotFound;
  if (has("CURL error") || has("response code") || has("response_code"))
    return Error::Kind::Io;
  return has("not recognized") ? Error::Kind::Unsupported : Error::Kind::Corrupt;
}

DatasetPointer Open(const std::string& path, const NetworkLimits& limits,
                    std::vector<std::string>& warnings) {
  const std::string object = "raster '" + path + "'";
  RegisterGdal();
  const NetworkScope scope(limits, path);
  GdalErrors errors;
  DatasetPointer dataset(GDALDataset::Open(
      GdalPath(path).c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (!dataset && IsRemote(path)) {
    ForgetAnswers(path);
    const std::string message = errors.Message("not recognised by GDAL");
    throw Error(KindOfAnswer(message), object, message);
  }
  if (!dataset) {
    VSIStatBufL stat;
    const bool exists = VSIStatL(path.c_str(), &stat) == 0;
    if (path.empty() || !exists)
      throw Error(Error::Kind::NotFound, object, errors.Message("no such file"));
    if (VSI_ISDIR(stat.st_mode))
      throw Error(Error::Kind::Unsupported, object, "is a folder; a raster file is needed");
    if (stat.st_size == 0)
      throw Error(Error::Kind::Corrupt, object, "the file is empty");
    VSILFILE* file = VSIFOpenL(path.c_str(), "rb");
    if (!file)
      throw Error(Error::Kind::Io, object, errors.Message("cannot be read"));
    VSIFCloseL(file);
    const std::string message = errors.Message("not recognised by GDAL");
    const bool type = message.find("not recognized") != std::string::npos;
    throw Error(type ? Error::Kind::Unsupported : Error::Kind::Corrupt, object,
                message + "; any raster that GDAL opens is accepted");
  }
  errors.DemoteFailures();
  warnings.insert(warnings.end(), errors.Warnings().begin(), errors.Warnings().end());
  return dataset;
}

const char* const Changed = "the file has changed since it was opened; open it anew";

// A local file as it was when it was opened; empty for what is none.
struct FileState {
  bool local = false;
  struct stat state = {};

  static FileState Of(const std::string& path) {
    FileState file;
    file.local = ::stat(path.c_str(), &file.state) == 0 && S_ISREG(file.state.st_mode);
    return file;
  }
  // What a changed file gives is partly of the one and partly of the other. One that was replaced
  // or removed by name is still read whole.
  bool ChangedInPlace(const std::string& path) const {
    const FileState now = Of(path);
    return this->local && now.local && now.state.st_ino == this->state.st_ino &&
           now.state.st_dev == this->state.st_dev &&
           (now.state.st_size != this->state.st_size ||
            now.state.st_mtim.tv_sec != this->state.st_mtim.tv_sec ||
            now.state.st_mtim.tv_nsec != this->state.st_mtim.tv_nsec);
  }
};

bool IsMosaic(GDALDataset& dataset) {
  return dataset.GetDriver() && std::string(dataset.GetDriver()->GetDescription()) == "VRT";
}

bool HasRemoteFile(GDALDataset& dataset) {
  const CPLStringList files(dataset.GetFileList());
  for (int i = 0; i < files.size(); ++i)
    if (IsRemote(files[i]))
      return true;
  return false;
}

} // namespace

struct ElevationSource::Implementation {
  mutable std::mutex mutex;
  DatasetPointer dataset;
  GDALRasterBand* band = nullptr;
  int bandNumber = 1;
  NetworkLimits network;
  bool remote = false;  // itself, or what it is a mosaic of
  bool suspect = false; // a read failed
  FileState file;
  std::shared_ptr<const OverviewFile> overviews;

  // After a failed read GDAL may take what it could not read for blocks that the file leaves out,
  // and give zeros. With the mutex held.
  void OpenAnew(const std::string& path) {
    std::vector<std::string> warnings;
    DatasetPointer fresh = Open(path, this->network, warnings);
    if (fresh->GetRasterXSize() != this->dataset->GetRasterXSize() ||
        fresh->GetRasterYSize() != this->dataset->GetRasterYSize() ||
        fresh->GetRasterCount() < this->bandNumber ||
        fresh->GetRasterBand(this->bandNumber)->GetRasterDataType() !=
            this->band->GetRasterDataType())
      throw Error(Error::Kind::Io, "raster '" + path + "'",
                  "it is another raster than when it was opened; open it anew");
    this->dataset = std::move(fresh);
    this->band = this->dataset->GetRasterBand(this->bandNumber);
    this->suspect = false;
  }
};

ElevationSource::ElevationSource(const std::string& path, const ElevationOptions& options)
    : Impl_(std::make_unique<Implementation>()) {
  const std::string object = "raster '" + path + "'";
  this->Info_.path = path;
  CheckLimits(options.network, object);
  this->Impl_->network = options.network;
  this->Impl_->file = FileState::Of(path);
  this->Impl_->dataset = Open(path, options.network, this->Info_.warnings);
  const NetworkScope scope(options.network, path);
  GDALDataset& dataset = *this->Impl_->dataset;
  this->Impl_->remote = IsRemote(path) || (IsMosaic(dataset) && HasRemoteFile(dataset));
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
                "complex values (" + this->Info_.dataType + ") are no heights");
  if (band.GetColorTable())
    this->Info_.warnings.push_back("band " + std::to_string(options.band) +
                                   " has a colour table: its indices are taken as heights");
  this->Info_.overviews = band.GetOverviewCount();
  ReadGeoreference(dataset, options, this->Info_);
  ReadVertical(band, options, this->Info_);
  errors.Check(Error::Kind::Corrupt, object);
  if (!options.overviewCache.empty() && this->Info_.overviews == 0) {
    const std::string file = ElevationCache::FileFor(options.overviewCache, path, options.band);
    try {
      auto overviews = std::make_shared<OverviewFile>(file);
      if (overviews->Header().identity == this->Identity()) {
        this->Info_.overviews = overviews->Header().levels;
        this->Info_.overviewsAreCached = true;
        this->Impl_->overviews = std::move(overviews);
      }
    } catch (const Error& error) {
      if (error.GetKind() != Error::Kind::NotFound)
        this->Info_.warnings.push_back(std::string(error.what()) +
                                       "; far ground is read without it until it is built anew");
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
                "factor " + std::to_string(factor) + " is refused; accepted is 1 or more");
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
      this->ReadPart(part, columns, rows, width, heights.data() + at, mask.data() + at);
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
                    "; it is removed, and far ground read without it until it is built anew");
  }
  return true;
}

std::string ElevationSource::Identity() const {
  const Implementation& impl = *this->Impl_;
  const std::lock_guard<std::mutex> lock(impl.mutex);
  const NetworkScope scope(impl.network, this->Info_.path);
  const GdalErrors quiet;
  const CPLStringList files(impl.dataset->GetFileList());
  std::string text = "band " + std::to_string(impl.bandNumber) + " of " +
                     std::to_string(impl.dataset->GetRasterXSize()) + " x " +
                     std::to_string(impl.dataset->GetRasterYSize()) + " " + this->Info_.dataType;
  for (int i = 0; i < files.size(); ++i) {
    struct stat local = {};
    VSIStatBufL stat;
    text += "\n" + std::string(files[i]);
    if (::stat(files[i], &local) == 0)
      text += " " + std::to_string(local.st_size) + " " + std::to_string(local.st_mtim.tv_sec) +
              "." + std::to_string(local.st_mtim.tv_nsec);
    else if (VSIStatL(files[i], &stat) == 0)
      text += " " + std::to_string(stat.st_size) + " " + std::to_string(stat.st_mtime);
  }
  return text;
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
  if (impl.suspect)
    impl.OpenAnew(this->Info_.path);
  GdalErrors errors;
  GDALRasterBand& band = *impl.band;
  const auto line = static_cast<GSpacing>(stride);
  const CPLErr read =
      band.RasterIO(GF_Read, part.column, part.row, part.width, part.height, values, columns, rows,
                    GDT_Float64, sizeof(double), line * GSpacing(sizeof(double)), nullptr);
  // The mask knows no-data, alpha and the special pixels of each format.
  impl.suspect =
      read != CE_None || errors.Failed() ||
      band.GetMaskBand()->RasterIO(GF_Read, part.column, part.row, part.width, part.height, mask,
                                   columns, rows, GDT_Byte, 1, line, nullptr) != CE_None ||
      errors.Failed();
  if (impl.file.ChangedInPlace(this->Info_.path))
    throw Error(Error::Kind::Io, object, Changed);
  if (!impl.suspect)
    return;
  if (impl.remote)
    ForgetAnswers(this->Info_.path);
  const std::string message = errors.Message("GDAL gave no reason");
  if (impl.remote && IsUnanswered(message))
    throw Error(Error::Kind::Io, object, "cannot be read: " + InWords(message));
  throw Error(Error::Kind::Corrupt, object, "cannot be read: " + message);
}

} // namespace dspace
