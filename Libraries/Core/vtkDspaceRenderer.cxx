#include "vtkDspaceRenderer.h"

#include "vtk_glew.h"

#include "vtkCullerCollection.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLState.h"

vtkStandardNewMacro(vtkDspaceRenderer);

vtkDspaceRenderer::vtkDspaceRenderer() {
  this->GetCullers()->RemoveAllItems(); // they misread a reversed projection
}

void vtkDspaceRenderer::Clear() {
  this->ClearPicture();
}

int vtkDspaceRenderer::UpdateGeometry(vtkFrameBufferObjectBase* fbo) {
  this->DrawScene();
  if (this->PropArrayCount == 0) {
    return 0;
  }
  vtkOpenGLState* state = this->GetState();
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  state->vtkglDepthFunc(GL_GEQUAL);
  const int drawn = this->Superclass::UpdateGeometry(fbo);
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  state->vtkglDepthFunc(GL_LEQUAL);
  return drawn;
}
