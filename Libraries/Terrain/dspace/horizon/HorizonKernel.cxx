#include <dspace/horizon/HorizonKernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include <dspace/horizon/ForProcessors.h>

// Vectors that functions here return stay in registers: all of these functions are inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace dspace {
namespace {

// Eight floats: an AVX register, or two of SSE. The compiler's own choice for loops over lanes is
// up to five times as slow. The other loops have a fixed length and no branches, so that it
// vectorizes them.
using Eight = float __attribute__((vector_size(32)));
using EightTruths = int __attribute__((vector_size(32)));
constexpr int Vectors = HorizonGroup / 8; // of a group
constexpr unsigned AllGroups = (1u << (HorizonLanes / HorizonGroup)) - 1u;
constexpr int Together = 4; // steps of which it is asked at once whether they raise a horizon

#define DSPACE_INLINE __attribute__((always_inline))

DSPACE_INLINE inline Eight EightAt(const float* values) {
  Eight eight;
  std::memcpy(&eight, values, sizeof eight);
  return eight;
}

DSPACE_INLINE inline bool Any(const EightTruths& truths) {
  using Four = long long __attribute__((vector_size(32)));
  const Four four = reinterpret_cast<const Four&>(truths);
  return (four[0] | four[1] | four[2] | four[3]) != 0;
}

DSPACE_INLINE inline Eight LowerThan(const Eight& values) {
  return values - HorizonRounding * (values < 0.0f ? -values : values);
}

bool OnPlane(const HorizonStep& ground) {
  return ground.fall == 0.0f && ground.rise == 1.0f && ground.spread == 0.0f;
}

// Tangents and heights of Count x 8 posts. A comparison with NaN keeps what was there.
template<int Count> struct Posts {
  Eight best[Count];
  Eight from[Count];

  DSPACE_INLINE Posts(const float* z, const float* tangents) {
    for (int k = 0; k < Count; ++k) {
      this->best[k] = EightAt(tangents + 8 * k);
      this->from[k] = EightAt(z + 8 * k);
    }
  }
  DSPACE_INLINE void Raise(int k, const Eight& t) {
    this->best[k] = t > this->best[k] ? t : this->best[k];
  }
  DSPACE_INLINE void Write(float* tangents) const {
    for (int k = 0; k < Count; ++k) {
      std::memcpy(tangents + 8 * k, &this->best[k], sizeof this->best[k]);
    }
  }
};

DSPACE_INLINE inline Eight HeightAt(const EdgeStep& step, const float* heights, int k) {
  const Eight left = EightAt(heights + step.first + 8 * k);
  return left + step.share * (EightAt(heights + step.second + 8 * k) - left);
}

template<int Count>
DSPACE_INLINE inline void MarchPlane(const std::vector<EdgeStep>& steps, const float* heights,
                                     const float* z, float* tangents) {
  Posts<Count> posts(z, tangents);
  for (const EdgeStep& step : steps) {
    const float near = 1.0f / step.ground.away;
    for (int k = 0; k < Count; ++k) {
      posts.Raise(k, (HeightAt(step, heights, k) - posts.from[k]) * near);
    }
  }
  posts.Write(tangents);
}

// Divisions cost more than all else, and few places raise a horizon: what is not above `low`, which
// is below the tangent by more than rounding, is not divided.
template<int Count>
DSPACE_INLINE inline void MarchBody(const std::vector<EdgeStep>& steps, const float* heights,
                                    const float* z, float* tangents) {
  Posts<Count> posts(z, tangents);
  Eight low[Count];
  for (int k = 0; k < Count; ++k) {
    low[k] = LowerThan(posts.best[k]);
  }
  const EdgeStep* const end = steps.data() + steps.size();
  for (const EdgeStep* next = steps.data(); next != end;) {
    const EdgeStep* const to = next + std::min<std::ptrdiff_t>(Together, end - next);
    EightTruths raised = {};
    for (const EdgeStep* step = next; step != to; ++step) {
      const HorizonStep& g = step->ground;
      for (int k = 0; k < Count; ++k) {
        const Eight h = HeightAt(*step, heights, k);
        raised |= g.fall + g.rise * h - posts.from[k] > low[k] * (g.away + g.spread * h);
      }
    }
    for (; Any(raised) && next != to; ++next) {
      const HorizonStep& g = next->ground;
      for (int k = 0; k < Count; ++k) {
        const Eight h = HeightAt(*next, heights, k);
        posts.Raise(k, (g.fall + g.rise * h - posts.from[k]) / (g.away + g.spread * h));
        low[k] = LowerThan(posts.best[k]);
      }
    }
    next = to;
  }
  posts.Write(tangents);
}

template<int Count>
DSPACE_INLINE inline void MarchLevel(const std::vector<EdgeStep>& steps, float base,
                                     const float* heights, const float* z, float* tangents) {
  Posts<Count> posts(z, tangents);
  for (const EdgeStep& step : steps) {
    const HorizonStep& g = step.ground;
    const float near = 1.0f / (g.away + g.spread * base);
    const float second = step.share * g.rise;
    const float first = g.rise - second;
    for (int k = 0; k < Count; ++k) {
      const Eight h = first * EightAt(heights + step.first + 8 * k) +
                      second * EightAt(heights + step.second + 8 * k);
      posts.Raise(k, (g.fall + h - posts.from[k]) * near);
    }
  }
  posts.Write(tangents);
}

// Calls march(lane, count) for the lanes of the groups, `count` x 8 of them at once.
template<typename March> DSPACE_INLINE inline void ForGroups(unsigned groups, const March& march) {
  if (groups == AllGroups) {
    march(0, std::integral_constant<int, HorizonLanes / 8>());
    return;
  }
  for (int lane = 0; lane < HorizonLanes; lane += HorizonGroup) {
    if (groups >> (lane / HorizonGroup) & 1u) {
      march(lane, std::integral_constant<int, Vectors>());
    }
  }
}

} // namespace

