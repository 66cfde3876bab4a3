// The render context's OpenGL context, by Qt.
#ifndef DSPACE_WIDGETS_QT_CONTEXT_H
#define DSPACE_WIDGETS_QT_CONTEXT_H

#include <memory>

#include <dspace/render/GraphicsContext.h>

namespace dspace::widgets {

// Before the application object is created: its contexts share textures, and OpenGL is 4.5 core.
void PrepareApplication();

// Takes a context that is not of MakeQtContext() off this thread, so that Qt's can draw: after code
// that may have drawn with a render context of its own.
void ReleaseOtherContexts();

// A context that shares its textures with those of all widgets, for
// vtkDspaceRenderContext::Initialize(). Needs an application that PrepareApplication() preceded.
// Throws Error(Resource) with the version that OpenGL has here.
std::unique_ptr<GraphicsContext> MakeQtContext();

} // namespace dspace::widgets

#endif
