// A user-defined drawer for a session: its name, its geometry and how OpenGL draws it.
#ifndef DSPACE_SESSION_DRAWER_PLUG_IN_H
#define DSPACE_SESSION_DRAWER_PLUG_IN_H

#include <string>
#include <typeindex>

#include <dspace/render/CustomDrawers.h>
#include <dspace/state/DrawnGeometries.h>

namespace dspace::session {

// vtkDspaceSession::AddDrawer() takes it. Documentation/OwnObjects.md has an example.
struct DrawerPlugIn {
  std::string name; // that CreateDrawn.drawer gives: 1 to 256 characters without a colon
  DrawnGeometries::Maker geometry; // makes objects of the class `type`
  std::type_index type;            // typeid of that class
  CustomDrawers::Maker drawer;     // makes the drawer of such an object in one picture
};

} // namespace dspace::session

#endif
