// Cameras of SPICE instrument kernels: internal, not installed.
#ifndef DSPACE_CAMERA_FILES_INSTRUMENT_KERNEL_H
#define DSPACE_CAMERA_FILES_INSTRUMENT_KERNEL_H

#include <string>
#include <vector>

#include <dspace/camera/CameraModel.h>

namespace dspace {

// Whether a text begins like an instrument kernel: "KPL/IK".
bool IsInstrumentKernel(const std::string& text);

// The instruments with a rectangular field of view and a number of pixels (INS..._PIXEL_SAMPLES,
// INS..._PIXEL_LINES), as pinholes: "INS-82360". M is the instrument's frame; Z is along the
// boresight, X along the frame's X (or Y, where the boresight is along X), so that samples grow
// along it. The field of view is the image's; distortion is not in it.
//
// Throws Error(Corrupt) for a damaged kernel, Error(Unsupported) where it has no such instrument.
std::vector<CameraModel> ParseInstrumentKernel(const std::string& text, const std::string& label);

} // namespace dspace

#endif
