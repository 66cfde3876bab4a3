// Reading a model in a process of its own against reading it here: the difference is what isolation
// costs.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <dspace/import/files/ModelReader.h>
#include <dspace/import/worker/ImportWorker.h>

#include "Alternate.h"

namespace {

// A VRML grid of heights, of 2 (side - 1)^2 triangles.
std::string Grid(int side) {
  std::string text = "#VRML V2.0 utf8\nShape { geometry ElevationGrid { xDimension " +
                     std::to_string(side) + " zDimension " + std::to_string(side) + " height [";
  for (int i = 0; i < side * side; ++i) {
    text += " " + std::to_string(i % 17 * 0.01);
  }
  return text + " ] } }\n";
}

void Measure(const std::string& name, const std::string& path) {
  dspace::ImportWorker& worker = dspace::ImportWorker::OfProcess();
  std::size_t triangles = worker.ReadModel(path).TriangleCount(); // starts it
  const auto turns = dspace::bench::Alternate(
      15, [&] { triangles = worker.ReadModel(path).TriangleCount(); },
      [&] { triangles = dspace::ReadModel(path).TriangleCount(); });
  std::vector<double> more_s;
  for (std::size_t i = 0; i < turns.subject.size(); ++i) {
    more_s.push_back(turns.subject[i] - turns.reference[i]);
  }
  char behind[100];
  std::snprintf(behind, sizeof behind, "%zu triangles; %.2f ms more", triangles,
                1e3 * dspace::bench::Median(more_s));
  dspace::bench::Print(("load apart: " + name).c_str(), turns, 1, behind);
}

} // namespace

int main() {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("dspace-bench-" + std::to_string(std::rand()));
  std::filesystem::create_directories(folder);
  for (const int side : {3, 100, 500}) {
    const std::string path = (folder / "grid.wrl").string();
    std::ofstream(path) << Grid(side);
    Measure("VRML grid of " + std::to_string(side), path);
  }
  std::filesystem::remove_all(folder);
  const char* data = std::getenv("DSPACE_DATA");
  for (const char* name : {"spacecraft_glb/parker.glb", "spacecraft_glb/iss.glb"}) {
    const std::string path = std::string(data ? data : "") + "/models/" + name;
    if (std::filesystem::exists(path)) {
      Measure(name, path);
    } else {
      std::printf("load apart %s: skipped, real data absent (DSPACE_DATA)\n", name);
    }
  }
  return 0;
}
