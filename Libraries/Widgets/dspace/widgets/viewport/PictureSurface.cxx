#include <dspace/widgets/viewport/PictureSurface.h>

#include <exception>

#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>

#include "vtkDspaceViewport.h"

namespace dspace::widgets {

bool PictureSurface::Shares(vtkDspaceViewport& viewport) {
  QOpenGLContext* shared = QOpenGLContext::globalShareContext();
  if (!shared) {
    return false;
  }
  if (QOpenGLContext* before = QOpenGLContext::currentContext()) {
    before->doneCurrent(); // a context of EGL is not Qt's
  }
  viewport.MakeContextCurrent();
  QOpenGLContext* current = QOpenGLContext::currentContext();
  return current && QOpenGLContext::areSharing(current, shared);
}

bool PictureSurface::IsSoftware(vtkDspaceViewport& viewport) {
  viewport.MakeContextCurrent();
  QOpenGLContext* current = QOpenGLContext::currentContext();
  const GLubyte* name = current ? current->functions()->glGetString(GL_RENDERER) : nullptr;
  const QByteArray renderer(reinterpret_cast<const char*>(name));
  return renderer.contains("llvmpipe") || renderer.contains("softpipe") || renderer.contains("SWR");
}

PictureSurface::PictureSurface(vtkDspaceViewport* viewport, QWidget* parent)
    : QOpenGLWidget(parent), Viewport_(viewport) {
  this->setAttribute(Qt::WA_TransparentForMouseEvents);
  this->setFocusPolicy(Qt::NoFocus);
}

PictureSurface::~PictureSurface() {
  this->Forget();
}

void PictureSurface::SetViewport(vtkDspaceViewport* viewport) {
  this->Viewport_ = viewport;
}

void PictureSurface::Forget() {
  if (this->Framebuffer_ && this->context()) {
    this->makeCurrent();
    this->context()->functions()->glDeleteFramebuffers(1, &this->Framebuffer_);
    this->doneCurrent();
  }
  this->Framebuffer_ = 0;
}

void PictureSurface::paintGL() {
  GLsync done = nullptr;
  bool anew = false;
  QString failure;
  try {
    anew = this->Viewport_->Render();
    if (anew) {
      this->Viewport_->MakeContextCurrent();
      QOpenGLExtraFunctions* gl = QOpenGLContext::currentContext()->extraFunctions();
      done = gl->glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
      gl->glFlush();
    }
  } catch (const std::exception& error) {
    failure = QString::fromUtf8(error.what());
  }
  this->makeCurrent();
  QOpenGLExtraFunctions* gl = this->context()->extraFunctions();
  const unsigned int texture = this->Viewport_->GetTexture();
  const GLuint target = this->defaultFramebufferObject();
  gl->glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
  gl->glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
  gl->glClear(GL_COLOR_BUFFER_BIT);
  if (done) {
    gl->glWaitSync(done, 0, GL_TIMEOUT_IGNORED);
    gl->glDeleteSync(done);
  }
  if (texture && failure.isEmpty()) {
    if (!this->Framebuffer_) {
      gl->glGenFramebuffers(1, &this->Framebuffer_);
    }
    gl->glBindFramebuffer(GL_READ_FRAMEBUFFER, this->Framebuffer_);
    gl->glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture,
                               0);
    const int width = this->Viewport_->GetWidth();
    const int height = this->Viewport_->GetHeight();
    gl->glDisable(GL_FRAMEBUFFER_SRGB); // the bytes as they are
    gl->glDisable(GL_SCISSOR_TEST);
    gl->glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                          GL_NEAREST);
    // The texture may go before the framebuffer is used again.
    gl->glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 0, 0);
    gl->glBindFramebuffer(GL_FRAMEBUFFER, target);
    gl->glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
    gl->glClear(GL_COLOR_BUFFER_BIT);
    gl->glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }
  if (failure.isEmpty()) {
    emit this->drawn(anew);
  } else {
    emit this->failed(failure);
  }
}

} // namespace dspace::widgets
