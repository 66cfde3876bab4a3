#include "vtkDspaceRenderContext.h"

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"

#include <dspace/Error.h>
#include <dspace/HomeProcess.h>
#include <dspace/render/CustomDrawers.h>
#include <dspace/render/EglContext.h>
#include <dspace/render/GpuStore.h>
#include <dspace/render/messages/VtkMessages.h>

vtkStandardNewMacro(vtkDspaceRenderContext);

namespace {

// OpenGL's libraries keep threads: a child that was forked from a process that draws cannot draw.
void RequireUnforked() {
  static const dspace::HomeProcess first;
  if (!first.IsHere()) {
    throw dspace::Error(dspace::Error::Kind::Unsupported, "render context",
                        "this process was forked from one that draws, so that it cannot draw; "
                        "accepted: a process that is started anew (in Python "
                        "multiprocessing.get_context('spawn'))");
  }
}

} // namespace

struct vtkDspaceRenderContext::Internals {
  dspace::HomeProcess home;
  vtkNew<vtkDspaceHubWindow> hub;
  dspace::RenderStatistics statistics;
  dspace::GpuStore store{statistics};
  dspace::CustomDrawers drawers;
  dspace::VtkMessages messages;
};

vtkDspaceRenderContext::vtkDspaceRenderContext() : Impl(std::make_unique<Internals>()) {}

vtkDspaceRenderContext::~vtkDspaceRenderContext() {
  if (!this->Impl->home.IsHere()) {
    (void)this->Impl.release(); // HomeProcess.h
    return;
  }
  if (this->Impl->hub->GetContext()) {
    this->Impl->hub->MakeCurrent();
    this->Impl->store.Release();
  }
}

void vtkDspaceRenderContext::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MeshBytes: " << this->Impl->statistics.meshBytes << "\n";
  os << indent << "FramesDrawn: " << this->Impl->statistics.framesDrawn << "\n";
}

void vtkDspaceRenderContext::Initialize(std::unique_ptr<dspace::GraphicsContext> context) {
  RequireUnforked();
  if (!this->Impl->hub->GetContext()) {
    this->Impl->hub->SetContext(context ? std::move(context) : dspace::MakeEglContext());
  }
}

void vtkDspaceRenderContext::Release() {
  if (this->Impl->hub->GetContext()) {
    this->Impl->hub->GetContext()->Release();
  }
}

// These two are wrapped for Python, which no C++ exception may reach.
std::string vtkDspaceRenderContext::GetRendererName() {
  return this->AskOpenGL(GL_RENDERER);
}

std::string vtkDspaceRenderContext::GetVersion() {
  return this->AskOpenGL(GL_VERSION);
}

std::string vtkDspaceRenderContext::AskOpenGL(unsigned int what) {
  try {
    this->Initialize();
    this->Impl->hub->MakeCurrent();
    const std::string text = reinterpret_cast<const char*>(glGetString(what));
    this->Release();
    return text;
  } catch (const std::exception& error) {
    vtkErrorMacro(<< error.what());
    return {};
  }
}

vtkRenderWindow* vtkDspaceRenderContext::GetRenderWindow() {
  return this->Impl->hub;
}

const dspace::RenderStatistics& vtkDspaceRenderContext::GetStatistics() const {
  return this->Impl->statistics;
}

dspace::RenderStatistics& vtkDspaceRenderContext::CountStatistics() {
  return this->Impl->statistics;
}

vtkDspaceHubWindow* vtkDspaceRenderContext::GetHub() {
  return this->Impl->hub;
}

dspace::GpuStore& vtkDspaceRenderContext::GetStore() {
  return this->Impl->store;
}

dspace::CustomDrawers& vtkDspaceRenderContext::GetDrawers() {
  return this->Impl->drawers;
}

dspace::VtkMessages& vtkDspaceRenderContext::GetMessages() {
  return this->Impl->messages;
}
