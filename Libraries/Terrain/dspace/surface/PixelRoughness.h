// How rough the ground is about a place: heights of pixels about their best plane. Not for public
// headers.
#ifndef DSPACE_TERRAIN_PIXELROUGHNESS_H
#define DSPACE_TERRAIN_PIXELROUGHNESS_H

#include <functional>
#include <string>

#include <dspace/posts/PostLattice.h>
#include <dspace/posts/PostPlacement.h>
#include <dspace/posts/PostSource.h>

namespace dspace {

// See StreamedTerrain::Roughness.
class PixelRoughness {
public:
  // The posts of one level, pixels among them.
  struct Pixels {
    PostLattice lattice;
    PostPlacement placement;
    int level = 0;
    // The level has rows and columns between those of pixels, too: its odd rows and its even
    // columns are pixels.
    bool between = false;
    std::function<void(const PostBlock& block, float* heights)> read;
  };
  // `object` is for messages.
  PixelRoughness(std::string object, Pixels pixels);

  // Throws Error(InvalidArgument) for a radius that reaches over 4 million pixels.
  double At(const Eigen::Vector3d& p_S, double radius) const;

private:
  Eigen::Vector2d Reach(const Eigen::Vector3d& p_S, double radius) const;
  PostBlock BlockAbout(const Eigen::Vector3d& p_S, double radius) const;

  std::string Object_;
  Pixels Pixels_;
};

} // namespace dspace

#endif
