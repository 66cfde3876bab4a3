// Loading real models against the kept library's own loading of the same file.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <dspace/import/files/ModelReader.h>
#include <dspace/import/model/Model.h>

#include "Alternate.h"

int main() {
  const char* data = std::getenv("DSPACE_DATA");
  for (const char* name : {"iss.glb", "tdrs_b.glb", "parker.glb"}) {
    const std::string path = std::string(data ? data : "") + "/models/spacecraft_glb/" + name;
    if (!std::filesystem::exists(path)) {
      std::printf("load %s: skipped, real data absent (DSPACE_DATA)\n", name);
      continue;
    }
    std::size_t triangles = 0;
    const auto turns = dspace::bench::Alternate(
        7, [&] { triangles = dspace::ReadModel(path).TriangleCount(); },
        [&] {
          Assimp::Importer importer;
          if (!importer.ReadFile(path, aiProcess_Triangulate)) {
            std::abort();
          }
        });
    const std::string behind =
        std::to_string(triangles) +
        " triangles; ours also checks every index, makes normals and decodes "
        "the textures, Assimp's leaves them packed";
    dspace::bench::Print((std::string("load ") + name).c_str(), turns, 1, behind.c_str());
  }
  return 0;
}
