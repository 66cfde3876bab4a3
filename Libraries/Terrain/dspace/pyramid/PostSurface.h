// Queries of the surface between the posts of a pyramid. Blocks are read on demand.
#ifndef DSPACE_TERRAIN_POSTSURFACE_H
#define DSPACE_TERRAIN_POSTSURFACE_H

#include <functional>
#include <memory>
#include <vector>

#include <dspace/posts/HeightGrid.h>
#include <dspace/pyramid/ElevationPyramid.h>

#include <dspace/posts/PostFacets.h>

namespace dspace {

// The triangles of HeightGrid between the posts of the finest level with information of its own;
// posts of finer levels lie on them up to rounding. In the cells at a pole the surface is ruled
// from the pole to the cell's other side. Places and facets are in posts of level 0, cells in posts
// of that level.
class PostSurface {
public:
  using Facet = HeightGrid::Facet;

  // `level` has all information and divides the lattice evenly. `poles`: the first and the last row
  // are poles. `deadline` [s]: longest wait for tiles. `scattered`: if few places lie in a tile,
  // the calling thread reads only their posts: with the source's probe or, if it has none and the
  // tile is not in memory, in blocks. Use it if tiles are expensive and the source is not on a
  // server.
  PostSurface(std::shared_ptr<ElevationPyramid> pyramid, int level, bool poles, double deadline,
              bool scattered = false);
  ~PostSurface();

  // Not valid outside the lattice and in holes.
  Facet At(const Eigen::Vector2d& post) const;
  // For many places: calls `take(i, facet)` in any order and reads each block once. NaN is outside.
  void At(const std::vector<Eigen::Vector2d>& posts,
          const std::function<void(std::size_t, const Facet&)>& take) const;

  // A facet of cell (c, r) at (u, v) of it; `at` gives posts of the level.
  template<typename Posts>
  Facet OfCell(const Posts& at, std::int64_t c, std::int64_t r, bool below, double u,
               double v) const;

  bool AtPole(std::int64_t cellRow) const {
    return this->Poles_ && (cellRow == 0 || cellRow == this->Lattice().RowsAt(this->Level_) - 2);
  }
  int Level() const { return this->Level_; }
  const PostLattice& Lattice() const { return this->Pyramid_->Lattice(); }
  const std::shared_ptr<ElevationPyramid>& SharedPyramid() const { return this->Pyramid_; }
  double Deadline() const { return this->Deadline_; }

private:
  struct SinglePostCounts;
  bool PrefersSingleBlocks(std::size_t count, std::int64_t tileColumn, std::int64_t tileRow) const;
  std::shared_ptr<ElevationPyramid> Pyramid_;
  int Level_;
  bool Poles_;
  double Deadline_;
  std::unique_ptr<SinglePostCounts> SinglePostCounts_; // null: tiles are read
};

template<typename Posts>
HeightGrid::Facet PostSurface::OfCell(const Posts& at, std::int64_t c, std::int64_t r, bool below,
                                      double u, double v) const {
  Facet facet;
  if (!this->AtPole(r)) {
    facet = FacetOfCell(at, c, r, below, u, v);
  } else {
    const bool north = r == 0;
    const double pole = at(c, north ? r : r + 1);
    const double west = at(c, north ? r + 1 : r);
    const double east = at(c + 1, north ? r + 1 : r);
    facet.valid = !(std::isnan(pole) || std::isnan(west) || std::isnan(east));
    const double share = north ? v : 1.0 - v; // of the side that is not the pole
    const double side = west + u * (east - west);
    facet.height = pole + share * (side - pole);
    facet.dc = share * (east - west);
    facet.dr = north ? side - pole : pole - side;
  }
  const double scale = std::ldexp(1.0, -this->Level_);
  facet.dc *= scale;
  facet.dr *= scale;
  return facet;
}

} // namespace dspace

#endif
