// Indexed polygons, lines and points with VRML's bindings, to a Mesh. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML_FACES_H
#define DSPACE_IMPORT_VRML_FACES_H

#include <dspace/import/model/Model.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace dspace {

// Selects the value of an attribute for a corner.
enum class VrmlBinding {
  None,
  Overall,          // the first
  PerFace,          // one a face (or polyline) in turn
  PerFaceIndexed,   // indices[face]
  PerCorner,        // one a corner in turn (VRML 1.0 PER_VERTEX)
  PerCornerIndexed, // indices[position in coordIndex]; coordIndex itself where indices are empty
};

template<typename Value> struct VrmlAttribute {
  VrmlBinding binding = VrmlBinding::None;
  std::vector<Value> values;
  std::vector<int> indices;
};

struct VrmlFaces {
  std::vector<Eigen::Vector3f> points;
  std::vector<int> coordIndex; // faces or polylines, each ended by -1
  VrmlAttribute<std::array<std::uint8_t, 4>> colors;
  VrmlAttribute<Eigen::Vector3f> normals; // None: made from the faces and creaseAngle
  VrmlAttribute<Eigen::Vector2f> tcoords;
  bool ccw = true;
  bool convex = true;
  bool defaultTcoords = false; // where there are none: from the bounds, as VRML97 6.23 has it
  double creaseAngle = 0.0;    // radians
};

// Descriptions of a shape's flaws: "3 faces with an index out of range are left out".
using VrmlComplaints = std::vector<std::string>;

// Triangles. A face with an index out of range, a point not finite, or fewer than three corners is
// left out; where colours are too few the last one is taken; where normals are too few or null they
// are made from the faces. Each such repair is added to `complaints`, once.
Mesh MakeVrmlFaces(const VrmlFaces& faces, VrmlComplaints& complaints);

// Polylines as pairs; of the attributes only colours are read.
Mesh MakeVrmlLines(const VrmlFaces& lines, VrmlComplaints& complaints);

// One point primitive each of `points`, whose coordIndex is not read.
Mesh MakeVrmlPoints(const VrmlFaces& points, VrmlComplaints& complaints);

} // namespace dspace

#endif
