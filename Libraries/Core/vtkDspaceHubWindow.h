/**
 * @class vtkDspaceHubWindow
 * @brief The one render window of a render context, into whose slots the viewports draw.
 *
 * VTK uploads an actor's mesh again for each window. Therefore there is one window; a viewport is a
 * set of framebuffer, renderers and size that is swapped in while it draws.
 * Internal: use vtkDspaceViewport::Run().
 */
#ifndef vtkDspaceHubWindow_h
#define vtkDspaceHubWindow_h

#include <memory>

#include "vtkDspaceCoreModule.h"
#include "vtkGenericOpenGLRenderWindow.h"

namespace dspace {
class GraphicsContext;
}
class vtkOpenGLFramebufferObject;
class vtkRendererCollection;

class VTKDSPACECORE_EXPORT vtkDspaceHubWindow : public vtkGenericOpenGLRenderWindow {
public:
  static vtkDspaceHubWindow* New();
  vtkTypeMacro(vtkDspaceHubWindow, vtkGenericOpenGLRenderWindow);

  /// Takes the context and initialises OpenGL. Throws dspace::Error(Resource).
  void SetContext(std::unique_ptr<dspace::GraphicsContext> context);
  dspace::GraphicsContext* GetContext() const { return this->Context.get(); }

  /// The state that a viewport swaps in; framebuffer and renderers stay owned by the viewport.
  struct Slot {
    vtkOpenGLFramebufferObject* framebuffer;
    vtkRendererCollection* renderers;
    int width;
    int height;
  };
  /// Makes the context current and the slot the window's own, until the next call.
  void Activate(const Slot& slot);
  Slot GetSlot() const;
  /// Notes that `owner` sets uniforms of programs of this window. Returns whether nobody else did
  /// since it last did: programs are shared by all viewports.
  bool NoteUniformsOf(const void* owner) {
    const bool same = this->UniformOwner == owner;
    this->UniformOwner = owner;
    return same;
  }

  /// Back to the window's own members: before a slot's framebuffer is destroyed.
  void Deactivate();

  void MakeCurrent() override;
  bool IsCurrent() override;
  void SetInteractor(vtkRenderWindowInteractor*) override {}
  void Render() override;
  int GetColorBufferSizes(int* rgba) override;
  void Finalize() override;

protected:
  vtkDspaceHubWindow();
  ~vtkDspaceHubWindow() override;
  void OpenGLInitContext() override;

private:
  vtkDspaceHubWindow(const vtkDspaceHubWindow&) = delete;
  void operator=(const vtkDspaceHubWindow&) = delete;
  std::unique_ptr<dspace::GraphicsContext> Context;
  vtkOpenGLFramebufferObject* OwnFramebuffers[3];
  vtkRendererCollection* OwnRenderers;
  const void* UniformOwner = nullptr;
};

#endif
