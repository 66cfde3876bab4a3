// Pixels of an image or of one band at any reduction, as means weighted by opacity. Not for public
// headers.
#ifndef DSPACE_LAYERS_RASTERLEVELS_H
#define DSPACE_LAYERS_RASTERLEVELS_H

#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <dspace/FilesRead.h>
#include <dspace/layers/raster/RasterContent.h>

namespace dspace {

class RasterOverviews;
class RasterPixels;
struct RasterLayerOptions;

// Safe to call from several threads. Each call uses a GDAL handle of its own.
class RasterLevels {
public:
  // `band`: its values, scaled, less Bias(); 0: the raster is an image, with colours 0 to 255, or
  // holds vectors, with numbers of -1 to 1.
  // Throws Error that names `object`, see ImageLayer.h.
  RasterLevels(std::string object, std::string path, int band, const RasterLayerOptions& options,
               RasterShown shown = RasterShown::Data);
  ~RasterLevels();
  RasterLevels(const RasterLevels&) = delete;
  RasterLevels& operator=(const RasterLevels&) = delete;

  const std::string& Object() const { return this->Object_; }
  int Width() const { return this->Content_.width; }
  int Height() const { return this->Content_.height; }
  int Channels() const { return this->Content_.channels; } // 3: RGB, vectors; 1: grey or values
  int ColumnsAt(int level) const { return this->Content_.ColumnsAt(level); }
  int RowsAt(int level) const { return this->Content_.RowsAt(level); }

  // Writes Channels() floats per cell, each times the opacity, then the opacity, 0 to 1; row by
  // row. Each is the mean over the cell, from the file's overviews if they are as fine. Throws
  // Error(Io, Corrupt).
  void Read(const LevelWindow& window, float* cells) const;
  // Writes the values of pixels of one band, row by row, in full resolution and precision; NaN
  // where there is no data. `part` lies in the raster. Throws Error(Io, Corrupt).
  void ReadValues(const RasterWindow& part, double* values) const;
  // Bytes of decoded pixels that stay in memory, see RasterPixels::PlanCaching.
  std::size_t KeptBytes() const;

  // Values are stored as floats; values near the bias are the most exact.
  void SetBias(double bias);
  double Bias() const;
  // Least and greatest value. Of a large file they are read from an overview or from some rows;
  // `exact` is then false. Throws Error(Corrupt) if there is no value at all.
  std::array<double, 2> FindRange(bool& exact) const;
  const std::string& Unit() const { return this->Content_.unit; }
  const RasterContent::Georeference& Place() const { return this->Content_.place; }
  std::vector<std::string>& Warnings() { return this->Warnings_; }

private:
  std::unique_ptr<RasterHandle> Open() const;
  void WithHandle(const std::function<void(RasterHandle&)>& use) const;
  void ReadCells(RasterHandle& handle, const LevelWindow& window, float* cells) const;

  std::string Object_;
  std::string Path_;
  NetworkLimits Network_;
  FileState File_;
  FilesGuard::Check Check_; // of the guard under which the file was opened
  bool Remote_ = false;
  RasterContent Content_;
  std::size_t FileLevels_ = 0; // without RasterOverviews
  std::vector<std::string> Warnings_;
  std::unique_ptr<RasterOverviews> Overviews_;
  std::unique_ptr<RasterPixels> Pixels_;
  mutable std::mutex Mutex_; // of Idle_
  mutable std::vector<std::unique_ptr<RasterHandle>> Idle_;
};

} // namespace dspace

#endif
