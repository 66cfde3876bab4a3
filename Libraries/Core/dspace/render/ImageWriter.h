// Pictures and planes to image files, through OpenImageIO.
#ifndef DSPACE_RENDER_IMAGE_WRITER_H
#define DSPACE_RENDER_IMAGE_WRITER_H

#include <cstdint>
#include <string>
#include <vector>

namespace dspace {

enum class ImagePlane { Color, Depth, Range, Label };

struct ImageFileOptions {
  int jpegQuality = 95; // 1 to 100
};

// The type is the extension's: .png .jpg .jpeg .tif .tiff .exr. AtomicFile writes it, so that a
// failure leaves an earlier file as it was. The same input gives the same bytes.
//
// Color: PNG, JPEG, TIFF with 8 bits, sRGB; EXR with linear half floats. RGB: alpha is left out.
// Depth: TIFF or EXR with 32-bit floats, metres, channel Z; +infinity where nothing was hit.
// Range: as Depth, channel R.
// Label: EXR with 32-bit integers; PNG or TIFF with 16 bits, rejected when an id is above 65535.
//
// All throw Error naming the file: InvalidArgument (extension, options, sizes that do not fit), Io
// (folder absent, not writable, disk full).

// The checks that need no picture: extension, options, folder.
void CheckImageFile(const std::string& path, ImagePlane plane,
                    const ImageFileOptions& options = {});

// `rgba`: 4 bytes a pixel, row 0 on top.
void WriteColor(const std::string& path, int width, int height,
                const std::vector<std::uint8_t>& rgba, const ImageFileOptions& options = {});
void WriteDepth(const std::string& path, int width, int height, const std::vector<float>& depth);
void WriteRange(const std::string& path, int width, int height, const std::vector<float>& range);
void WriteLabel(const std::string& path, int width, int height,
                const std::vector<std::uint32_t>& label);

} // namespace dspace

#endif
