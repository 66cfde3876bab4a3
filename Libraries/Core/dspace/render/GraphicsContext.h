// Interface to an OpenGL context.
#ifndef DSPACE_RENDER_GRAPHICS_CONTEXT_H
#define DSPACE_RENDER_GRAPHICS_CONTEXT_H

#include <memory>
#include <string>

namespace dspace {

// One OpenGL 4.5 core context without a window of its own: EGL here, Qt's in the widgets.
class GraphicsContext {
public:
  virtual ~GraphicsContext();
  virtual void MakeCurrent() = 0; // throws Error(Resource)
  virtual bool IsCurrent() const = 0;
  // Takes it off this thread where windows of other code could not draw otherwise; MakeCurrent()
  // undoes it. Default: does nothing.
  virtual void Release() {}
  virtual std::string Description() const = 0; // platform and version, for messages

  // The one that was made current last in this thread; null: none, or it is gone. The platform of
  // another one may not know that its own is current no longer.
  static GraphicsContext* Latest();

protected:
  void Made(); // MakeCurrent() has succeeded
};

} // namespace dspace

#endif
