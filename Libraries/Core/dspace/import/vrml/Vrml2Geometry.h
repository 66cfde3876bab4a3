// VRML 2.0 geometry nodes to meshes. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML2_GEOMETRY_H
#define DSPACE_IMPORT_VRML2_GEOMETRY_H

#include <dspace/import/vrml/VrmlFaces.h>

class SoNode;

namespace dspace {

struct Vrml2Geometry {
  Mesh mesh; // without a material; empty where there is nothing to draw
  bool solid = true;
  VrmlComplaints complaints;
};

// `textured`: texture coordinates are made where the file has none.
Vrml2Geometry MakeVrml2Geometry(SoNode* node, bool textured);

} // namespace dspace

#endif
