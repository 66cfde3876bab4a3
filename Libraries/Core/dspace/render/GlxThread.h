// Windows of other code that draw by GLX: VTK's own on X11. Where GLX or EGL has a context current
// in a thread, the other cannot make one current there: EGL fails, and GLX ends the process.
#ifndef DSPACE_RENDER_GLX_THREAD_H
#define DSPACE_RENDER_GLX_THREAD_H

namespace dspace {

// Whether this process may have windows that draw by GLX: it has loaded GLX and has an X display.
bool MayUseGlx();

// Takes the GLX context of this thread, if any, off it. Its owner makes it current again before it
// draws, as VTK does.
void ReleaseGlx();

} // namespace dspace

#endif
