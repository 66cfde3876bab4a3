// The posts of a whole body around one of its poles, from those of its degree grid.
#ifndef DSPACE_TERRAIN_POLARPOSTS_H
#define DSPACE_TERRAIN_POLARPOSTS_H

#include <memory>
#include <string>

#include <dspace/posts/PostPlacement.h>
#include <dspace/posts/PostSource.h>

namespace dspace {

// A degree grid's columns crowd at the poles: a clipmap of it shows little ground to the east and
// west there. Around a pole the ground is drawn from a square of the pole's stereographic plane
// instead, which reaches 35 degrees past the equator, farther than any camera from within 30
// degrees of the pole sees. It is resampled: level l has the height that the grid's level
// l (or the finest that holds all of its data, where that is coarser) has at the post's place, on
// the grid's triangles.
class PolarPosts : public PostSource {
public:
  // `base` goes once around the body and from pole to pole, placed by `placement` (Sphere). Its
  // level `complete` and coarser ones are read; finer ones say no more. `coarsest` as for
  // RasterPosts.
  PolarPosts(std::shared_ptr<const PostSource> base, const PostPlacement& placement, int complete,
             bool south, int coarsest);

  const std::string& GetName() const override { return this->Base_->GetName(); }
  const PostLattice& GetLattice() const override { return this->Lattice_; }
  void Read(const PostBlock& block, float* heights) const override;
  const PostPlacement& Placement() const { return this->Polar_; }

private:
  std::shared_ptr<const PostSource> Base_;
  PostPlacement Placement_; // of the base
  PostPlacement Polar_;
  PostLattice Lattice_;
  int Complete_;
};

} // namespace dspace

#endif
