// What the tests of glTF share: a quad in a file of its own, to be changed line by line.
#ifndef DSPACE_CORE_TESTING_GLTF_TEST_SUPPORT_H
#define DSPACE_CORE_TESTING_GLTF_TEST_SUPPORT_H

#include <dspace/import/files/Importers.h>
#include <dspace/import/model/Model.h>

#include <cmath>

#include "ImportTestSupport.h"

namespace dspace::testing {

// Replaces every 'from' in `text`.
inline std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  for (; at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// A quad of 2 x 1 in the XY plane: positions (48 bytes), tcoords (32), indices (12 of uint16).
// tcoords have glTF's v = 0 at the top: the image's top-left is at (0, 1, 0).
inline std::string QuadBytes() {
  return Bytes<float>({0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0}) +
         Bytes<float>({0, 1, 1, 1, 1, 0, 0, 0}) + Bytes<std::uint16_t>({0, 1, 2, 0, 2, 3});
}

const char* const Quad = R"({
  "asset": {"version": "2.0"},
  "buffers": [{"uri": "quad.bin", "byteLength": 92}],
  "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 32},
                  {"buffer": 0, "byteOffset": 80, "byteLength": 12}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}],
  "materials": [{"name": "paint", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.2, 0, 0.5],
                 "metallicFactor": 0.25, "roughnessFactor": 0.75}, "emissiveFactor": [0, 0.1, 1]}],
  "meshes": [{"name": "quad", "primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1},
              "indices": 2, "material": 0}]}],
  "nodes": [{"name": "base", "translation": [10, 0, 0], "children": [1, 2]},
            {"name": "turned", "rotation": [0, 0, 0.70710678118654757, 0.70710678118654757],
             "scale": [1, 2, 3], "mesh": 0},
            {"name": "moved", "mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,7,1]}],
  "scenes": [{"nodes": [0]}], "scene": 0
})";

inline std::string WriteQuad(const TempFolder& folder, const std::string& json = Quad) {
  folder.Write("quad.bin", QuadBytes());
  return folder.Write("quad.gltf", json);
}

inline std::string Glb(const std::string& json, const std::string& bin) {
  const auto word = [](std::size_t v) {
    return Bytes<std::uint32_t>({static_cast<std::uint32_t>(v)});
  };
  std::string j = json, b = bin;
  j.resize((j.size() + 3) / 4 * 4, ' ');
  b.resize((b.size() + 3) / 4 * 4, '\0');
  const std::string chunks =
      word(j.size()) + "JSON" + j + word(b.size()) + std::string("BIN\0", 4) + b;
  return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
}

inline double SrgbOf(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

} // namespace dspace::testing

#endif
