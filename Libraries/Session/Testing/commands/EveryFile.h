// The files that the commands of EveryCommand.h name.
#ifndef DSPACE_EVERY_FILE_H
#define DSPACE_EVERY_FILE_H

#include <filesystem>
#include <fstream>

namespace dspace::testing {

inline const char* const EveryArm = R"(<robot name="arm">
  <link name="lower"><visual><geometry><box size="0.3 0.3 1"/></geometry></visual></link>
  <link name="upper"><visual><geometry><sphere radius="0.3"/></geometry></visual></link>
  <joint name="shoulder" type="revolute"><parent link="lower"/><child link="upper"/>
    <origin xyz="0 0 1"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>)";
inline const char* const EveryGround =
    "ncols 5\nnrows 5\nxllcorner 100\nyllcorner 200\ncellsize 2\nnodata_value -9\n"
    "0 1 2 1 0\n0 1 2 1 0\n0 1 3 1 0\n0 1 2 -9 0\n0 1 2 1 0\n";
inline const char* const EveryBox =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n";

// A triangle that its animation "turn" turns a quarter about Z in a second, and a lamp.
inline const char* const EveryArray = R"({"asset": {"version": "2.0"},
  "extensions": {"KHR_lights_punctual": {"lights": [{"name": "lamp", "type": "point"}]}},
  "buffers": [{"byteLength": 76, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAADzBDU/8wQ1Pw=="}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                  {"buffer": 0, "byteOffset": 44, "byteLength": 32}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR"},
                {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC4"}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "nodes": [{"name": "bus", "children": [1, 2]},
            {"name": "wing", "translation": [1, 0, 0], "mesh": 0},
            {"name": "wing", "extensions": {"KHR_lights_punctual": {"light": 0}}}],
  "animations": [{"name": "turn", "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}],
                  "samplers": [{"input": 1, "output": 2}]}],
  "scenes": [{"nodes": [0]}]})";

// Writes them into the folder FOLDER.
inline void WriteEveryFile(const std::filesystem::path& folder) {
  std::ofstream(folder / "arm.urdf") << EveryArm;
  std::ofstream(folder / "ground.asc") << EveryGround;
  std::ofstream(folder / "box.obj") << EveryBox;
  std::ofstream(folder / "array.gltf") << EveryArray;
  std::ofstream(folder / "moon.tpc")
      << "KPL/PCK\n\\begindata\nBODY301_RADII = ( 1737 1737 1737 )\n";
}

} // namespace dspace::testing

#endif
