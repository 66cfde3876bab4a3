/**
 * @class vtkDspaceScene
 * @brief A scene's frames as vtkTransforms, for VTK code that attaches props to them.
 *
 * A frame is mirrored with its ancestors on first access, and then follows every change of the
 * tree.
 */
#ifndef vtkDspaceScene_h
#define vtkDspaceScene_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

#ifndef __VTK_WRAP__
#include <dspace/scene/Scene.h>
#endif

class vtkDspaceFrame;

class VTKDSPACESESSION_EXPORT vtkDspaceScene : public vtkObject {
public:
  static vtkDspaceScene* New();
  vtkTypeMacro(vtkDspaceScene, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  std::string GetName();
  /// Null if the frame is not in the tree.
  vtkDspaceFrame* GetFrame(unsigned long long id);
  vtkDspaceFrame* GetFrame(const std::string& path);

#ifndef __VTK_WRAP__
  /// Call once, before anything else.
  void SetScene(std::shared_ptr<dspace::Scene> scene);
  bool Mirrors(const dspace::Scene& scene) const;
#endif

protected:
  vtkDspaceScene();
  ~vtkDspaceScene() override;

private:
  vtkDspaceScene(const vtkDspaceScene&) = delete;
  void operator=(const vtkDspaceScene&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
