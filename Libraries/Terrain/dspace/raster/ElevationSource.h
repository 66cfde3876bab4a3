// Heights in metres from any raster that GDAL opens.
#ifndef DSPACE_TERRAIN_ELEVATIONSOURCE_H
#define DSPACE_TERRAIN_ELEVATIONSOURCE_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/crs/Crs.h>
#include <dspace/crs/VerticalDatum.h>

namespace dspace {

// A rectangle of pixels; (0, 0) is the raster's first column and row.
struct RasterWindow {
  int column = 0;
  int row = 0;
  int width = 0;
  int height = 0;
};

// Limits for rasters on a server (/vsicurl/, http://, https://, and mosaics of such). They replace
// GDAL's own settings (GDAL_HTTP_...). A failing read ends after at most (retries + 2) times a
// limit, a failing opening after (retries + 1) times. The destructor of a pyramid waits for its
// running reads.
struct NetworkLimits {
  double connect = 10.0;   // [s] to connect
  double stall = 10.0;     // [s] with under 100 bytes a second; rounded up to whole seconds
  double request = 60.0;   // [s] for one request as a whole
  int retries = 1;         // after 429, 502, 503, 504 and time-outs, within one read; 0 to 10
  double retryDelay = 0.5; // [s] before the first retry; grows
};

// Options that complete or replace statements of a file. A file states its vertical datum by a
// compound CRS, by an offset of a body's radius (ISIS), or by a metadata item VERTICAL_DATUM with
// the text of VerticalDatum::Text(), such as "sphere:1737400".
struct ElevationOptions {
  int band = 1; // counted from 1, as GDAL does
  // By hand: metres = value * verticalScale + verticalOffset. Either one replaces the file's own
  // scale, offset and unit as a whole (the other is then 1 or 0). Scale finite, not 0.
  std::optional<double> verticalScale;
  std::optional<double> verticalOffset; // [m]
  std::optional<VerticalDatum> verticalDatum;
  // Pixels of this value, as the file stores it, have no data, besides those that the file states
  // itself. Finite. The file's overviews are not used: they may be means of such pixels and others.
  std::optional<double> noData;
  std::optional<std::string> crs;     // replaces the file's; see Crs::FromText
  std::optional<double> pixelSize;    // [map units], for a raster without georeference; default 1
  std::optional<RasterWindow> window; // only these pixels; must lie within the raster
  // Only the pixels that meet this part of the map: x, y of its corners: left, top, right, bottom.
  // Whole turns of longitude are added to it towards the raster. Not with `window`.
  std::optional<std::array<double, 4>> mapWindow;
  // Of a degree grid: columns that go once around the body, and rows from pole to pole, do so
  // exactly. Each may be off by up to a pixel, since files round their pixel sizes; pixelToMap is
  // stretched about the middle then, and a warning states by how much.
  bool closesAround = false;
  NetworkLimits network;
  // A folder of ElevationCache: its overviews are read if the raster has none. Empty: no cache.
  std::string overviewCache;
};

// Properties of a source after applying the options.
struct ElevationInfo {
  std::string path;
  std::string driver;   // GDAL's short name
  std::string dataType; // GDAL's name of the band's type
  RasterWindow window;  // the pixels that are read, in the file's own columns and rows
  Crs crs;
  VerticalDatum verticalDatum;
  // (column, row) of the window to map (x, y); (0, 0) is the top-left CORNER of its first pixel,
  // (0.5, 0.5) the pixel's centre, where its post stands.
  Eigen::Affine2d pixelToMap = Eigen::Affine2d::Identity();
  double overlapColumns = 0.0; // by which the columns overlapped before they were closed around
  bool georeferenced = true;   // false: pixelToMap is made up from the pixel size
  double verticalScale = 1.0;  // metres = value * verticalScale + verticalOffset
  double verticalOffset = 0.0; // [m]; with a Radius datum the heights returned are less its radius
  std::string unit;            // as the file states it; may be empty
  int overviews = 0;           // the file's, or the cache's
  bool overviewsAreCached = false;
  bool remote = false;               // it, or what it is a mosaic of, is on a server
  std::vector<std::string> warnings; // each names what was assumed and how to state it
};

// An open raster. GDAL's messages become errors and warnings. Reads may come from any thread and
// are serialized. Nothing is ever written beside the file.
class ElevationSource {
public:
  // Throws Error naming the file: NotFound; Io; Corrupt (damaged, empty); Unsupported (not a
  // raster, complex values, unit not known, a geocentric CRS);
  // InvalidArgument (an option, a degenerate geotransform, a window outside).
  explicit ElevationSource(const std::string& path, const ElevationOptions& options = {});
  ~ElevationSource();

  const ElevationInfo& Info() const { return this->Info_; }

  // Heights [m] above the vertical datum of `window` (columns and rows of Info().window), row by
  // row from the top; NaN where there is no data. Throws Error(Corrupt) when the file cannot be
  // read there, Error(InvalidArgument) for a window outside.
  std::vector<double> Read(const RasterWindow& window) const;
  std::vector<double> Read() const; // all of Info().window
  // The same with one value per `factor` x `factor` pixels from the window's first on (fewer at its
  // right and bottom edge). The value is from an overview of the file, if there is one for the
  // factor; else the mean from the cache, if the window begins at a multiple of `factor` in the
  // file; else the pixel in the middle. Throws Error(Corrupt) if the cache is damaged; the cache
  // file is then removed, so that the next call succeeds.
  std::vector<double> ReadReduced(const RasterWindow& window, int factor) const;

  // Uses the current overviews of ElevationOptions::overviewCache from the next ReadReduced on;
  // Info() does not change. Returns their number of levels; 0 if there are none that fit or if the
  // file has overviews.
  int LoadOverviews();

  // The band and the files that the raster consists of, with their sizes and times of change.
  std::string Identity() const;

private:
  struct Implementation;
  void ReadPart(const RasterWindow& part, int columns, int rows, int stride, double* values,
                std::uint8_t* mask) const;
  void ReadSparse(const RasterWindow& part, int columns, int rows, int stride, double* values,
                  std::uint8_t* mask) const;
  void ReadPixels(const RasterWindow& part, int columns, int rows, int stride, double* values,
                  std::uint8_t* mask) const;
  bool ReadCached(const RasterWindow& window, int factor, double* values) const;
  std::unique_ptr<Implementation> Impl_;
  ElevationInfo Info_;
};

} // namespace dspace

#endif
