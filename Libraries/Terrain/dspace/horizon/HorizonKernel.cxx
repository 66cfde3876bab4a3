#include <dspace/horizon/HorizonKernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <dspace/horizon/ForProcessors.h>

namespace dspace {
namespace {

constexpr float Most = 1e30f;     // of a tangent; above: of a post without data
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
void MarchEdgesFast(const std::vector<EdgeStep>& steps, const float* heights, const float* z,
                    float* tangents) {
  alignas(32) float best[HorizonLanes];
  alignas(32) float from[HorizonLanes];
  std::copy_n(tangents, HorizonLanes, best);
  std::copy_n(z, HorizonLanes, from);
  float base = 0.0f;
  int lanes = 0;
  for (int i = 0; i < HorizonLanes; ++i) {
    if (std::isfinite(z[i]) && !(tangents[i] > Most)) { // else it has no data
      base += z[i];
      ++lanes;
    }
  }
  base /= float(std::max(lanes, 1));
  for (const EdgeStep& step : steps) {
    const float* a = heights + step.first;
    const float* b = heights + step.second;
    const HorizonStep g = step.ground;
    const float near = 1.0f / (g.away + g.spread * base);
    const float second = step.share * g.rise;
    const float first = g.rise - second;
    for (int i = 0; i < HorizonLanes; ++i) {
      const float t = (g.fall + (first * a[i] + second * b[i]) - from[i]) * near;
      best[i] = t > best[i] ? t : best[i];
    }
  }
  std::copy_n(best, HorizonLanes, tangents);
}

DSPACE_FOR_PROCESSORS
bool MayRaiseLanes(float crest, float over, float under, float slack, const float* z,
                   const float* tangents) {
  int may = 0;
  for (int i = 0; i < HorizonLanes; ++i) {
    const float up = crest - z[i];
    const float near = up * over;
    const float far = up * under;
    may |= -int((near > far ? near : far) > tangents[i] + slack);
  }
  return may != 0;
}

DSPACE_FOR_PROCESSORS
float LeastOf(const std::vector<float>& values) {
  constexpr std::size_t Width = 16;
  std::array<float, Width> least;
  least.fill(std::numeric_limits<float>::infinity());
  const std::size_t whole = values.size() / Width * Width;
  for (std::size_t i = 0; i < whole; i += Width) {
    for (std::size_t k = 0; k < Width; ++k) {
      least[k] = values[i + k] < least[k] ? values[i + k] : least[k];
    }
  }
  for (std::size_t i = whole; i < values.size(); ++i) {
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
