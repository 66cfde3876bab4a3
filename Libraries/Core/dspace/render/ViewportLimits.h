// How large a viewport may be: what its sizes and samples are checked against before they change.
#ifndef DSPACE_RENDER_VIEWPORT_LIMITS_H
#define DSPACE_RENDER_VIEWPORT_LIMITS_H

#include <array>
#include <string>

#include <dspace/scene/ViewLook.h>

class vtkDspaceHubWindow;

namespace dspace {

// 1 to 16384 pixels a side. Throws Error(InvalidArgument) about `viewport`.
void CheckSize(const std::string& viewport, int width, int height);

// 1 to 8 samples across and down a pixel, as far as OpenGL draws so large a picture and up to 2^28
// samples in all; makes the window current. Throws Error(InvalidArgument) about `viewport`.
void CheckSamples(vtkDspaceHubWindow& window, const std::string& viewport, int width, int height,
                  int samples);

// A background's colour, 0 to 1. Throws Error(InvalidArgument) about `viewport`.
void CheckColor(const std::string& viewport, const std::array<double, 3>& color);

// Ranges are those of ViewLook.h; makes the window current. Throws Error(InvalidArgument) about
// `viewport`, also for shadow maps that are larger than OpenGL has.
void CheckLook(vtkDspaceHubWindow& window, const std::string& viewport, const ViewLook& look);

// A place to pick at, in pixels of a picture of this size. Throws Error(InvalidArgument) about
// `viewport`.
void CheckPick(const std::string& viewport, double x, double y, int radius, int width, int height);

} // namespace dspace

#endif
