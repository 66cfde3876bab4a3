#include <dspace/render/EmptyVertexArray.h>

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"

namespace dspace {

EmptyVertexArray::~EmptyVertexArray() {
  this->Release();
}

void EmptyVertexArray::Draw(unsigned int primitive, int count) {
  if (!this->Array_) {
    glGenVertexArrays(1, &this->Array_);
  }
  glBindVertexArray(this->Array_);
  glDrawArrays(primitive, 0, count);
  glBindVertexArray(0);
}

void EmptyVertexArray::DrawScreen() {
  this->Draw(GL_TRIANGLES, 3);
}

void EmptyVertexArray::Release() {
  if (this->Array_ && this->Window_->GetContext()) {
    this->Window_->MakeCurrent();
    glDeleteVertexArrays(1, &this->Array_);
  }
  this->Array_ = 0;
}

} // namespace dspace
