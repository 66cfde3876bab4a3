// The same ground by OpenSceneGraph: osgTerrain tiles in a paged quadtree, as osgdem builds them.
#ifndef DSPACE_BENCH_OSG_GROUND_H
#define DSPACE_BENCH_OSG_GROUND_H

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

namespace dspace::bench {

struct OsgGroundOptions {
  int cells = 128;    // a side of each tile, 8 to 254
  int side = 8192;    // cells of the finest level; tiles at the eastern and southern edge overhang
  double pixel = 2.0; // [m] between posts of the finest level
  Eigen::Vector2d northWest = Eigen::Vector2d::Zero(); // post (0, 0) [m]
  // Height [m] at post (column, row) of the finest level; threads of the pager call it, too.
  std::function<double(int column, int row)> height;
  Eigen::Vector3d sun = {0, 0, -1}; // where it shines to
  int width = 1280;                 // of the picture
  int heightPixels = 720;
  double verticalFov_deg = 60.0;
  double nearDistance = 1.0; // [m]; ordinary depth of 24 bits
  double farDistance = 50000.0;
  // A tile gives way to its four children where its centre is nearer than this many of its radii;
  // osgdem's is 7.
  double ratio = 7.0;
  // Depth of the tiles' skirts, which hide gaps, in their radii: osgdem's.
  double skirt = 0.02;
};

// Draws into a pbuffer with an OpenGL context of its own (compatibility profile). Throws
// std::runtime_error where there is none.
class OsgGround {
public:
  explicit OsgGround(const OsgGroundOptions& options);
  ~OsgGround();
  OsgGround(const OsgGround&) = delete;
  OsgGround& operator=(const OsgGround&) = delete;

  void Look(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);
  // Lambert's law in each pixel, by a shader; else at vertices, by OpenGL's fixed functions, as
  // osgTerrain is lit by default.
  void LightPixels(bool on);
  void Draw();                   // a frame, to its end
  void Complete();               // frames until no tile is on its way
  std::size_t Triangles() const; // of the last frame
  bool Pending() const;          // whether tiles were on their way in the last frame

  std::vector<float> Depth() const;        // of the last frame: metres along the camera's Z,
                                           // infinite where nothing is; row 0 at the top
  std::vector<std::uint8_t> Color() const; // RGB, row 0 at the top

private:
  struct Parts;
  std::unique_ptr<Parts> Parts_;
};

} // namespace dspace::bench

#endif
