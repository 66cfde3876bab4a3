#include <dspace/render/ViewportLimits.h>

#include <algorithm>
#include <cmath>

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr int MaximumSize = 16384;
constexpr int MaximumSamples = 8;
constexpr long long MaximumPicture = 1LL << 28; // samples: 2 GiB of colour and depth

template<class T> std::string Times(T a, T b) {
  return std::to_string(a) + " x " + std::to_string(b);
}

} // namespace

void CheckSize(const std::string& viewport, int width, int height) {
  if (width < 1 || height < 1 || width > MaximumSize || height > MaximumSize) {
    Reject(viewport, "size " + Times(width, height) + " is rejected; accepted: 1 to " +
                         std::to_string(MaximumSize) + " pixels a side");
  }
}

void CheckSamples(vtkDspaceHubWindow& window, const std::string& viewport, int width, int height,
                  int samples) {
  if (samples < 1 || samples > MaximumSamples) {
    Reject(viewport, "samples " + std::to_string(samples) + " is rejected; accepted: 1 to " +
                         std::to_string(MaximumSamples));
  }
  window.MakeCurrent();
  GLint texture = 0;
  GLint area[2] = {0, 0};
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, area);
  const long long side = std::min({texture, area[0], area[1]});
  const long long across = static_cast<long long>(width) * samples;
  const long long down = static_cast<long long>(height) * samples;
  if (across > side || down > side || across * down > MaximumPicture) {
    Reject(viewport,
           "size " + Times(width, height) + " with " + Times(samples, samples) +
               " samples a pixel is rejected, as that makes " + Times(across, down) +
               " samples; accepted: up to " + std::to_string(side) +
               " a side, which is what this OpenGL draws, and " + std::to_string(MaximumPicture) +
               " in all: " + (samples > 1 ? "samples=1, or a smaller size" : "a smaller size"));
  }
}

void CheckColor(const std::string& viewport, const std::array<double, 3>& color) {
  for (const double c : color) {
    if (!(c >= 0.0 && c <= 1.0)) {
      Reject(viewport,
             "background component " + std::to_string(c) + " is rejected; accepted: 0 to 1");
    }
  }
}

void CheckLook(vtkDspaceHubWindow& window, const std::string& viewport, const ViewLook& look) {
  const ShadowLook& shadows = look.shadows;
  if (shadows.cascades < 1 || shadows.cascades > ShadowLook::MaximumCascades) {
    Reject(viewport, "shadow cascades " + std::to_string(shadows.cascades) +
                         " are rejected; accepted: 1 to " +
                         std::to_string(ShadowLook::MaximumCascades));
  }
  window.MakeCurrent();
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  largest = std::min<GLint>(largest, ShadowLook::MaximumSize);
  if (shadows.size < ShadowLook::MinimumSize || shadows.size > largest) {
    Reject(viewport,
           "shadow maps of " + std::to_string(shadows.size) +
               " texels a side are rejected; accepted: " + std::to_string(ShadowLook::MinimumSize) +
               " to " + std::to_string(largest));
  }
  Require(shadows.distance >= 0.0 && shadows.distance <= 1e12, viewport, "the distance of shadows",
          shadows.distance, "0 (as the view requires) to 1e12 metres");
  RequireFraction(viewport, "its fill light", look.fill);
  Require(look.exposure > 0.0 && look.exposure <= 1e12, viewport, "its exposure", look.exposure,
          "above 0, to 1e12");
}

void CheckPick(const std::string& viewport, double x, double y, int radius, int width, int height) {
  if (!std::isfinite(x) || !std::isfinite(y) || x < -0.5 || y < -0.5 || x >= width - 0.5 ||
      y >= height - 0.5 || radius < 0 || radius > 256) {
    Reject(viewport, "pick at (" + std::to_string(x) + ", " + std::to_string(y) + ") with radius " +
                         std::to_string(radius) + " is rejected; accepted: pixels within " +
                         Times(width, height) + ", radius 0 to 256");
  }
}

} // namespace dspace
