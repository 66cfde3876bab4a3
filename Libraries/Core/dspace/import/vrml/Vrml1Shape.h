// VRML 1.0 shapes and the state that draws them. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML1_SHAPE_H
#define DSPACE_IMPORT_VRML1_SHAPE_H

#include <dspace/import/vrml/VrmlBuilder.h>

class SoNode;

namespace dspace {

// State set by the nodes so far. Pointers are Coin's nodes of that kind, or null.
struct Vrml1State {
  int node = 0;       // the model's node that `local` is relative to
  int localNode = -1; // the model's node for `local`, made when a shape needs it
  Eigen::Affine3d local = Eigen::Affine3d::Identity();
  std::string transformName;

  SoNode* coordinates = nullptr;
  SoNode* normals = nullptr;
  SoNode* normalBinding = nullptr;
  SoNode* material = nullptr; // Material or BaseColor
  SoNode* materialBinding = nullptr;
  SoNode* texture = nullptr;
  SoNode* textureTransform = nullptr;
  SoNode* textureCoordinates = nullptr;
  SoNode* hints = nullptr;
  SoNode* fontStyle = nullptr;

  // Takes a property node; false when it is none.
  bool SetProperty(SoNode* candidate);
};

// Hangs the shape's mesh, as this state draws it, on a node of the model.
void AddVrml1Shape(VrmlBuilder& builder, const VrmlFile& file, SoNode* shape,
                   const Vrml1State& state, int node);

} // namespace dspace

#endif
