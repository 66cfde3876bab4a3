// Lights of a scene as glTF's KHR_lights_punctual.
#ifndef DSPACE_EXPORT_EXPORT_LIGHTS_H
#define DSPACE_EXPORT_EXPORT_LIGHTS_H

#include <string>
#include <vector>

#include <tiny_gltf.h>

#include <dspace/scene/Scene.h>

namespace dspace {

// A light of a glTF file, and the node that carries it: below the node of the light's frame.
struct ExportedLight {
  FrameId frame = RootFrame;
  tinygltf::Light light;
  tinygltf::Node node; // without the index of the light
};

// Units: light that falls straight on a white matt surface shows 1 at an intensity of 1 in Dspace,
// and E / pi at an illuminance of E lux in glTF (appendix B.3.3, Lambert). Therefore
//   directional: lux = pi intensity
//   point, spot: candela = pi intensity / c, where the attenuation is 1 / (c d^2)
// Lights of another attenuation 1 / (a + b d + c d^2) get the candela that give the same light at
// `middle`, in the root [m]: pi intensity d^2 / (a + b d + c d^2), with a warning. Colours are in
// linear light. The edge of a spot's cone is hard: its inner angle is 0.999 of the outer one.
// Lights that are off are left out; those of cameras (head) too, with a warning. Ambient light has
// no counterpart and no node: AmbientOf.
std::vector<ExportedLight> ExportLights(const Scene& scene, const Eigen::Vector3d& middle,
                                        const std::string& object,
                                        std::vector<std::string>& warnings);

// The sum of the ambient lights, in linear light; an ambient light of 1 shows a white surface as 1.
Eigen::Vector3d AmbientOf(const Scene& scene);

} // namespace dspace

#endif
