#include "vtkDspaceFrame.h"

#include "vtkObjectFactory.h"
#include "vtkTransform.h"

vtkStandardNewMacro(vtkDspaceFrame);

vtkDspaceFrame::vtkDspaceFrame() = default;
vtkDspaceFrame::~vtkDspaceFrame() = default;

vtkTransform* vtkDspaceFrame::GetTransform() {
  return this->Transform;
}

void vtkDspaceFrame::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Id: " << this->Id << "\n" << indent << "Alive: " << this->Alive << "\n";
}
