#include <dspace/render/EglContext.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <dspace/Error.h>
#include <dspace/render/DebugOutput.h>
#include <dspace/render/GlxThread.h>

namespace dspace {
namespace {

std::string EglErrorText() {
  char text[32];
  std::snprintf(text, sizeof text, "EGL error 0x%04x", eglGetError());
  return text;
}

// Also where a window of GLX was drawn in this thread before.
bool Make(EGLDisplay display, EGLSurface surface, EGLContext context) {
  if (eglMakeCurrent(display, surface, surface, context)) {
    return true;
  }
  ReleaseGlx();
  return eglMakeCurrent(display, surface, surface, context);
}

class EglContext : public GraphicsContext {
public:
  EglContext(EGLDisplay display, EGLContext context, EGLSurface surface, std::string description)
      : Display_(display), Context_(context), Surface_(surface),
        Description_(std::move(description)) {
    this->Made(); // current since TryDisplay()
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;
  ~EglContext() override {
    if (this->IsCurrent()) {
      eglMakeCurrent(this->Display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    if (this->Surface_ != EGL_NO_SURFACE) {
      eglDestroySurface(this->Display_, this->Surface_);
    }
    eglDestroyContext(this->Display_, this->Context_);
    // The display is left initialised: EGL returns the same one to all code of the process.
  }
  void MakeCurrent() override {
    if (!Make(this->Display_, this->Surface_, this->Context_)) {
      throw Error(Error::Kind::Resource, "EGL context",
                  "could not be made current (" + EglErrorText() +
                      "); a context serves one thread at a time");
    }
    this->Made();
  }
  bool IsCurrent() const override { return eglGetCurrentContext() == this->Context_; }
  void Release() override {
    if (this->IsCurrent() && MayUseGlx()) {
      eglMakeCurrent(this->Display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
  }
  std::string Description() const override { return this->Description_; }

private:
  EGLDisplay Display_;
  EGLContext Context_;
  EGLSurface Surface_;
  std::string Description_;
};

std::unique_ptr<GraphicsContext> TryDisplay(EGLDisplay display, const std::string& name,
                                            std::string& tried) {
  EGLint major = 0;
  EGLint minor = 0;
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor)) {
    tried += "\n  " + name + ": no display (" + EglErrorText() + ")";
    return nullptr;
  }
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  const bool surfaceless = extensions && std::strstr(extensions, "EGL_KHR_surfaceless_context");
  const EGLint configAttributes[] = {EGL_SURFACE_TYPE, surfaceless ? 0 : EGL_PBUFFER_BIT,
                                     EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglBindAPI(EGL_OPENGL_API) ||
      !eglChooseConfig(display, configAttributes, &config, 1, &count) || count < 1) {
    tried += "\n  " + name + ": no OpenGL configuration (" + EglErrorText() + ")";
    return nullptr;
  }
  const bool debug = WantsDebugOutput();
  std::vector<EGLint> contextAttributes = {
      EGL_CONTEXT_MAJOR_VERSION,       4,
      EGL_CONTEXT_MINOR_VERSION,       5,
      EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
  if (debug && (major > 1 || minor >= 5)) {
    contextAttributes.insert(contextAttributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
  } else if (debug) {
    contextAttributes.insert(contextAttributes.end(),
                             {EGL_CONTEXT_FLAGS_KHR, EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR});
  }
  contextAttributes.push_back(EGL_NONE);
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, contextAttributes.data());
  if (context == EGL_NO_CONTEXT) {
    tried += "\n  " + name + ": no OpenGL 4.5 core context (" + EglErrorText() + ")";
    return nullptr;
  }
  EGLSurface surface = EGL_NO_SURFACE;
  if (!surfaceless) {
    const EGLint surfaceAttributes[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    surface = eglCreatePbufferSurface(display, config, surfaceAttributes);
  }
  if (!Make(display, surface, context)) {
    tried += "\n  " + name + ": context cannot be made current (" + EglErrorText() + ")";
    eglDestroyContext(display, context);
    return nullptr;
  }
  auto made = std::make_unique<EglContext>(display, context, surface,
                                           "EGL " + std::to_string(major) + "." +
                                               std::to_string(minor) + ", " + name);
  if (debug) {
    InstallDebugOutput();
  }
  return made;
}

} // namespace

std::unique_ptr<GraphicsContext> MakeEglContext() {
  const char* choice = std::getenv("DSPACE_EGL");
  const std::string wanted = choice ? choice : "";
  if (!wanted.empty() && wanted != "device" && wanted != "surfaceless") {
    throw Error(Error::Kind::InvalidArgument, "environment variable DSPACE_EGL",
                "is '" + wanted + "'; accepted are 'device' and 'surfaceless'");
  }
  const auto getPlatformDisplay = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  const auto queryDevices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  const auto queryDeviceString = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
      eglGetProcAddress("eglQueryDeviceStringEXT"));
  if (!getPlatformDisplay) {
    throw Error(Error::Kind::Resource, "EGL",
                "EGL_EXT_platform_base is missing; install Mesa's "
                "or the GPU vendor's EGL library");
  }
  std::string tried;
  if (wanted != "surfaceless" && queryDevices) {
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (queryDevices(16, devices, &count)) {
      for (EGLint i = 0; i < count; ++i) {
        const char* extensions =
            queryDeviceString ? queryDeviceString(devices[i], EGL_EXTENSIONS) : nullptr;
        // Mesa's software device is best reached through the surfaceless platform below.
        if (extensions && std::strstr(extensions, "EGL_MESA_device_software")) {
          continue;
        }
        if (auto context =
                TryDisplay(getPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr),
                           "device " + std::to_string(i), tried)) {
          return context;
        }
      }
    }
  }
  if (wanted != "device") {
    if (auto context = TryDisplay(
            getPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
            "surfaceless Mesa", tried)) {
      return context;
    }
  }
  throw Error(Error::Kind::Resource, "EGL",
              "no OpenGL 4.5 context can be had; tried:" +
                  (tried.empty() ? std::string(" no device found") : tried));
}

} // namespace dspace
