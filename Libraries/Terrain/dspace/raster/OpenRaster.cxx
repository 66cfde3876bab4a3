#include <dspace/raster/OpenRaster.h>

#include <algorithm>

#include <cpl_string.h>
#include <cpl_vsi.h>

#include <dspace/Error.h>
#include <dspace/raster/DatasetFiles.h>

#include <dspace/raster/NetworkScope.h>
#include <dspace/raster/TiffBlocks.h>

namespace dspace {

namespace {

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

// GDAL_DATA_COVERAGE_STATUS_... of pixels. GDAL itself also takes blocks of a TIFF for empty that
// are there, where the file system keeps their zeros as a hole of the file: those are zeros.
int Coverage(GDALRasterBand& band, TiffBlocks tiff, const RasterWindow& w, int until = 0) {
  if (tiff == TiffBlocks::NoTiff) {
    return band.GetDataCoverageStatus(w.column, w.row, w.width, w.height, until, nullptr);
  }
  if (tiff == TiffBlocks::Unknown) {
    return GDAL_DATA_COVERAGE_STATUS_DATA;
  }
  int blockX = 1;
  int blockY = 1;
  band.GetBlockSize(&blockX, &blockY);
  int status = 0;
  for (int y = w.row / blockY; y <= (w.row + w.height - 1) / blockY; ++y) {
    for (int x = w.column / blockX; x <= (w.column + w.width - 1) / blockX; ++x) {
      status |= TiffBlockOffset(band, x, y) != 0 ? GDAL_DATA_COVERAGE_STATUS_DATA
                                                 : GDAL_DATA_COVERAGE_STATUS_EMPTY;
      if (status & until) {
        return status;
      }
    }
  }
  return status;
}

// Columns [left, right) and rows [top, bottom) of the mask.
struct Gaps {
  GDALRasterBand& band;
  const TiffBlocks tiff;
  const RasterWindow& part;
  int columns, rows, stride;
  std::uint8_t* mask;

  int X(int column) const {
    return this->part.column +
           static_cast<int>(std::int64_t(column) * this->part.width / this->columns);
  }
  int Y(int row) const {
    return this->part.row + static_cast<int>(std::int64_t(row) * this->part.height / this->rows);
  }

  void Mark(int left, int top, int right, int bottom) const {
    const int x = this->X(left), y = this->Y(top);
    const int status =
        Coverage(this->band, this->tiff,
                 {x, y, std::max(1, this->X(right) - x), std::max(1, this->Y(bottom) - y)});
    if (!(status & GDAL_DATA_COVERAGE_STATUS_EMPTY))
      return;
    const int width = right - left, height = bottom - top;
    if (status == GDAL_DATA_COVERAGE_STATUS_EMPTY || (width == 1 && height == 1)) {
      for (int r = top; r < bottom; ++r)
        std::fill_n(this->mask + std::size_t(r) * this->stride + left, width, std::uint8_t(0));
    } else if (width >= height) {
      this->Mark(left, top, left + width / 2, bottom);
      this->Mark(left + width / 2, top, right, bottom);
    } else {
      this->Mark(left, top, right, top + height / 2);
      this->Mark(left, top + height / 2, right, bottom);
    }
  }
};

} // namespace

DatasetPointer OpenRaster(const std::string& path, const NetworkLimits& limits,
                          std::vector<std::string>& warnings, std::string object) {
  if (object.empty())
    object = "raster '" + path + "'";
  RegisterGdal();
  const NetworkScope scope(limits, path);
  GdalErrors errors;
  DatasetPointer dataset = OpenDataset(GdalPath(path), DatasetKind::Raster);
  if (!dataset && IsRemote(path)) {
    ClearNetworkCache(path);
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
                message + "; accepted: " + AcceptedFormats(DatasetKind::Raster));
  }
  NoteDataset(*dataset);
  errors.DemoteFailures();
  warnings.insert(warnings.end(), errors.Warnings().begin(), errors.Warnings().end());
  return dataset;
}

FileState FileState::Of(const std::string& path) {
  FileState file;
  file.local = ::stat(path.c_str(), &file.state) == 0 && S_ISREG(file.state.st_mode);
  return file;
}

bool FileState::ChangedInPlace(const std::string& path) const {
  const FileState now = Of(path);
  return this->local && now.local && now.state.st_ino == this->state.st_ino &&
         now.state.st_dev == this->state.st_dev &&
         (now.state.st_size != this->state.st_size ||
          now.state.st_mtim.tv_sec != this->state.st_mtim.tv_sec ||
          now.state.st_mtim.tv_nsec != this->state.st_mtim.tv_nsec);
}

bool IsRemoteMosaic(GDALDataset& dataset) {
  if (!dataset.GetDriver() || std::string(dataset.GetDriver()->GetDescription()) != "VRT")
    return false;
  const CPLStringList files(dataset.GetFileList());
  for (int i = 0; i < files.size(); ++i)
    if (IsRemote(files[i]))
      return true;
  return false;
}

std::string FilesOf(GDALDataset& dataset) {
  const CPLStringList files(dataset.GetFileList());
  std::string text;
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

bool GivesZerosForGaps(GDALRasterBand& band) {
  return band.GetMaskFlags() == GMF_ALL_VALID;
}

bool LeavesBlocksOut(GDALRasterBand& band, const RasterWindow& part) {
  constexpr int Empty = GDAL_DATA_COVERAGE_STATUS_EMPTY;
  return (Coverage(band, TiffBlocksOf(band), part, Empty) & Empty) != 0;
}

void MaskGaps(GDALRasterBand& band, const RasterWindow& part, int columns, int rows, int stride,
              std::uint8_t* mask) {
  Gaps{band, TiffBlocksOf(band), part, columns, rows, stride, mask}.Mark(0, 0, columns, rows);
}

} // namespace dspace
