// What a report of a fault needs: versions, and what draws.
#ifndef DSPACE_WIDGETS_ABOUT_TEXT_H
#define DSPACE_WIDGETS_ABOUT_TEXT_H

#include <QString>

class vtkDspaceRenderContext;

namespace dspace::widgets {

// Plain text in lines "name: value": Dspace, Qt, VTK, OpenGL's vendor, renderer and
// version, the screen, the system. `version`: of the application.
QString AboutText(vtkDspaceRenderContext* context, const QString& version);

} // namespace dspace::widgets

#endif
