#include <dspace/horizon/HorizonKernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <dspace/horizon/ForProcessors.h>

namespace dspace {
namespace {

constexpr float Rounding = 1e-6f; // of floats: more than that of a product, a sum and a quotient

} // namespace

// The loops over lanes have a fixed length and no branches, so that compilers vectorize them; a
// comparison with NaN keeps what was there.

DSPACE_FOR_PROCESSORS
void MarchEdges(const std::vector<EdgeStep>& steps, const float* heights, const float* z,
                float* tangents) {
  alignas(32) float best[HorizonLanes];
  alignas(32) float from[HorizonLanes];
  std::copy_n(tangents, HorizonLanes, best);
  std::copy_n(z, HorizonLanes, from);
  for (const EdgeStep& step : steps) {
    const float* a = heights + step.first;
    const float* b = heights + step.second;
    const HorizonStep g = step.ground;
    const float share = step.share;
    // Divisions cost more than all else, and few places raise a horizon.
    int raised = 0;
    if (g.fall == 0.0f && g.rise == 1.0f && g.spread == 0.0f) { // a plane
      for (int i = 0; i < HorizonLanes; ++i) {
        const float over = a[i] + share * (b[i] - a[i]) - from[i];
        raised |= -int(over - best[i] * g.away > -Rounding * std::abs(over));
      }
    } else {
      for (int i = 0; i < HorizonLanes; ++i) {
        const float h = a[i] + share * (b[i] - a[i]);
        const float over = g.fall + g.rise * h - from[i];
        const float away = g.away + g.spread * h;
        raised |= -int(over - best[i] * away > -Rounding * std::abs(over));
      }
    }
    if (!raised) {
      continue;
    }
    for (int i = 0; i < HorizonLanes; ++i) {
      const float h = a[i] + share * (b[i] - a[i]);
      const float t = (g.fall + g.rise * h - from[i]) / (g.away + g.spread * h);
      best[i] = t > best[i] ? t : best[i];
    }
  }
  std::copy_n(best, HorizonLanes, tangents);
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
