#include <dspace/render/DebugOutput.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "vtk_glew.h"

#include <EGL/egl.h>

#include "vtkOutputWindow.h"

#include <dspace/Error.h>

namespace dspace {
namespace {

std::atomic<int> MessageCount{0};

// Of std::atexit: exit() itself must not be called again.
void FailAtEnd() {
  if (MessageCount > 0) {
    std::fflush(nullptr);
    std::fprintf(stderr, "DSPACE_OPENGL_DEBUG: %d messages of OpenGL, the process fails\n",
                 MessageCount.load());
    std::_Exit(1);
  }
}

void TakeMessage(GLenum source, GLenum type, GLuint, GLenum, GLsizei, const GLchar* text,
                 const void*) {
  // Messages of the shader compiler are in the shader's log, and the code that compiles a shader
  // checks its status. A user's shader that does not compile is the user's error.
  if (source == GL_DEBUG_SOURCE_SHADER_COMPILER ||
      (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR)) {
    return;
  }
  // VTK 9.1's own windows ask for the size of a depth attachment of a framebuffer that has none
  // (vtkOpenGLRenderWindow::GetDepthBufferSize); Dspace nowhere does.
  if (std::strstr(text, "GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE")) {
    return;
  }
  ++MessageCount;
  const std::string message =
      std::string("OpenGL reported ") +
      (type == GL_DEBUG_TYPE_ERROR ? "an error: " : "undefined behaviour: ") + text + "\n";
  vtkOutputWindow::GetInstance()->DisplayErrorText(message.c_str());
}

template<typename Function> Function FindFunction(const char* name) {
  const auto found = reinterpret_cast<Function>(eglGetProcAddress(name));
  if (!found) {
    throw Error(Error::Kind::Resource, "OpenGL debug output",
                std::string(name) + " is missing; DSPACE_OPENGL_DEBUG=1 needs OpenGL 4.3");
  }
  return found;
}

} // namespace

bool WantsDebugOutput() {
  const char* value = std::getenv("DSPACE_OPENGL_DEBUG");
  const std::string wanted = value ? value : "";
  if (!wanted.empty() && wanted != "0" && wanted != "1") {
    throw Error(Error::Kind::InvalidArgument, "environment variable DSPACE_OPENGL_DEBUG",
                "is '" + wanted + "'; accepted are '0' and '1'");
  }
  return wanted == "1";
}

void InstallDebugOutput() {
  // Not by GLEW, which is not loaded yet.
  const auto callback = FindFunction<PFNGLDEBUGMESSAGECALLBACKPROC>("glDebugMessageCallback");
  const auto enable = FindFunction<void (*)(GLenum)>("glEnable");
  const auto integer = FindFunction<void (*)(GLenum, GLint*)>("glGetIntegerv");
  GLint flags = 0;
  integer(GL_CONTEXT_FLAGS, &flags);
  if (!(flags & GL_CONTEXT_FLAG_DEBUG_BIT)) {
    throw Error(Error::Kind::Resource, "OpenGL debug output", "this is no debug context");
  }
  static const int registered = std::atexit(FailAtEnd);
  if (registered != 0) {
    throw Error(Error::Kind::Resource, "OpenGL debug output", "std::atexit failed");
  }
  enable(GL_DEBUG_OUTPUT);
  enable(GL_DEBUG_OUTPUT_SYNCHRONOUS); // in the thread and the call that made the message
  callback(TakeMessage, nullptr);
}

} // namespace dspace
