#include <dspace/raster/DeflateCheck.h>

#include <cstdlib>
#include <vector>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <dspace/raster/TiffBlocks.h>

namespace dspace {

void DeflateCheck::Closed::operator()(void* file) const {
  VSIFCloseL(static_cast<VSILFILE*>(file));
}

DeflateCheck::DeflateCheck(GDALDataset& dataset, GDALRasterBand& band) {
  const char* compression = dataset.GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE");
  const char* interleaved = dataset.GetMetadataItem("INTERLEAVE", "IMAGE_STRUCTURE");
  if (TiffBlocksOf(band) != TiffBlocks::Known || !compression || !EQUAL(compression, "DEFLATE")) {
    return;
  }
  band.GetBlockSize(&this->Width_, &this->Height_);
  const bool together = interleaved && EQUAL(interleaved, "PIXEL");
  this->Bytes_ = std::size_t(this->Width_) * std::size_t(this->Height_) *
                 std::size_t(GDALGetDataTypeSizeBytes(band.GetRasterDataType())) *
                 std::size_t(together ? dataset.GetRasterCount() : 1);
  this->File_.reset(VSIFOpenL(dataset.GetDescription(), "rb"));
}

DeflateCheck::~DeflateCheck() = default;

bool DeflateCheck::IsIntact(GDALRasterBand& band, int column, int row) {
  const std::uint64_t offset = TiffBlockOffset(band, column, row);
  const std::uint64_t size = offset != 0 ? TiffBlockSize(band, column, row) : 0;
  if (size < 6 || size > 2 * this->Bytes_ + 4096) {
    return true; // left out, or none that libtiff would take
  }
  auto* file = static_cast<VSILFILE*>(this->File_.get());
  std::vector<unsigned char> stream(static_cast<std::size_t>(size));
  if (VSIFSeekL(file, offset, SEEK_SET) != 0 ||
      VSIFReadL(stream.data(), 1, stream.size(), file) != stream.size()) {
    return false;
  }
  if ((stream[0] & 15) != 8 || (stream[0] * 256 + stream[1]) % 31 != 0) {
    return true; // not zlib's, as where bits are stored in reverse: libtiff knows, or rejects it
  }
  // Some programs store more rows than a last block has, none half as much again.
  std::vector<unsigned char> block(2 * this->Bytes_ + 64);
  std::size_t got = 0;
  return CPLZLibInflate(stream.data(), stream.size(), block.data(), block.size(), &got) != nullptr;
}

std::string DeflateCheck::Check(GDALRasterBand& band, const RasterWindow& w) {
  if (!this->File_) {
    return "";
  }
  for (int row = w.row / this->Height_; row <= (w.row + w.height - 1) / this->Height_; ++row) {
    for (int column = w.column / this->Width_; column <= (w.column + w.width - 1) / this->Width_;
         ++column) {
      const std::uint64_t key = std::uint64_t(row) << 32 | std::uint32_t(column);
      if (this->Checked_.count(key) != 0) {
        continue;
      }
      if (!this->IsIntact(band, column, row)) {
        return "block " + std::to_string(column) + ", " + std::to_string(row) +
               " is damaged: its content does not match its checksum (Adler-32)";
      }
      this->Checked_.insert(key);
    }
  }
  return "";
}

} // namespace dspace
