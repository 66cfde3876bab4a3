// The ground that terrain is measured on: a formula, rasters of it, and a scene that flies over it.
#ifndef DSPACE_BENCH_GROUND_H
#define DSPACE_BENCH_GROUND_H

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "vtkDspaceViewport.h"
#include "vtkSmartPointer.h"

#include <dspace/scene/Scene.h>
#include <dspace/surface/StreamedTerrain.h>

class vtkDspaceRenderContext;

namespace dspace::bench {

constexpr int Width = 1280; // of every picture
constexpr int Height = 720;
constexpr int Tile = 1024;    // pixels a side of what the rasters repeat
constexpr double Pixel = 2.0; // [m]

// Height [m] at a post, periodic in a tile, so that it may be repeated; between posts, too.
double Analytic(double column, double row);

// Rasters of it in `folder`: one tile; any number of tiles, which take no space.
std::string WriteTile(const std::filesystem::path& folder);
std::string WriteMosaic(const std::filesystem::path& folder, int width, int height);
// image.tif beside them: colours with structure at every scale.
std::string WriteImage(const std::filesystem::path& folder);

std::size_t ResidentBytes(); // of this process

// What colours the ground besides its material.
enum class Paint { None, Texture, Layer }; // one mip-mapped texture; a streamed colour layer

// A scene with one clipmap, lit by a sun.
struct Ground {
  Ground(vtkDspaceRenderContext* context, const std::string& path, bool lit, Paint paint,
         int levelSize = 124);
  // `t` metres along a line over the ground's middle.
  void Fly(double t);

  std::shared_ptr<Scene> scene = std::make_shared<Scene>("ground");
  std::shared_ptr<const StreamedTerrain> surface;
  vtkSmartPointer<vtkDspaceViewport> viewport = vtkSmartPointer<vtkDspaceViewport>::New();
  ObjectId object = 0;
  int cells = 0;      // a side of its levels
  double down = 0.25; // of the look: the horizon is in sight
};

// Where the sun shines to.
Eigen::Vector3d SunDirection();

// Pixels between what is drawn and what is stated, up and down the screen, each over the metres
// that a pixel shows there.
struct PixelErrors {
  std::vector<double> all;
  double Rms() const;
  double Share(double part) const; // 0.99: all but 1 % are smaller
  double Greatest() const;
};
// `height` [m] of the ground at a point of the scene, NaN where there is none. The points are those
// that every fourth pixel's ray met, by the depth [m along the camera's Z, row 0 at the top].
template<class HeightAt>
void AddErrors(PixelErrors& errors, const std::vector<float>& depth, const Camera& camera,
               const HeightAt& height) {
  const Pose& X = camera.mount.X_FC;
  for (int y = 0; y < Height; y += 4) {
    for (int x = 0; x < Width; x += 4) {
      const float z = depth[std::size_t(y) * Width + x];
      if (!std::isfinite(z)) {
        continue;
      }
      const Projection::Ray ray = camera.projection.PixelRay(x, y, Width, Height);
      const Eigen::Vector3d p = X.Apply(ray.direction * (double(z) / ray.direction.z()));
      const double truth = height(p);
      if (std::isfinite(truth)) {
        errors.all.push_back(std::abs(p.z() - truth) / camera.projection.MetresPerPixel(z, Height));
      }
    }
  }
}

} // namespace dspace::bench

#endif
