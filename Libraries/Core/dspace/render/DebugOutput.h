// OpenGL's own messages about errors, for tests.
#ifndef DSPACE_RENDER_DEBUG_OUTPUT_H
#define DSPACE_RENDER_DEBUG_OUTPUT_H

namespace dspace {

// Whether the environment variable DSPACE_OPENGL_DEBUG is 1 (default: 0). Throws
// Error(InvalidArgument) when it is neither.
bool WantsDebugOutput();

// The current OpenGL context, which must be a debug context, reports errors and undefined behaviour
// (KHR_debug) from now on as errors of VTK, in the call that made them: what Dspace draws then
// throws an Error (VtkErrorTrap). A message also makes the process end with status 1, wherever it
// appeared, even if it was handled. Call it in each context. Throws Error(Resource) when the
// context has no debug output.
void InstallDebugOutput();

} // namespace dspace

#endif
