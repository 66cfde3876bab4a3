// An OpenGL context, wherever it comes from.
#ifndef DSPACE_RENDER_GRAPHICS_CONTEXT_H
#define DSPACE_RENDER_GRAPHICS_CONTEXT_H

#include <memory>
#include <string>

namespace dspace {

// One OpenGL 4.5 core context without a window of its own: EGL here, Qt's in the widgets.
class GraphicsContext {
public:
  virtual ~GraphicsContext() = default;
  virtual void MakeCurrent() = 0; // throws Error(Resource)
  virtual bool IsCurrent() const = 0;
  virtual std::string Description() const = 0; // platform and version, for messages
};

// A context that needs neither display nor X server: an EGL device (GPU) where there is one,
// Mesa's surfaceless platform (llvmpipe) otherwise. DSPACE_EGL=device|surfaceless chooses.
// Throws Error(Resource) saying what was tried and what each answered.
std::unique_ptr<GraphicsContext> MakeEglContext();

} // namespace dspace

#endif