DSPACE_FOR_PROCESSORS
void MarchEdges(const std::vector<EdgeStep>& steps, unsigned groups, const float* heights,
                const float* z, float* tangents) {
  if (!steps.empty() && OnPlane(steps.back().ground)) {
    ForGroups(groups, [&](int lane, auto count) DSPACE_INLINE {
      MarchPlane<count>(steps, heights + lane, z + lane, tangents + lane);
    });
  } else {
    ForGroups(groups, [&](int lane, auto count) DSPACE_INLINE {
      MarchBody<count>(steps, heights + lane, z + lane, tangents + lane);
    });
  }
}

DSPACE_FOR_PROCESSORS
void MarchEdgesFast(const std::vector<EdgeStep>& steps, unsigned groups, float base,
                    const float* heights, const float* z, float* tangents) {
  ForGroups(groups, [&](int lane, auto count) DSPACE_INLINE {
    MarchLevel<count>(steps, base, heights + lane, z + lane, tangents + lane);
  });
}

DSPACE_FOR_PROCESSORS
unsigned MayRaise(const GroupCrests& crests, const LaneReach& reach, float slack, const float* z,
                  const float* tangents) {
  constexpr int Count = int(std::tuple_size_v<GroupCrests>);
  EightTruths may[Count];
  EightTruths all = {};
  for (int g = 0; g < Count; ++g) {
    may[g] = EightTruths{};
    for (int k = 0; k < Vectors; ++k) {
      const int at = g * HorizonGroup + 8 * k;
      const Eight up = crests[std::size_t(g)] - EightAt(z + at);
      const Eight near = up * reach.over;
      const Eight far = up * reach.under;
      may[g] |= (near > far ? near : far) > EightAt(tangents + at) + slack;
    }
    all |= may[g];
  }
  unsigned groups = 0;
  for (int g = 0; Any(all) && g < Count; ++g) {
    groups |= unsigned(Any(may[g])) << g;
  }
  return groups;
}

DSPACE_FOR_PROCESSORS
float LeastOf(const float* values, int count) {
  const auto size = std::size_t(count);
  constexpr std::size_t Width = 16;
  std::array<float, Width> least;
  least.fill(std::numeric_limits<float>::infinity());
  const std::size_t whole = size / Width * Width;
  for (std::size_t i = 0; i < whole; i += Width) {
    for (std::size_t k = 0; k < Width; ++k) {
      least[k] = values[i + k] < least[k] ? values[i + k] : least[k];
    }
  }
  for (std::size_t i = whole; i < size; ++i) {
    least[0] = values[i] < least[0] ? values[i] : least[0];
  }
  return *std::min_element(least.begin(), least.end());
}

