// Pixels of an image or of one band at any reduction, as means weighted by opacity. Not for public
// headers.
#ifndef DSPACE_LAYERS_RASTERLEVELS_H
#define DSPACE_LAYERS_RASTERLEVELS_H

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <dspace/FilesRead.h>
#include <dspace/raster/OpenRaster.h>

namespace dspace {

struct RasterLayerOptions;

// Cells of a raster whose columns are reduced by 2^levelX and rows by 2^levelY: there are
// ceil(width / 2^levelX) of them side by side, all of one size, which together cover the raster.
struct LevelWindow {
  int levelX = 0;
  int levelY = 0;
  int column = 0; // of the first cell
  int row = 0;
  int width = 0; // cells
  int height = 0;
};

// Immutable; called from several threads at once, each with a handle of its own of GDAL's.
class RasterLevels {
public:
  // Of a band: its values, opaque where it has data, or what is no data, opaque, and values of 0.
  enum class Shown : std::uint8_t { Data, Holes };
  // `band`: its values, scaled and less Bias(); 0: the raster is an image, its colours 0 to 255.
  // Throws Error naming `object`, see ImageLayer.h.
  RasterLevels(std::string object, std::string path, int band, const RasterLayerOptions& options,
               Shown shown = Shown::Data);
  ~RasterLevels();
  RasterLevels(const RasterLevels&) = delete;
  RasterLevels& operator=(const RasterLevels&) = delete;

  const std::string& Object() const { return this->Object_; }
  int Width() const { return this->Width_; }
  int Height() const { return this->Height_; }
  int Channels() const { return this->Channels_; } // 3: RGB; 1: grey, values
  int ColumnsAt(int level) const { return int(1 + ((std::int64_t(this->Width_) - 1) >> level)); }
  int RowsAt(int level) const { return int(1 + ((std::int64_t(this->Height_) - 1) >> level)); }

  // Channels() floats a cell, each times the opacity, and then the opacity, 0 to 1; row by row. The
  // mean over the cell, from the file's overviews where they are as fine. Throws Error(Io,
  // Corrupt).
  void Read(const LevelWindow& window, float* cells) const;
  // Of pixels that are kept, of formats whose parts cannot be read by themselves.
  std::size_t KeptBytes() const { return this->KeptBytes_; }

  // Values are kept as floats: those around it are the most exact.
  void SetBias(double bias) { this->Bias_ = bias; }
  double Bias() const { return this->Bias_; }
  // Least and greatest; of a large file of an overview, or of pixels here and there: then
  // `exact` is false. Throws Error(Corrupt) where there is no value at all.
  std::array<double, 2> FindRange(bool& exact) const;
  const std::string& Unit() const { return this->Unit_; }

  // What the file says of its place.
  struct Georeference {
    Crs crs;
    bool placed = false;
    Eigen::Affine2d pixelToMap = Eigen::Affine2d::Identity();
  };
  const Georeference& Place() const { return this->Place_; }
  std::vector<std::string>& Warnings() { return this->Warnings_; }

private:
  // One of the raster's resolutions: its bands in one handle.
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<GDALRasterBand*> colors;
    GDALRasterBand* alpha = nullptr;
    std::vector<GDALRasterBand*> masks; // opaque where any of them is
    bool gaps = false;                  // see GivesZerosForGaps
    bool cached = false;                // of our own overviews: scaled already
  };
  struct Handle {
    DatasetPointer file;
    std::vector<DatasetPointer> overviews; // made by us
    std::vector<Level> levels;             // the raster itself, then ever coarser
  };
  // Pixels as the file has them: of its type, colours and opacity one after the other; `mask` is
  // empty where all is opaque.
  struct Raw {
    std::vector<std::uint8_t> samples;
    std::vector<std::uint8_t> mask;
  };

  std::unique_ptr<Handle> Open(std::vector<std::string>& warnings) const;
  void AddLevels(GDALDataset& file, std::vector<Level>& levels) const;
  void Inspect(GDALDataset& file);
  void InspectImage(GDALDataset& file);
  void InspectBand(GDALRasterBand& band);
  void With(const std::function<void(Handle&)>& use) const;
  // Overviews of our own, in RasterOverviews.cxx.
  void PlanOverviews(GDALDataset& file, const std::string& folder, bool hasOwn);
  void MakeOverviews(const LevelWindow& window) const;
  void AddOverviews(Handle& handle) const;
  bool AddOverview(Handle& handle, int level) const;
  void WriteOverview(Handle& handle, int level) const;
  void RemoveOverviews() const;
  std::string OverviewFileOf(int level) const;
  void ReadCells(Handle& handle, const LevelWindow& window, float* cells) const;
  // Pixels, in RasterPixels.cxx.
  void PlanKeeping(GDALDataset& file);
  void ReadRaw(const Level& level, const RasterWindow& part, int columns, int rows, Raw& raw) const;
  std::shared_ptr<const Raw> KeptOf(const Handle& handle, const Level& level) const;
  void Convert(const Level& level, const Raw& raw, std::size_t first, std::size_t count,
               float* pixels) const;

  std::string Object_;
  std::string Path_;
  int Band_ = 0;
  Shown Shown_ = Shown::Data;
  NetworkLimits Network_;
  FileState File_;
  FilesGuard::Look Look_; // of the guard under which it was opened
  bool Remote_ = false;

  int Width_ = 0;
  int Height_ = 0;
  int Bands_ = 0;
  GDALDataType Type_ = GDT_Byte;
  int Channels_ = 1;
  bool Alpha_ = false;
  std::vector<std::array<float, 4>> Palette_; // r g b 0 to 255, opacity 0 to 1
  double Scale_ = 1.0;
  double Offset_ = 0.0;
  double Bias_ = 0.0;
  double AlphaScale_ = 1.0;
  std::string Unit_;
  Georeference Place_;
  std::vector<std::string> Warnings_;

  std::string OverviewStem_; // empty: none are needed
  std::string Folder_;
  std::string Identity_; // of what they are made from
  bool InMemory_ = false;
  mutable std::mutex Making_;
  mutable std::atomic<bool> OverviewsReady_{false};

  bool Keeps_ = false; // levels that are read are decoded once and stay in memory
  mutable std::atomic<std::size_t> KeptBytes_{0};
  mutable std::mutex Keeping_;
  mutable std::vector<std::shared_ptr<const Raw>> Kept_; // a level each

  mutable std::mutex Mutex_;
  mutable std::vector<std::unique_ptr<Handle>> Idle_;
};

} // namespace dspace

#endif
