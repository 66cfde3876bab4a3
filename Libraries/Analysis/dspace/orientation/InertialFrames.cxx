#include <dspace/orientation/InertialFrames.h>

#include <array>

#include <dspace/orientation/AxisTurns.h>

namespace dspace {
namespace {

struct Turn {
  double arcseconds;
  int axis; // 0: none
};

// The frame's axes are those of `base` turned by [first]axis [second]axis [third]axis.
struct Definition {
  const char* name;
  int base;
  Turn turns[3];
};

constexpr Definition Definitions[InertialFrameCount] = {
    {"J2000", 1, {}},
    {"B1950", 1, {{1152.84248596724, 3}, {-1002.26108439117, 2}, {1153.04066200330, 3}}},
    {"FK4", 2, {{0.525, 3}}},
    {"DE-118", 2, {{0.53155, 3}}},
    {"DE-96", 2, {{0.4107, 3}}},
    {"DE-102", 2, {{0.1359, 3}}},
    {"DE-108", 2, {{0.4775, 3}}},
    {"DE-111", 2, {{0.5880, 3}}},
    {"DE-114", 2, {{0.5529, 3}}},
    {"DE-122", 2, {{0.5316, 3}}},
    {"DE-125", 2, {{0.5754, 3}}},
    {"DE-130", 2, {{0.5247, 3}}},
    {"GALACTIC", 3, {{1177200.0, 3}, {225360.0, 1}, {1016100.0, 3}}},
    {"DE-200", 1, {}},
    {"DE-202", 1, {}},
    {"MARSIAU", 1, {{324000.0, 3}, {133610.4, 2}, {-152348.4, 3}}},
    {"ECLIPJ2000", 1, {{84381.448, 1}}},
    {"ECLIPB1950", 2, {{84404.836, 1}}},
    {"DE-140", 1, {{1152.71013777252, 3}, {-1002.25042010533, 2}, {1153.75719544491, 3}}},
    {"DE-142", 1, {{1152.72061453864, 3}, {-1002.25052830351, 2}, {1153.74663857521, 3}}},
    {"DE-143", 1, {{1153.03919093833, 3}, {-1002.24822382286, 2}, {1153.42900222357, 3}}},
};

std::array<Eigen::Matrix3d, InertialFrameCount> Rotations() {
  std::array<Eigen::Matrix3d, InertialFrameCount> out;
  for (int i = 0; i < InertialFrameCount; ++i) {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    for (const Turn& part : Definitions[i].turns) {
      if (part.axis != 0) {
        turn = turn * AxisTurn(part.arcseconds * M_PI / 648000.0, part.axis);
      }
    }
    const int base = Definitions[i].base - 1;
    out[std::size_t(i)] = base == i ? turn : Eigen::Matrix3d(turn * out[std::size_t(base)]);
  }
  return out;
}

} // namespace

const char* InertialFrameName(int id) {
  return Definitions[id - 1].name;
}

const Eigen::Matrix3d& InertialRotation(int id) {
  static const std::array<Eigen::Matrix3d, InertialFrameCount> rotations = Rotations();
  return rotations[std::size_t(id - 1)];
}

} // namespace dspace
