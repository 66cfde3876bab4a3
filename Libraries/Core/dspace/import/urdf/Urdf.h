// Robots described in URDF: links, joints and visuals, without loading their geometry.
#ifndef DSPACE_IMPORT_URDF_H
#define DSPACE_IMPORT_URDF_H

#include <string>
#include <vector>

#include <dspace/Pose.h>
#include <dspace/import/files/ModelReader.h>
#include <dspace/import/model/Model.h>

namespace dspace {

struct UrdfVisual {
  enum class Shape { Mesh, Box, Cylinder, Sphere };
  std::string name;
  Pose X_LV; // pose of the visual in its link's frame
  Shape shape = Shape::Mesh;
  std::string meshPath;                           // absolute path; Mesh only
  bool missing = false;                           // the mesh file does not exist
  std::size_t warning = 0;                        // when missing: its index in Urdf::warnings
  Eigen::Vector3d size = Eigen::Vector3d::Ones(); // Mesh: scale an axis. Box: edges [m].
                                                  // Cylinder: radius, radius, length along Z.
                                                  // Sphere: radius three times.
  bool hasMaterial = false;
  Material material; // when hasMaterial
};

struct UrdfLink {
  std::string name;         // unique; a valid name of a frame
  std::string originalName; // in the file
  int parentJoint = -1;     // index into joints, or -1 for the root link
  std::vector<UrdfVisual> visuals;
};

struct UrdfJoint {
  enum class Type { Fixed, Revolute, Continuous, Prismatic, Floating, Planar };
  std::string name;
  Type type = Type::Fixed;
  int parentLink = -1;
  int childLink = -1;
  Pose X_PJ; // pose of the joint's (and child link's) frame in the parent link's at position zero
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX(); // unit, in the joint's frame
  bool hasLimits = false;
  double lower = 0.0; // degrees (revolute) or metres (prismatic)
  double upper = 0.0;
  int mimic = -1; // index of the joint it follows, or -1: position = multiplier * other + offset
  double mimicMultiplier = 1.0;
  double mimicOffset = 0.0; // degrees or metres

  // Pose of the child link in the parent link at `position` (degrees for revolute and continuous,
  // metres for prismatic; ignored for fixed; floating and planar joints are moved as frames).
  Pose ChildInParent(double position) const;
};

struct Urdf {
  std::string path;
  std::string name;
  std::vector<UrdfLink> links; // parents before children; links[0] is the root
  std::vector<UrdfJoint> joints;
  std::vector<std::string> warnings;
};

// Reads and checks a URDF. Mesh file names are resolved relative to the URDF's folder; `package://`
// names are looked for from the folders above it. A missing mesh is a warning and
// `visual.missing`. What does not concern the tree of links is repaired with a warning: names that
// frames cannot have, undefined materials, shapes without a size (left out), limits that are
// missing or the wrong way round, axes without a direction (the joint becomes fixed), mimics of
// unknown joints. With options.strict each of these is an Error.
// Throws Error: NotFound, Io, Corrupt (XML, no link, two parents, a loop, several roots, nesting
// deeper than 1000).
Urdf ReadUrdf(const std::string& path, const ImportOptions& options = {});

} // namespace dspace

#endif
