// An OpenGL context by EGL.
#ifndef DSPACE_RENDER_EGL_CONTEXT_H
#define DSPACE_RENDER_EGL_CONTEXT_H

#include <memory>

#include <dspace/render/GraphicsContext.h>

namespace dspace {

// A context that needs neither display nor X server: an EGL device (GPU) where there is one,
// Mesa's surfaceless platform (llvmpipe) otherwise. DSPACE_EGL=device|surfaceless chooses.
// DSPACE_OPENGL_DEBUG=1 makes a debug context (DebugOutput.h).
// Throws Error(Resource) saying what was tried and what each answered.
std::unique_ptr<GraphicsContext> MakeEglContext();

} // namespace dspace

#endif
