// Pictures and planes to image files, through OpenImageIO.
#ifndef DSPACE_RENDER_IMAGE_WRITER_H
#define DSPACE_RENDER_IMAGE_WRITER_H

#include <cstdint>
#include <string>
#include <vector>

namespace dspace {

enum class ImagePlane {
  Color,
  Depth,
  Range,
  Label,
  Radiance,
  LitFraction,
  Incidence,
  Emission,
  Phase
};

struct ImageFileOptions {
  int jpegQuality = 95; // 1 to 100
};

// The type is the extension's: .png .jpg .jpeg .tif .tiff .exr. AtomicFile writes it, so that a
// failure leaves an earlier file as it was. The same input gives the same bytes.
//
// Color: PNG, JPEG, TIFF with 8 bits, sRGB; EXR with linear half floats. RGB: alpha is left out.
// Floats: TIFF or EXR with 32-bit floats, as Capture has them: Depth in channel Z [m], Range in R
// [m], Radiance in R, G, B [W/m^2/sr], LitFraction in "lit", the angles in "incidence", "emission"
// and "phase" [deg]. Label: EXR with 32-bit integers; PNG or TIFF with 16 bits, rejected when an id
// is above 65535.
//
// All throw Error naming the file: InvalidArgument (extension, options, sizes that do not fit), Io
// (folder absent, not writable, disk full).

// The checks that need no picture: extension, options, folder.
void CheckImageFile(const std::string& path, ImagePlane plane,
                    const ImageFileOptions& options = {});

// `rgba`: 4 bytes a pixel, row 0 on top.
void WriteColor(const std::string& path, int width, int height,
                const std::vector<std::uint8_t>& rgba, const ImageFileOptions& options = {});
// `plane`: one of floats.
void WriteFloats(const std::string& path, ImagePlane plane, int width, int height,
                 const std::vector<float>& values);
void WriteLabel(const std::string& path, int width, int height,
                const std::vector<std::uint32_t>& label);

} // namespace dspace

#endif
