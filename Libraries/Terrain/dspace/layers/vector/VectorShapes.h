// Shapes as a file of OGR's has them, in its own CRS. Not for public headers.
#ifndef DSPACE_LAYERS_VECTORSHAPES_H
#define DSPACE_LAYERS_VECTORSHAPES_H

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/layers/vector/VectorLayer.h>

namespace dspace {

// Colours are sRGB and opacity, 0 to 1.
struct VectorStyle {
  std::array<double, 4> line;
  std::array<double, 4> fill;
  std::array<double, 4> point;
  std::optional<double> pixels; // width of lines, where a feature has its own
};

struct VectorRing {
  std::vector<Eigen::Vector2d> places; // those of areas are closed: the last is the first
  std::size_t outline = 0;             // so many are drawn as a line; the rest closes over a pole
};

struct VectorShape {
  enum class Kind { Point, Path, Area }; // one place; one open ring; a ring and its holes
  Kind kind = Kind::Point;
  std::size_t look = 0; // index
  std::vector<VectorRing> rings;
};

// Of one layer of the file. In longitude and latitude the shorter way is taken from each vertex to
// the next, so that they may leave -180 to 180, and edges are divided until they are short.
struct VectorGroup {
  Crs crs;
  std::vector<VectorShape> shapes;
};

struct VectorFile {
  std::vector<VectorGroup> groups;
  std::vector<VectorStyle> looks;
  std::vector<std::string> warnings;
};

// Throws what OpenVectorLayer says, but for what concerns the terrain.
VectorFile ReadVectorFile(const std::string& path, const RasterPlace& terrain,
                          const VectorLayerOptions& options);

// Latitudes go up to so much of 90 degrees (on Mars 5 cm less): PROJ has a place for these in the
// plane of the other pole, far out, and areas that contain a pole have an edge there.
constexpr double NextToPole = 1.0 - 1e-8;

} // namespace dspace

#endif
