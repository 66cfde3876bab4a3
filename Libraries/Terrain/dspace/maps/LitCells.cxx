#include <dspace/maps/LitCells.h>

#include <cmath>

#include <dspace/horizon/ForProcessors.h>

namespace dspace {
namespace {

// The part of a disc of radius 1 beyond a chord at the distance `x` from its centre: 0.5 at 0, and
// 0 at 1. The arc cosine is M. Abramowitz, I. Stegun, "Handbook of Mathematical Functions", 4.4.46,
// to 2e-8.
inline float Segment(float x) {
  float p = -0.0012624911f;
  p = p * x + 0.0066700901f;
  p = p * x - 0.0170881256f;
  p = p * x + 0.0308918810f;
  p = p * x - 0.0501743046f;
  p = p * x + 0.0889789874f;
  p = p * x - 0.2145988016f;
  p = p * x + 1.5707963050f;
  const float rest = 1.0f - x;
  const float angle = std::sqrt(rest) * p;
  return (angle - x * std::sqrt(rest * (1.0f + x))) * 0.31830989f;
}

} // namespace

DSPACE_FOR_PROCESSORS
void AddLit(const SeenRow& row, float radius, float perRise, const LitCounts& counts) {
  const float* const above = row.above;
  const float* const rise = row.rise;
  const float* const secant = row.secant;
  float* const lit = counts.lit;
  std::uint32_t* const night = counts.night;
  std::uint32_t* const longest = counts.longest;
  for (int i = 0; i < row.count; ++i) {
    const float slope = rise[i] * perRise * secant[i];
    const float x = above[i] / (radius * std::sqrt(1.0f + slope * slope));
    float away = std::fabs(x);
    away = away > 1.0f ? 1.0f : away;
    const float beyond = Segment(away);
    const float part = x < 0.0f ? beyond : 1.0f - beyond;
    const std::uint32_t dark = night[i] + 1;
    const std::uint32_t next = part > 0.0f ? 0 : dark;
    lit[i] += part;
    night[i] = next;
    longest[i] = next > longest[i] ? next : longest[i];
  }
}

DSPACE_FOR_PROCESSORS
void CountAbove(const SeenRow& row, std::uint32_t* counts) {
  const float* const above = row.above;
  for (int i = 0; i < row.count; ++i) {
    counts[i] += above[i] >= 0.0f ? 1 : 0;
  }
}

} // namespace dspace
