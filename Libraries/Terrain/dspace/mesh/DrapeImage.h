// Colour images that lie on a terrain: shaded relief, colour by height, or any image warped to it.
#ifndef DSPACE_TERRAIN_DRAPEIMAGE_H
#define DSPACE_TERRAIN_DRAPEIMAGE_H

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <dspace/layers/ColorRamp.h>
#include <dspace/raster/RasterPlace.h>
#include <dspace/surface/GridTerrain.h>

namespace dspace {

// RGB, 8 bits a channel, sRGB-encoded; row 0 is the top row, rows tightly packed. It covers the
// terrain's raster from pixel edge to pixel edge: tile texture coordinates (0, 0) are the
// bottom-left corner of its bottom row, (1, 1) the top-right corner of its top row.
struct DrapeImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;   // r g b
  std::vector<std::uint8_t> coverage; // empty, or one a pixel: 0 where the image had nothing
  std::vector<std::string> warnings;
};

struct ShadedReliefOptions {
  double sunAzimuth_deg = 315.0;  // clockwise from the scene's north
  double sunElevation_deg = 45.0; // 0 to 90
  double ambient = 0.25;          // 0 to 1: brightness of what faces away
  double exaggeration = 1.0;      // of heights, for shading only; greater than 0
  ColorRamp ramp = {{0.85, 0.83, 0.8}};
  std::optional<double> rampLow; // [m]; the terrain's least height by default
  std::optional<double> rampHigh;
  std::array<std::uint8_t, 3> holeColor = {90, 90, 90};
  int maximumSize = 4096; // pixels along the longer side; one a post where that is fewer
};

// Lambert's law with the normals of the posts, times the ramp's colour. Throws
// Error(InvalidArgument) for an option out of range.
DrapeImage ShadedRelief(const GridTerrain& terrain, const ShadedReliefOptions& options = {});

// Where the terrain's raster lies.
RasterPlace PlaceOf(const GridTerrain& terrain);

// An image file, and what it does not say itself.
struct DrapeSource {
  std::string path;
  std::optional<std::string> crs; // replaces the file's; the terrain's where the file has none
  // Map x, y of the outer corners of its top-left and bottom-right pixels, in its CRS; replaces the
  // file's geotransform. A file without either is stretched over the terrain's raster.
  std::optional<std::array<double, 4>> extent; // left, top, right, bottom
};

struct WarpOptions {
  int maximumSize = 4096; // pixels along the longer side; fewer where the image has fewer there
  std::array<std::uint8_t, 3> background = {90, 90, 90}; // where the image has nothing
};

// Reads `source` (1 band: grey, 3: RGB, 4: RGBA, or 1 with a colour table), converts it to the
// terrain's CRS with GDAL's warper (bilinear; the mean of the pixels where it is finer), in memory.
// A plate carrée image that goes once around a body fits a grid whose left edge is elsewhere.
// Throws Error naming the file: NotFound, Corrupt, Unsupported (bands; a CRS of another body),
// InvalidArgument (extent, no overlap with the terrain).
DrapeImage WarpImage(const RasterPlace& place, const DrapeSource& source,
                     const WarpOptions& options = {});

// `top` where it has coverage, else `bottom` (its nearest pixel), in the size of `top`: an image of
// a part of the terrain over the relief of all of it.
DrapeImage Over(const DrapeImage& top, const DrapeImage& bottom);

// Width and height of a drape image of a raster, at most `maximumSize` a side; throws
// Error(InvalidArgument) unless 1 <= maximumSize <= 32768.
std::array<int, 2> DrapeSize(int columns, int rows, int maximumSize);

} // namespace dspace

#endif
