// VRML 2.0 Shape nodes to meshes and materials. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML2_SHAPE_H
#define DSPACE_IMPORT_VRML2_SHAPE_H

#include "VrmlBuilder.h"

class SoNode;
class SoVRMLShape;

namespace dspace {

// The node itself, or what a PROTO's instance stands for; null for null.
SoNode* ResolveProto(SoNode* node);

// Hangs the shape's mesh on a node of the model, making it and its material on first use.
void AddVrml2Shape(VrmlBuilder& builder, const VrmlFile& file, SoVRMLShape* shape, int node);

} // namespace dspace

#endif
