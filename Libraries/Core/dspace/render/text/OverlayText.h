// Text over a picture, as VTK draws it.
#ifndef DSPACE_RENDER_OVERLAY_TEXT_H
#define DSPACE_RENDER_OVERLAY_TEXT_H

#include <array>
#include <mutex>
#include <string>

#include "vtkSmartPointer.h"

class vtkTextActor;

namespace dspace {

// VTK has one text renderer for all threads. Code that uses it must hold this lock.
std::unique_lock<std::recursive_mutex> LockTextRenderer();

// Monospaced text at a place in pixels, `fontSize` pixels high; colour in sRGB with opacity, 0
// to 1. It locks the text renderer by itself when it is drawn.
vtkSmartPointer<vtkTextActor> MakeOverlayText(const std::string& text, int fontSize,
                                              const std::array<double, 4>& color);

} // namespace dspace

#endif
