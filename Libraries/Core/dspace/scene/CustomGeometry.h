// Geometry that is not made of meshes: terrain whose triangles follow the camera.
#ifndef DSPACE_SCENE_CUSTOM_GEOMETRY_H
#define DSPACE_SCENE_CUSTOM_GEOMETRY_H

#include <cstdint>

#include <Eigen/Core>

namespace dspace {

struct BoundingSphere;

// What a scene knows of it. The render context knows a drawer for each class
// (render/CustomDrawers.h): the scene stays free of OpenGL.
class CustomGeometry {
public:
  virtual ~CustomGeometry() = default;
  // In the object's frame O: nothing of it is ever drawn outside.
  virtual BoundingSphere Bounds() const = 0;
  // Raised by every change of what would be drawn, data that arrive included.
  virtual std::uint64_t Revision() const = 0;
};

} // namespace dspace

#endif