// atan x = pi / 4 + atan((x - 1) / (x + 1)) for |x| <= 1 after a reciprocal, halved once more by
// the same identity; then its series to the fifteenth power.
DSPACE_FOR_PROCESSORS
void ElevationsOf(const float* tangents, int count, float noTangent, float none,
                  float* elevations) {
  constexpr float Eighth = 0.41421356f; // tangent of pi / 8
  constexpr float Degrees = 57.29578f;
  for (int i = 0; i < count; ++i) {
    const float t = tangents[i];
    const float size = std::abs(t);
    const bool steep = size > 1.0f;
    const float x = steep ? 1.0f / size : size; // 0 to 1
    const bool upper = x > Eighth;
    const float y = upper ? (x - 1.0f) / (x + 1.0f) : x; // up to Eighth
    const float q = y * y;
    float sum = 1.0f / 15.0f; // 1 - q / 3 + q^2 / 5 - ..., from its end
    sum = 1.0f / 13.0f - q * sum;
    sum = 1.0f / 11.0f - q * sum;
    sum = 1.0f / 9.0f - q * sum;
    sum = 1.0f / 7.0f - q * sum;
    sum = 1.0f / 5.0f - q * sum;
    sum = 1.0f / 3.0f - q * sum;
    const float series = y - y * q * sum;
    const float first = upper ? 0.78539816f + series : series;
    const float angle = steep ? 1.57079633f - first : first;
    const float signedAngle = t < 0.0f ? -angle : angle;
    elevations[i] = t == noTangent ? none : (t != t ? t : signedAngle * Degrees);
  }
}

DSPACE_FOR_PROCESSORS
void MarchCells(const std::vector<CellStep>& steps, const float* heights, std::ptrdiff_t width,
                float lane, const float* z, float* tangents) {
  alignas(32) float best[HorizonLanes];
  alignas(32) float from[HorizonLanes];
  const int columns = int(std::ceil(lane * float(HorizonLanes))) + 2;
  alignas(32) float few[HorizonLanes + 8] = {};
  std::vector<float> many;
  float* row = few;
  if (columns > HorizonLanes + 8) {
    many.resize(std::size_t(columns));
    row = many.data();
  }
  std::copy_n(tangents, HorizonLanes, best);
  std::copy_n(z, HorizonLanes, from);
  for (const CellStep& step : steps) {
    const float* a = heights + step.first;
    const float* b = a + width;
    for (int i = 0; i < columns; ++i) {
      row[i] = a[i] + step.down * (b[i] - a[i]);
    }
    const HorizonStep g = step.ground;
    const float along = step.along;
    for (int i = 0; i < HorizonLanes; ++i) {
      const float x = along + float(i) * lane;
      const int k = int(x);
      const float h = row[k] + (x - float(k)) * (row[k + 1] - row[k]);
      const float t = (g.fall + g.rise * h - from[i]) / (g.away + g.spread * h);
      best[i] = t > best[i] ? t : best[i];
    }
  }
  std::copy_n(best, HorizonLanes, tangents);
}

DSPACE_FOR_PROCESSORS
HeightSpan SpanOf(const std::vector<float>& heights) {
  constexpr std::size_t Width = 16;
  std::array<float, Width> least;
  std::array<float, Width> greatest;
  least.fill(std::numeric_limits<float>::infinity());
  greatest.fill(-std::numeric_limits<float>::infinity());
  const std::size_t whole = heights.size() / Width * Width;
  for (std::size_t i = 0; i < whole; i += Width) {
    for (std::size_t k = 0; k < Width; ++k) {
      const float h = heights[i + k];
      least[k] = h < least[k] ? h : least[k];
      greatest[k] = h > greatest[k] ? h : greatest[k];
    }
  }
  for (std::size_t i = whole; i < heights.size(); ++i) {
    least[0] = heights[i] < least[0] ? heights[i] : least[0];
    greatest[0] = heights[i] > greatest[0] ? heights[i] : greatest[0];
  }
  return {*std::min_element(least.begin(), least.end()),
          *std::max_element(greatest.begin(), greatest.end())};
}

} // namespace dspace
