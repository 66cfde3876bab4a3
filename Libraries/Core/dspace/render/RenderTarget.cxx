#include <dspace/render/RenderTarget.h>

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLState.h"
#include "vtkTextureObject.h"

#include <dspace/Error.h>

namespace dspace {

RenderTarget::RenderTarget(vtkDspaceHubWindow* window, Format format, DepthFormat depth)
    : Window_(window), Format_(format), DepthFormat_(depth) {}

RenderTarget::~RenderTarget() {
  this->Release();
}

vtkOpenGLFramebufferObject* RenderTarget::Framebuffer() const {
  return this->Framebuffer_;
}

unsigned int RenderTarget::Color() const {
  return this->Color_->GetHandle();
}

unsigned int RenderTarget::Depth() const {
  return this->Depth_->GetHandle();
}

void RenderTarget::Release() {
  if (this->Width_ > 0 && this->Window_->GetContext()) {
    this->Window_->MakeCurrent();
    this->Framebuffer_->ReleaseGraphicsResources(this->Window_);
    this->Color_->ReleaseGraphicsResources(this->Window_);
    this->Depth_->ReleaseGraphicsResources(this->Window_);
  }
  this->Width_ = this->Height_ = 0;
}

void RenderTarget::Resize(int width, int height) {
  if (width == this->Width_ && height == this->Height_) {
    return;
  }
  this->Window_->MakeCurrent();
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  const std::string object =
      "picture of " + std::to_string(width) + " x " + std::to_string(height) + " samples";
  if (width > limit || height > limit) {
    throw Error(Error::Kind::Resource, object,
                "this OpenGL draws at most " + std::to_string(limit) + " samples a side");
  }
  this->Release();
  while (glGetError() != GL_NO_ERROR) {
  }
  vtkOpenGLState* state = this->Window_->GetState();
  state->PushFramebufferBindings();
  this->Framebuffer_->SetContext(this->Window_);
  this->Framebuffer_->Bind();
  this->Width_ = width;
  this->Height_ = height;

  this->Color_->SetContext(this->Window_);
  this->Color_->SetMinificationFilter(vtkTextureObject::Nearest);
  this->Color_->SetMagnificationFilter(vtkTextureObject::Nearest);
  this->Color_->SetWrapS(vtkTextureObject::ClampToEdge);
  this->Color_->SetWrapT(vtkTextureObject::ClampToEdge);
  switch (this->Format_) {
  case Format::Display:
    this->Color_->SetInternalFormat(GL_SRGB8_ALPHA8);
    this->Color_->Allocate2D(width, height, 4, VTK_UNSIGNED_CHAR);
    break;
  case Format::Linear:
    this->Color_->SetInternalFormat(GL_RGBA16F);
    this->Color_->Allocate2D(width, height, 4, VTK_FLOAT);
    break;
  case Format::Light:
    this->Color_->SetInternalFormat(GL_RGBA32F);
    this->Color_->Allocate2D(width, height, 4, VTK_FLOAT);
    break;
  case Format::Number:
    this->Color_->SetInternalFormat(GL_R32F);
    this->Color_->Allocate2D(width, height, 1, VTK_FLOAT);
    break;
  case Format::Label:
    this->Color_->SetInternalFormat(GL_R32UI);
    this->Color_->SetFormat(GL_RED_INTEGER);
    this->Color_->SetDataType(GL_UNSIGNED_INT);
    this->Color_->Allocate2D(width, height, 1, VTK_UNSIGNED_INT);
    break;
  }
  this->Framebuffer_->AddColorAttachment(0, this->Color_);
  if (this->DepthFormat_ != DepthFormat::None) {
    this->Depth_->SetContext(this->Window_);
    this->Depth_->SetMinificationFilter(vtkTextureObject::Nearest);
    this->Depth_->SetMagnificationFilter(vtkTextureObject::Nearest);
    if (this->DepthFormat_ == DepthFormat::Float) {
      this->Depth_->AllocateDepth(width, height, vtkTextureObject::Float32);
    } else if (this->Window_->GetStencilCapable()) {
      this->Depth_->AllocateDepthStencil(width, height);
    } else {
      this->Depth_->AllocateDepth(width, height, vtkTextureObject::Fixed32);
    }
    this->Framebuffer_->AddDepthAttachment(this->Depth_);
  }
  this->Framebuffer_->Resize(width, height); // tells VTK's object its size
  this->Framebuffer_->ActivateDrawBuffer(0);
  const bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE &&
                        glGetError() == GL_NO_ERROR;
  state->PopFramebufferBindings();
  if (!complete) {
    this->Release();
    throw Error(Error::Kind::Resource, object,
                "OpenGL has no memory for it; ask for a smaller one");
  }
}

void RenderTarget::Bind() {
  this->Framebuffer_->Bind();
  this->Framebuffer_->ActivateDrawBuffer(0);
  vtkOpenGLState* state = this->Window_->GetState();
  state->vtkglViewport(0, 0, this->Width_, this->Height_);
  state->vtkglScissor(0, 0, this->Width_, this->Height_);
}

template<class T>
std::vector<T> RenderTarget::Read(int x, int y, int w, int h, unsigned int format,
                                  unsigned int type, int channels) const {
  vtkOpenGLState* state = this->Window_->GetState();
  state->PushFramebufferBindings();
  this->Framebuffer_->Bind(GL_READ_FRAMEBUFFER);
  this->Framebuffer_->ActivateReadBuffer(0);
  const std::size_t rowSize = static_cast<std::size_t>(w) * channels;
  std::vector<T> upsideDown(rowSize * h);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(x, this->Height_ - y - h, w, h, format, type, upsideDown.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  state->PopFramebufferBindings();
  std::vector<T> rows(upsideDown.size());
  for (int row = 0; row < h; ++row) {
    std::copy_n(upsideDown.data() + (h - 1 - row) * rowSize, rowSize, rows.data() + row * rowSize);
  }
  return rows;
}

std::vector<std::uint8_t> RenderTarget::ReadColor() const {
  return this->Read<std::uint8_t>(0, 0, this->Width_, this->Height_, GL_RGBA, GL_UNSIGNED_BYTE, 4);
}

std::vector<float> RenderTarget::ReadLight() const {
  return this->Read<float>(0, 0, this->Width_, this->Height_, GL_RGBA, GL_FLOAT, 4);
}

std::vector<std::uint32_t> RenderTarget::ReadLabel(int x, int y, int w, int h) const {
  return this->Read<std::uint32_t>(x, y, w, h, GL_RED_INTEGER, GL_UNSIGNED_INT, 1);
}

std::vector<float> RenderTarget::ReadDepth(int x, int y, int w, int h) const {
  return this->Read<float>(x, y, w, h, GL_DEPTH_COMPONENT, GL_FLOAT, 1);
}

} // namespace dspace
