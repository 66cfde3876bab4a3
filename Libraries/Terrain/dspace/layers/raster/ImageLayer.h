// Colour images of any size and in any CRS, read as tiles.
#ifndef DSPACE_LAYERS_IMAGELAYER_H
#define DSPACE_LAYERS_IMAGELAYER_H

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include <dspace/layers/ColorLayer.h>
#include <dspace/layers/ColorRamp.h>
#include <dspace/raster/ElevationSource.h>
#include <dspace/raster/RasterPlace.h>

namespace dspace {

// Options that complete or replace the georeference of a file.
struct RasterLayerOptions {
  std::optional<std::string> crs; // replaces the file's; the terrain's where the file has none
  // Map x, y of the outer corners of its top-left and bottom-right pixels, in its CRS; replaces the
  // file's geotransform.
  std::optional<std::array<double, 4>> extent; // left, top, right, bottom
  NetworkLimits network;
  // A folder for averaged overviews of local files that have none and are larger than 4096 pixels a
  // side ("...-layer-N.tif", checked against the file's size and time); empty: they are kept in
  // memory of the process only, a twelfth of the pixels, compressed. The first read of texels that
  // are four pixels and more makes them, once; reads of such texels wait for it, others do not.
  // Large files on a server without overviews are decimated far away, with a warning.
  std::string cacheFolder;
};

// 1 band: grey, or with a colour table; 2: grey and opacity; 3: RGB; 4: RGBA; 8 or 16 bits a
// channel. No-data and masks are transparent. One without georeference is stretched over `terrain`,
// the extent of the terrain's own raster. A plate carree image that goes once around a body fits a
// terrain whose left edge is elsewhere. A texel is the mean of the image's bilinear surface over
// it, placed to a hundredth of a pixel, or of a texel where that is larger; means are of sRGB
// values, as overviews are, weighted by opacity. What the file's overviews show far away is as good
// as they are. Local files whose parts cannot be read by themselves (JPEG, PNG, GIF, WebP, a TIFF
// in up to four blocks) are decoded once, whole, and stay in memory up to 64 million pixels: the
// bytes of their samples, KeptBytes() has them; larger ones are decoded for each tile, with a
// warning. Throws Error naming the file: NotFound, Corrupt, Io, Unsupported (bands; a CRS of
// another body), InvalidArgument (extent, no overlap with the terrain).
std::shared_ptr<const ColorLayer> OpenImageLayer(const std::string& path,
                                                 const RasterPlace& terrain,
                                                 const RasterLayerOptions& options = {});

} // namespace dspace

#endif
