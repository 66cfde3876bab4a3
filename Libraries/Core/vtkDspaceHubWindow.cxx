#include "vtkDspaceHubWindow.h"

#include "vtk_glew.h"

#include "vtkObjectFactory.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLState.h"
#include "vtkRendererCollection.h"

#include <dspace/Error.h>
#include <dspace/render/GraphicsContext.h>

vtkStandardNewMacro(vtkDspaceHubWindow);

vtkDspaceHubWindow::vtkDspaceHubWindow() {
  this->SetOwnContext(1);
  this->SetFrameBlitModeToNoBlit();
  this->SwapBuffers = 0; // nothing is shown by this window: viewports hand their pictures out
  this->MultiSamples = 0;
  this->OwnFramebuffers[0] = this->RenderFramebuffer;
  this->OwnFramebuffers[1] = this->DisplayFramebuffer;
  this->OwnFramebuffers[2] = this->ResolveFramebuffer;
  this->OwnRenderers = this->Renderers;
}

vtkDspaceHubWindow::~vtkDspaceHubWindow() {
  this->Finalize();
}

void vtkDspaceHubWindow::SetContext(std::unique_ptr<dspace::GraphicsContext> context) {
  this->Context = std::move(context);
  this->Context->MakeCurrent();
  this->OpenGLInit();
  if (!this->Initialized) {
    throw dspace::Error(dspace::Error::Kind::Resource, "render context",
                        "OpenGL could not be initialised on " + this->Context->Description());
  }
  if (!GLEW_ARB_clip_control) {
    throw dspace::Error(dspace::Error::Kind::Resource, "render context",
                        "OpenGL 4.5 (or ARB_clip_control) is needed for reversed depth; " +
                            this->Context->Description() + " has OpenGL " +
                            reinterpret_cast<const char*>(glGetString(GL_VERSION)));
  }
}

void vtkDspaceHubWindow::OpenGLInitContext() {
  if (this->Initialized) {
    return;
  }
  this->ContextCreationTime.Modified();
  // GLEW built for GLX complains that there is no X display, after it has loaded everything.
  glewExperimental = GL_TRUE;
  const GLenum answer = glewInit();
  if ((answer != GLEW_OK && answer != GLEW_ERROR_NO_GLX_DISPLAY) || !glGenVertexArrays ||
      !glDrawElementsInstanced) {
    throw dspace::Error(dspace::Error::Kind::Resource, "render context",
                        std::string("the OpenGL functions could not be loaded: ") +
                            reinterpret_cast<const char*>(glewGetErrorString(answer)));
  }
  this->GlewInitValid = true;
  this->Initialized = true;
  this->MaximumHardwareLineWidth = 1.0f;
  GLfloat range[2] = {1.0f, 1.0f};
  glGetFloatv(GL_ALIASED_LINE_WIDTH_RANGE, range);
  this->MaximumHardwareLineWidth = range[1];
}

void vtkDspaceHubWindow::MakeCurrent() {
  if (this->Context && !this->Context->IsCurrent()) {
    this->Context->MakeCurrent();
  }
}

bool vtkDspaceHubWindow::IsCurrent() {
  return this->Context && this->Context->IsCurrent();
}

int vtkDspaceHubWindow::GetColorBufferSizes(int* rgba) {
  // A surfaceless context reports zero bits; what is drawn into has eight.
  for (int i = 0; i < 4; ++i) {
    rgba[i] = 8;
  }
  return 8;
}

void vtkDspaceHubWindow::Render() {
  this->MakeCurrent();
  // Not the generic window's, which queries the whole OpenGL state again for each picture.
  this->vtkOpenGLRenderWindow::Render(); // NOLINT(bugprone-parent-virtual-call)
}

void vtkDspaceHubWindow::Activate(const Slot& slot) {
  this->MakeCurrent();
  this->RenderFramebuffer = slot.framebuffer;
  this->DisplayFramebuffer = slot.framebuffer;
  this->ResolveFramebuffer = slot.framebuffer;
  this->Renderers = slot.renderers;
  this->LastMultiSamples = this->MultiSamples = 0;
  this->Size[0] = slot.width;
  this->Size[1] = slot.height;
}

vtkDspaceHubWindow::Slot vtkDspaceHubWindow::GetSlot() const {
  return {this->RenderFramebuffer, this->Renderers, this->Size[0], this->Size[1]};
}

void vtkDspaceHubWindow::Deactivate() {
  this->RenderFramebuffer = this->OwnFramebuffers[0];
  this->DisplayFramebuffer = this->OwnFramebuffers[1];
  this->ResolveFramebuffer = this->OwnFramebuffers[2];
  this->Renderers = this->OwnRenderers;
}

void vtkDspaceHubWindow::Finalize() {
  if (!this->Context) {
    return;
  }
  this->Deactivate();
  this->MakeCurrent();
  this->ReleaseGraphicsResources(this);
  this->Initialized = false;
  this->Context.reset();
}
