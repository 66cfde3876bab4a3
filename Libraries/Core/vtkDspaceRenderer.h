/**
 * @class vtkDspaceRenderer
 * @brief VTK's renderer with reversed float depth, which lets a viewport draw its scene first.
 *
 * Props that VTK code adds are drawn after the scene, into the same depth. Internal.
 */
#ifndef vtkDspaceRenderer_h
#define vtkDspaceRenderer_h

#include <functional>

#include "vtkDspaceCoreModule.h"
#include "vtkOpenGLRenderer.h"

class VTKDSPACECORE_EXPORT vtkDspaceRenderer : public vtkOpenGLRenderer {
public:
  static vtkDspaceRenderer* New();
  vtkTypeMacro(vtkDspaceRenderer, vtkOpenGLRenderer);

  std::function<void()> ClearPicture; // background and depth
  std::function<void()> DrawScene;    // between clearing and the props

  void Clear() override;
  int UpdateGeometry(vtkFrameBufferObjectBase* fbo = nullptr) override;

protected:
  vtkDspaceRenderer();
  ~vtkDspaceRenderer() override = default;

private:
  vtkDspaceRenderer(const vtkDspaceRenderer&) = delete;
  void operator=(const vtkDspaceRenderer&) = delete;
};

#endif
