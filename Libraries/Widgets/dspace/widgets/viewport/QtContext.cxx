#include <dspace/widgets/viewport/QtContext.h>

#include <QGuiApplication>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QSurfaceFormat>

#include <dspace/Error.h>

namespace dspace::widgets {
namespace {

QSurfaceFormat Format() {
  QSurfaceFormat format;
  format.setRenderableType(QSurfaceFormat::OpenGL);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setVersion(4, 5);
  // Else Qt's context is forward-compatible, where lines of more than one pixel are errors.
  format.setOption(QSurfaceFormat::DeprecatedFunctions);
  if (qEnvironmentVariable("DSPACE_OPENGL_DEBUG") == "1") {
    format.setOption(QSurfaceFormat::DebugContext);
  }
  return format;
}

class QtContext : public GraphicsContext {
public:
  QtContext() {
    if (!qobject_cast<QGuiApplication*>(QCoreApplication::instance())) {
      throw Error(Error::Kind::Resource, "Qt", "there is no QApplication; make one first");
    }
    QOpenGLContext* shared = QOpenGLContext::globalShareContext();
    if (!shared) {
      throw Error(Error::Kind::Resource, "Qt",
                  "its OpenGL contexts do not share textures; call PrepareApplication() before the "
                  "QApplication is made");
    }
    this->Context_.setFormat(Format());
    this->Context_.setShareContext(shared);
    const bool created = this->Context_.create();
    const auto version = this->Context_.format().version();
    if (!created || version < qMakePair(4, 5)) {
      throw Error(Error::Kind::Resource, "OpenGL",
                  (created ? "has version " + std::to_string(version.first) + "." +
                                 std::to_string(version.second)
                           : std::string("gives no core context")) +
                      " on this display; accepted: 4.5 or later. Install a newer driver, or set "
                      "LIBGL_ALWAYS_SOFTWARE=1 for Mesa's software renderer");
    }
    this->Surface_.setFormat(this->Context_.format());
    this->Surface_.create();
  }
  void MakeCurrent() override {
    if (Latest() && Latest() != this) {
      Latest()->Release(); // EGL of a session that is no window's: GLX cannot draw beside it
    }
    if (!this->Context_.makeCurrent(&this->Surface_)) {
      throw Error(Error::Kind::Resource, "OpenGL", "the context of Qt cannot be made current");
    }
    this->Made();
  }
  bool IsCurrent() const override {
    return QOpenGLContext::currentContext() == &this->Context_ && Latest() == this;
  }
  void Release() override {
    if (this->IsCurrent()) {
      QOpenGLContext* context = QOpenGLContext::currentContext();
      context->doneCurrent();
    }
  }
  std::string Description() const override {
    const auto version = this->Context_.format().version();
    return "Qt, OpenGL " + std::to_string(version.first) + "." + std::to_string(version.second);
  }

private:
  QOffscreenSurface Surface_;
  QOpenGLContext Context_;
};

} // namespace

void ReleaseOtherContexts() {
  GraphicsContext* latest = GraphicsContext::Latest();
  if (latest && !dynamic_cast<QtContext*>(latest)) {
    latest->Release();
  }
}

void PrepareApplication() {
  if (QCoreApplication::instance()) {
    return; // too late: MakeQtContext() says so where it matters
  }
  QCoreApplication::setAttribute(Qt::AA_ShareOpenGLContexts);
  QSurfaceFormat::setDefaultFormat(Format());
}

std::unique_ptr<GraphicsContext> MakeQtContext() {
  return std::make_unique<QtContext>();
}

} // namespace dspace::widgets
