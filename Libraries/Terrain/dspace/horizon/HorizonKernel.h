// The inner loops of the sweep: many posts of a row at once.
#ifndef DSPACE_TERRAIN_HORIZONKERNEL_H
#define DSPACE_TERRAIN_HORIZONKERNEL_H

#include <array>
#include <cstddef>
#include <vector>

namespace dspace {

// Posts of a row that are swept together.
inline constexpr int HorizonLanes = 64;
inline constexpr int HorizonRows = 64; // of posts, the most that share a path
// Of a row, posts that are skipped together.
inline constexpr int HorizonGroup = 16;
// Of floats: more than that of a product, a sum and a quotient.
inline constexpr float HorizonRounding = 1e-6f;

// The tangent of the elevation of ground of height h from height z (HorizonPath).
struct HorizonStep {
  float fall;
  float rise;
  float away;
  float spread;
};

// Ground on an edge between two posts: of lane i `first + i` and `second + i` of the heights.
struct EdgeStep {
  HorizonStep ground;
  std::ptrdiff_t first;
  std::ptrdiff_t second;
  float share; // of the second
};

// Ground between four posts of a level whose posts are 1 / `lane` lanes apart: of lane i, `along +
// i lane` columns from `first`, and `down` of a row below it.
struct CellStep {
  HorizonStep ground;
  std::ptrdiff_t first;
  float along; // 0 to 1
  float down;
};

// Raise `tangents` of the posts of `groups`, a bit each, of HorizonLanes of heights `z` to those of
// the steps, which are all of a plane or all of a body. NaN is no ground.
void MarchEdges(const std::vector<EdgeStep>& steps, unsigned groups, const float* heights,
                const float* z, float* tangents);
// The same, with all ground as far away as that of height `base`: the tangents err by the
// difference over the body's radius.
void MarchEdgesFast(const std::vector<EdgeStep>& steps, unsigned groups, float base,
                    const float* heights, const float* z, float* tangents);
// Raises the tangents of all HorizonLanes posts. `width`: of a row of heights.
void MarchCells(const std::vector<CellStep>& steps, const float* heights, std::ptrdiff_t width,
                float lane, const float* z, float* tangents);

// Distances [m] of 1 / over to 1 / under.
struct LaneReach {
  float over;
  float under;
};
using GroupCrests = std::array<float, HorizonLanes / HorizonGroup>; // [m]
// The groups of which a post may be raised by more than `slack`, a bit each, by ground within reach
// that is up to the group's crest high.
unsigned MayRaise(const GroupCrests& crests, const LaneReach& reach, float slack, const float* z,
                  const float* tangents);
float LeastOf(const float* values, int count);
// Elevations [deg] of tangents; `none` of those that are `noTangent`, NaN of NaN. To 2e-5 degrees.
void ElevationsOf(const float* tangents, int count, float noTangent, float none, float* elevations);

// Least and greatest, without NaN; least > greatest if there are none.
struct HeightSpan {
  float least;
  float greatest;
};
HeightSpan SpanOf(const std::vector<float>& heights);

} // namespace dspace

#endif
