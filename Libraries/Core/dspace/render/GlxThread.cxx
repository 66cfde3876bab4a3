#include <dspace/render/GlxThread.h>

#include <cstdlib>

#include <dlfcn.h>

namespace dspace {
namespace {

// Of what the process has loaded: Dspace itself needs no X11. The libraries are never unloaded.
void* GlxFunction(const char* name) {
  for (const char* library : {"libGLX.so.0", "libGL.so.1"}) {
    if (void* loaded = dlopen(library, RTLD_LAZY | RTLD_NOLOAD)) {
      void* found = dlsym(loaded, name);
      dlclose(loaded);
      if (found) {
        return found;
      }
    }
  }
  return nullptr;
}

} // namespace

bool MayUseGlx() {
  const char* display = std::getenv("DISPLAY");
  return display && *display && GlxFunction("glXMakeCurrent");
}

void ReleaseGlx() {
  // Display and GLXContext are pointers, GLXDrawable is an XID.
  using GetPointer = void* (*)();
  using MakeCurrent = int (*)(void*, unsigned long, void*);
  const auto context = reinterpret_cast<GetPointer>(GlxFunction("glXGetCurrentContext"));
  const auto display = reinterpret_cast<GetPointer>(GlxFunction("glXGetCurrentDisplay"));
  const auto makeCurrent = reinterpret_cast<MakeCurrent>(GlxFunction("glXMakeCurrent"));
  if (context && display && makeCurrent && context() && display()) {
    makeCurrent(display(), 0, nullptr);
  }
}

} // namespace dspace
