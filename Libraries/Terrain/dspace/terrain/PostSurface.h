// The surface between the posts of a pyramid's level 0, as queries ask for it: blocks are read as
// they are needed.
#ifndef DSPACE_TERRAIN_POSTSURFACE_H
#define DSPACE_TERRAIN_POSTSURFACE_H

#include <functional>
#include <memory>
#include <vector>

#include <dspace/terrain/ElevationPyramid.h>
#include <dspace/terrain/HeightGrid.h>

#include "PostFacets.h"

namespace dspace {

// Triangles as HeightGrid has them, but for the cells at a pole: there the surface is ruled from
// the pole to the cell's other side, as the two triangles of posts that share a place would be.
class PostSurface {
public:
  using Facet = HeightGrid::Facet;

  // `poles`: the first and the last row are poles. `deadline` [s] is what a call waits for tiles.
  PostSurface(std::shared_ptr<ElevationPyramid> pyramid, bool poles, double deadline)
      : Pyramid_(std::move(pyramid)), Poles_(poles), Deadline_(deadline) {}

  // Not valid outside the lattice and in holes.
  Facet At(const Eigen::Vector2d& post) const;
  // For many places, in an order of its own: `take(i, facet)`, each block read once. NaN is
  // outside.
  void At(const std::vector<Eigen::Vector2d>& posts,
          const std::function<void(std::size_t, const Facet&)>& take) const;

  // A facet of cell (c, r) at (u, v) of it; `at` gives posts.
  template<typename Posts>
  Facet OfCell(const Posts& at, std::int64_t c, std::int64_t r, bool below, double u,
               double v) const;

  bool AtPole(std::int64_t cellRow) const {
    return this->Poles_ && (cellRow == 0 || cellRow == this->Lattice().rows - 2);
  }
  const PostLattice& Lattice() const { return this->Pyramid_->Lattice(); }
  const std::shared_ptr<ElevationPyramid>& SharedPyramid() const { return this->Pyramid_; }
  double Deadline() const { return this->Deadline_; }

private:
  std::shared_ptr<ElevationPyramid> Pyramid_;
  bool Poles_;
  double Deadline_;
};

template<typename Posts>
HeightGrid::Facet PostSurface::OfCell(const Posts& at, std::int64_t c, std::int64_t r, bool below,
                                      double u, double v) const {
  if (!this->AtPole(r)) {
    return FacetOfCell(at, c, r, below, u, v);
  }
  const bool north = r == 0;
  const double pole = at(c, north ? r : r + 1);
  const double west = at(c, north ? r + 1 : r);
  const double east = at(c + 1, north ? r + 1 : r);
  Facet facet;
  facet.valid = !(std::isnan(pole) || std::isnan(west) || std::isnan(east));
  if (facet.valid) {
    const double share = north ? v : 1.0 - v; // of the side that is not the pole
    const double side = west + u * (east - west);
    facet.height = pole + share * (side - pole);
    facet.dc = share * (east - west);
    facet.dr = north ? side - pole : pole - side;
  }
  return facet;
}

} // namespace dspace

#endif
