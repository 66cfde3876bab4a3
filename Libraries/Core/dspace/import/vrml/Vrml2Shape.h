// VRML 2.0 Shape nodes to meshes and materials. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML2_SHAPE_H
#define DSPACE_IMPORT_VRML2_SHAPE_H

#include <Inventor/fields/SoSFNode.h>
#include <Inventor/nodes/SoNode.h>

#include <dspace/import/vrml/VrmlBuilder.h>

class SoVRMLShape;

namespace dspace {

// The node itself, or what a PROTO's instance stands for; null for null.
SoNode* ResolveProto(SoNode* node);

// The node in a field, or what it stands for, when it is of that type; else null.
template<typename Node> Node* NodeIn(const SoSFNode& field) {
  SoNode* node = ResolveProto(field.getValue());
  return node && node->isOfType(Node::getClassTypeId()) ? static_cast<Node*>(node) : nullptr;
}

// Hangs the shape's mesh on a node of the model, making it and its material on first use.
void AddVrml2Shape(VrmlBuilder& builder, const VrmlFile& file, SoVRMLShape* shape, int node);

} // namespace dspace

#endif
