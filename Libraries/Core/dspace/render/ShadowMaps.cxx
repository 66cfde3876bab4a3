#include <dspace/render/ShadowMaps.h>

#include <algorithm>

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLState.h"

#include <dspace/Error.h>
#include <dspace/render/SurfaceShaders.h>

namespace dspace {

void ShadowMaps::Release() {
  if (this->Texture_ && this->Window_->GetContext()) {
    this->Window_->MakeCurrent();
    glDeleteTextures(1, &this->Texture_);
    glDeleteFramebuffers(GLsizei(this->Framebuffers_.size()), this->Framebuffers_.data());
  }
  this->Texture_ = 0;
  this->Framebuffers_.clear();
  this->Size_ = 0;
}

void ShadowMaps::Resize(const std::string& viewport, int size, int count) {
  if (size == this->Size_ && count == int(this->Framebuffers_.size())) {
    return;
  }
  this->Release();
  while (glGetError() != GL_NO_ERROR) {
  }
  glGenTextures(1, &this->Texture_);
  BindTextureUnit(this->Window_, ShadowUnit, GL_TEXTURE_2D_ARRAY, this->Texture_);
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT32F, size, size, count, 0,
               GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    glTexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_NEAREST);
  }
  this->Framebuffers_.assign(std::size_t(count), 0);
  glGenFramebuffers(count, this->Framebuffers_.data());
  bool complete = glGetError() == GL_NO_ERROR;
  for (int k = 0; k < count && complete; ++k) {
    glBindFramebuffer(GL_FRAMEBUFFER, this->Framebuffers_[std::size_t(k)]);
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, this->Texture_, 0, k);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  }
  this->Size_ = size;
  if (!complete) {
    this->Release();
    throw Error(Error::Kind::Resource, "viewport '" + viewport + "'",
                "OpenGL has no memory for " + std::to_string(count) + " shadow maps of " +
                    std::to_string(size) + " texels a side; accepted: smaller or fewer ones");
  }
}

void ShadowMaps::Update(const Scene& scene, const DrawView& view, const DrawFilter& filter,
                        CascadeFit& fit, const Draw& draw) {
  vtkOpenGLState* state = this->Window_->GetState();
  DrawFilter casters = filter;
  casters.physicalOnly = true; // ornaments throw no shadow
  casters.castersOnly = true;
  const int count = int(fit.cascades.size());
  state->PushFramebufferBindings();
  try {
    this->Resize(view.viewport, fit.size, fit.ground ? 2 * count : count);
    this->Casters_.resize(std::size_t(count));
    for (int k = 0; k < count; ++k) {
      CascadeFit::Cascade& cascade = fit.cascades[std::size_t(k)];
      DrawList& list = this->Casters_[std::size_t(k)];
      DrawView seen = view;
      seen.shadows.reset();
      seen.clip = fit.ClipFromView(cascade);
      list.Build(scene, seen, casters);
      cascade.high = std::max(cascade.high, list.HighestToSun());
      seen.clip = fit.ClipFromView(cascade);
      for (const bool ground : {false, true}) {
        if (ground && !fit.ground) {
          continue;
        }
        glBindFramebuffer(GL_FRAMEBUFFER, this->Framebuffers_[std::size_t(ground ? count + k : k)]);
        state->vtkglViewport(0, 0, fit.size, fit.size);
        state->vtkglScissor(0, 0, fit.size, fit.size);
        state->vtkglDepthMask(GL_TRUE);
        state->vtkglClearDepth(0.0);
        state->vtkglClear(GL_DEPTH_BUFFER_BIT);
        state->vtkglClearDepth(1.0);
        glEnable(GL_DEPTH_CLAMP);
        draw(list, seen, ground);
        glDisable(GL_DEPTH_CLAMP);
      }
    }
  } catch (...) {
    glDisable(GL_DEPTH_CLAMP);
    state->PopFramebufferBindings();
    throw;
  }
  state->PopFramebufferBindings();
}

} // namespace dspace
