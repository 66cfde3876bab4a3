/**
 * @class vtkDspaceRenderContext
 * @brief The one OpenGL context and render window (the hub) that draws every viewport.
 *
 * Usually one per process, shared by all scenes. Meshes and textures are uploaded once for all
 * objects, scenes and viewports that show them, and are released with the last of these.
 */
#ifndef vtkDspaceRenderContext_h
#define vtkDspaceRenderContext_h

#include <memory>
#include <string>

#include "vtkDspaceCoreModule.h"
#include "vtkObject.h"

#ifndef __VTK_WRAP__
#include <dspace/render/Capture.h>
#include <dspace/render/GraphicsContext.h>
#endif

class vtkDspaceHubWindow;
class vtkDspaceViewport;
class vtkRenderWindow;
namespace dspace {
class CustomDrawers;
class GpuStore;
class VtkMessages;
} // namespace dspace

class VTKDSPACECORE_EXPORT vtkDspaceRenderContext : public vtkObject {
public:
  static vtkDspaceRenderContext* New();
  vtkTypeMacro(vtkDspaceRenderContext, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// "llvmpipe (LLVM 15.0.6, 256 bits)", a GPU's name, ...; empty, with a VTK error, if no
  /// context can be created.
  std::string GetRendererName();
  std::string GetVersion();
  vtkRenderWindow* GetRenderWindow();

  /// Takes the context off this thread where windows of other code may draw by GLX, such as a
  /// vtkRenderWindow on X11, which cannot draw in a thread that has an EGL context. A session does
  /// so after each command. A C++ program that draws viewports itself calls it before such a window
  /// draws.
  void Release();

#ifndef __VTK_WRAP__
  /// Sets the context (default: MakeEglContext()). The first viewport calls it if it was not
  /// called.
  void Initialize(std::unique_ptr<dspace::GraphicsContext> context = nullptr);
  const dspace::RenderStatistics& GetStatistics() const;
  dspace::RenderStatistics& CountStatistics(); // for drawing code
  vtkDspaceHubWindow* GetHub();
  dspace::GpuStore& GetStore();
  /// The drawers of geometry that is not made of meshes; libraries with such geometry add theirs.
  dspace::CustomDrawers& GetDrawers();
  /// Messages of VTK while this context draws; its warnings are for the user.
  dspace::VtkMessages& GetMessages();
#endif

protected:
  vtkDspaceRenderContext();
  ~vtkDspaceRenderContext() override;

private:
  vtkDspaceRenderContext(const vtkDspaceRenderContext&) = delete;
  void operator=(const vtkDspaceRenderContext&) = delete;
  std::string AskOpenGL(unsigned int what);
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
