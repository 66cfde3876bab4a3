// Scenes to files that other programs open: binary glTF 2.0.
#ifndef DSPACE_EXPORT_SCENE_EXPORT_H
#define DSPACE_EXPORT_SCENE_EXPORT_H

#include <functional>
#include <set>
#include <string>
#include <vector>

#include <dspace/scene/Scene.h>

namespace dspace {

struct SceneExportOptions {
  bool ornaments = false;          // ornamental objects too
  bool lights = true;              // the lights that are on
  std::set<std::string> fragments; // only objects in these; empty: in all
  // Animation: times [s], ascending; for each time the local poses of `frames`, in their order.
  std::vector<double> times;
  std::vector<FrameId> frames;
  std::vector<Pose> poses;
  // The parts of an object that draws itself (terrain), in its axes; none: it is left out. Null:
  // all of them are left out.
  std::function<std::vector<Part>(const GraphicsObject&)> partsOf;
};

// Writes the visible objects in visible fragments, each with its finest level, and all frames.
//
// Nodes: one a frame with its local pose, below them one an object, below that one a part. The root
// node "Y up" turns the scene's Z up into glTF's Y up. Meshes and images are stored once, however
// often they are drawn. Stretched or sheared offsets that no glTF node can hold are applied to a
// copy of the vertices.
// Materials: metallic-roughness, colours in linear light; KHR_materials_unlit where lights do not
// shade (lines and points too). Line widths, point sizes, shader code and wireframes have no
// counterpart.
// Lights: KHR_lights_punctual, one node a light below its frame; pi intensity lux (directional) or
// candela (point, spot), with which a white matt surface is as bright as in the scene. A fall-off
// other than 1 / d^2 is matched at the middle of the objects, with a warning. Ambient light and
// lights at the camera have no counterpart.
// Animation: translations, rotations and scales of `frames`, linear between keys, in seconds after
// the first time, which is in the asset's extras ("start_s").
// Vertices are floats relative to their part; poses are doubles in the file, but most readers round
// them to floats.
//
// Returns warnings: what is left out, by name, and objects so far from the root that a reader with
// floats displaces them by more than a ten-millionth of the distance.
// Throws Error and leaves an earlier file as it was: InvalidArgument (a path without the extension
// .glb, animation of unequal lengths, times not ascending, bad poses), NotFound (fragment, frame),
// Resource (4 GiB or more), Io (AtomicFile.h).
std::vector<std::string> ExportScene(const Scene& scene, const std::string& path,
                                     const SceneExportOptions& options = {});

} // namespace dspace

#endif
