// The parts of a primitive command's shape.
#ifndef DSPACE_SESSION_PRIMITIVE_PARTS_H
#define DSPACE_SESSION_PRIMITIVE_PARTS_H

#include <string>
#include <vector>

#include <dspace/proto/objects.pb.h>
#include <dspace/scene/GraphicsObject.h>

namespace dspace::session {

// Throws Error(InvalidArgument) naming the shape and the value.
std::vector<Part> PartsOfShape(const v1::CreatePrimitive& command);

// "box": the shape's name in the .proto.
std::string ShapeName(const v1::CreatePrimitive& command);

// One part of a mesh with default material.
Part PartOf(Mesh mesh);

} // namespace dspace::session

#endif
