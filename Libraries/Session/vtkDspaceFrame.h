/**
 * @class vtkDspaceFrame
 * @brief A frame of a scene for VTK code: read-only, kept up to date.
 *
 * vtkDspaceScene creates it on demand. Changes of the transform are not recorded, and the frame's
 * next move overwrites them.
 */
#ifndef vtkDspaceFrame_h
#define vtkDspaceFrame_h

#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkNew.h"
#include "vtkObject.h"

class vtkTransform;

class VTKDSPACESESSION_EXPORT vtkDspaceFrame : public vtkObject {
public:
  static vtkDspaceFrame* New();
  vtkTypeMacro(vtkDspaceFrame, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Frame to root: the local pose with the parent's transform as its input.
  vtkTransform* GetTransform();
  unsigned long long GetId() const { return this->Id; }
  /// False after the frame was removed. The transform then keeps its value.
  bool GetAlive() const { return this->Alive; }

protected:
  vtkDspaceFrame();
  ~vtkDspaceFrame() override;

private:
  vtkDspaceFrame(const vtkDspaceFrame&) = delete;
  void operator=(const vtkDspaceFrame&) = delete;
  friend class vtkDspaceScene;
  unsigned long long Id = 0;
  bool Alive = true;
  vtkNew<vtkTransform> Transform;
};

#endif
