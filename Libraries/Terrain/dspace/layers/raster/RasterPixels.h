// Reads pixels of a raster and converts them to colours or values with opacity. Not for public
// headers.
#ifndef DSPACE_LAYERS_RASTERPIXELS_H
#define DSPACE_LAYERS_RASTERPIXELS_H

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <dspace/layers/raster/RasterContent.h>

namespace dspace {

class RasterOverviews;

// Safe to call from several threads after PlanCaching() and SetBias(). Each thread passes levels of
// its own handle.
class RasterPixels {
public:
  // Pixels in the file's type: colours and opacity of each pixel together. `mask` is empty if all
  // pixels are opaque.
  struct Raw {
    std::vector<std::uint8_t> samples;
    std::vector<std::uint8_t> mask;
  };

  // `content` and `overviews` must outlive this. `remote`: the file is on a server. A read error in
  // an overview removes the overviews.
  RasterPixels(std::string object, std::string path, const RasterContent& content,
               RasterShown shown, bool remote, RasterOverviews& overviews);
  RasterPixels(const RasterPixels&) = delete;
  RasterPixels& operator=(const RasterPixels&) = delete;

  // Decides whether whole levels are decoded once and stay in memory: in formats that GDAL decodes
  // from the start for every read (JPEG, PNG ...). `levels`: number of levels in the file.
  void PlanCaching(GDALDataset& file, std::size_t levels, std::vector<std::string>& warnings);
  // Subtracted from values before they are rounded to floats. Default: 0.
  void SetBias(double bias) { this->Bias_ = bias; }
  double Bias() const { return this->Bias_; }

  // Reads `part` into `columns` x `rows` pixels; GDAL decimates if `part` has more. Throws
  // Error(Io, Corrupt).
  void Read(const RasterLevel& level, const RasterWindow& part, int columns, int rows, Raw& raw);
  // The whole level from memory; null if levels are not cached. `index`: of the level in its
  // handle.
  std::shared_ptr<const Raw> CachedLevel(const RasterLevel& level, std::size_t index);
  // The values of one band of `count` pixels from pixel `first` on, scaled, and their opacity, 0
  // to 1. A value without opacity has no meaning.
  void Values(const RasterLevel& level, const Raw& raw, std::size_t first, std::size_t count,
              double* values, float* opacities) const;
  // Converts `count` pixels from pixel `first` on: channels times opacity, then opacity, 0 to 1.
  // Throws Error(Corrupt) for a vector that is no normal, see NormalsLayer.h.
  void Convert(const RasterLevel& level, const Raw& raw, std::size_t first, std::size_t count,
               float* pixels) const;
  // Bytes of cached levels.
  std::size_t CachedBytes() const { return this->CachedBytes_; }

private:
  void ConvertVectors(const RasterLevel& level, const Raw& raw, std::size_t first,
                      std::size_t count, float* pixels) const;
  void CheckNormal(const double (&n)[3]) const;
  std::string Object_;
  std::string Path_;
  const RasterContent& Content_;
  RasterShown Shown_;
  bool Remote_;
  RasterOverviews& Overviews_;
  double Bias_ = 0.0;
  bool Caches_ = false;
  std::atomic<std::size_t> CachedBytes_{0};
  std::mutex Mutex_; // of Levels_, held while a level is decoded
  std::vector<std::shared_ptr<const Raw>> Levels_;
};

} // namespace dspace

#endif
