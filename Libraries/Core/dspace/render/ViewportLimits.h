// How large a viewport may be: what its sizes and samples are checked against before they change.
#ifndef DSPACE_RENDER_VIEWPORT_LIMITS_H
#define DSPACE_RENDER_VIEWPORT_LIMITS_H

#include <string>

class vtkDspaceHubWindow;

namespace dspace {

// 1 to 16384 pixels a side. Throws Error(InvalidArgument) about `viewport`.
void CheckSize(const std::string& viewport, int width, int height);

// 1 to 8 samples across and down a pixel, as far as OpenGL draws so large a picture and up to 2^28
// samples in all; makes the window current. Throws Error(InvalidArgument) about `viewport`.
void CheckSamples(vtkDspaceHubWindow& window, const std::string& viewport, int width, int height,
                  int samples);

} // namespace dspace

#endif
