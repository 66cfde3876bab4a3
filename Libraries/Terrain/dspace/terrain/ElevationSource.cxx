#include <dspace/terrain/ElevationSource.h>

#include <cmath>
#include <limits>
#include <mutex>

#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <dspace/Error.h>

#include "ElevationMetadata.h"
#include "GdalErrors.h"

namespace dspace {

namespace {

struct CloseDataset {
  void operator()(GDALDataset* dataset) const {
    const GdalErrors quiet;
    GDALClose(dataset);
  }
};
using DatasetPointer = std::unique_ptr<GDALDataset, CloseDataset>;

DatasetPointer Open(const std::string& path, std::vector<std::string>& warnings) {
  const std::string object = "raster '" + path + "'";
  RegisterGdal();
  GdalErrors errors;
  DatasetPointer dataset(
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (!dataset) {
    VSIStatBufL stat;
    const bool exists = VSIStatL(path.c_str(), &stat) == 0;
    if (path.empty() || (!exists && errors.Message("").find("HTTP") == std::string::npos))
      throw Error(Error::Kind::NotFound, object, errors.Message("no such file"));
    if (exists && VSI_ISDIR(stat.st_mode))
      throw Error(Error::Kind::Unsupported, object, "is a folder; a raster file is needed");
    if (exists && stat.st_size == 0)
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

} // namespace

struct ElevationSource::Implementation {
  mutable std::mutex mutex;
  DatasetPointer dataset;
  GDALRasterBand* band = nullptr;
};

ElevationSource::ElevationSource(const std::string& path, const ElevationOptions& options)
    : Impl_(std::make_unique<Implementation>()) {
  const std::string object = "raster '" + path + "'";
  this->Info_.path = path;
  this->Impl_->dataset = Open(path, this->Info_.warnings);
  GDALDataset& dataset = *this->Impl_->dataset;
  GdalErrors errors;
  const int bands = dataset.GetRasterCount();
  if (bands == 0)
    throw Error(Error::Kind::Unsupported, object,
                "it holds no band itself; name one of its subdatasets (gdalinfo lists them)");
  if (options.band < 1 || options.band > bands)
    throw Error(Error::Kind::InvalidArgument, object,
                "band " + std::to_string(options.band) + " asked for; accepted are 1 to " +
                    std::to_string(bands));
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
  for (const bool lastRow : {false, true})
    for (const bool lastColumn : {false, true}) {
      const int c = lastColumn ? fullColumns : 0, r = lastRow ? fullRows : 0;
      const int columns = lastColumn ? width - fullColumns : fullColumns;
      const int rows = lastRow ? height - fullRows : fullRows;
      if (columns == 0 || rows == 0)
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

// Pixels of the file, `columns` x `rows` of them or of an overview, into rows of `stride`.
void ElevationSource::ReadPart(const RasterWindow& part, int columns, int rows, int stride,
                               double* values, std::uint8_t* mask) const {
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  GdalErrors errors;
  GDALRasterBand& band = *this->Impl_->band;
  const auto line = static_cast<GSpacing>(stride);
  const CPLErr read =
      band.RasterIO(GF_Read, part.column, part.row, part.width, part.height, values, columns, rows,
                    GDT_Float64, sizeof(double), line * GSpacing(sizeof(double)), nullptr);
  // The mask knows no-data, alpha and the special pixels of each format.
  const CPLErr masked =
      band.GetMaskBand()->RasterIO(GF_Read, part.column, part.row, part.width, part.height, mask,
                                   columns, rows, GDT_Byte, 1, line, nullptr);
  if (read != CE_None || masked != CE_None || errors.Failed())
    throw Error(Error::Kind::Corrupt, "raster '" + this->Info_.path + "'",
                "cannot be read: " + errors.Message("GDAL gave no reason"));
}

} // namespace dspace
