// Geometry that is not made of meshes: terrain whose triangles follow the camera.
#ifndef DSPACE_SCENE_CUSTOM_GEOMETRY_H
#define DSPACE_SCENE_CUSTOM_GEOMETRY_H

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <dspace/scene/Membership.h>

namespace dspace {

struct BoundingSphere;

// The interface that a scene sees. The render context has a drawer for each class
// (render/CustomDrawers.h), so that the scene is free of OpenGL.
class CustomGeometry {
public:
  virtual ~CustomGeometry() = default;
  // In the object's frame O. Everything that is drawn lies inside.
  virtual BoundingSphere Bounds() const = 0;
  // Infinitely far away: drawn behind everything else, and in no fit, pick or depth. It needs no
  // bounds.
  virtual bool IsBackdrop() const { return false; }
  // Increases with every change of the drawn geometry, including newly loaded data.
  virtual std::uint64_t Revision() const = 0;

  // Something that it draws and that is shown and hidden with a fragment of its own.
  struct Member {
    std::string name; // "contours", "layer 'image'"
    Membership membership;
  };
  // All of them. Their fragments cannot be removed.
  virtual std::vector<Member> Members() const { return {}; }
};

} // namespace dspace

#endif
