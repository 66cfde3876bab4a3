// Exact rays against the surface between the posts of a pyramid.
#ifndef DSPACE_TERRAIN_SURFACERAY_H
#define DSPACE_TERRAIN_SURFACERAY_H

#include <memory>

#include <dspace/pyramid/PostSurface.h>
#include <dspace/rays/RayCover.h>
#include <dspace/rays/RayLayer.h>
#include <dspace/rays/RayPath.h>

namespace dspace {

// As GridRay, with posts that are read where the ray needs them: blocks of cells that it passes
// wholly above or below are skipped by their least and greatest heights, and in the cells of level
// 0 that remain the sign of its height over the ground is followed from place to place, so that no
// ray slips through an edge. On a sphere heights along a cell are curved: they are looked at in its
// middle and where a parabola through three places has its extreme, and crossings are bracketed.
class SurfaceRay {
public:
  struct Hit {
    bool hit = false;
    bool fromBelow = false;
    double distance = 0.0;
    HeightGrid::Facet facet;
  };

  // Keeps references to the surfaces, which must outlive it. Of ground that differs from a plain
  // surface of coarser posts only where `cover` says so, the rest is followed on the plain one;
  // where it does, blocks are skipped by the plain one's heights and what the cover makes of them,
  // and posts are read one by one where the cover allows it.
  explicit SurfaceRay(const PostSurface& surface, const PostSurface* plain = nullptr,
                      std::unique_ptr<const RayCover> cover = nullptr);

  Hit Intersect(const RayPath& path) const;

private:
  struct March;
  // How a block is followed.
  enum class Way {
    Tiles,  // of the surface
    Single, // posts, one by one; at most 2^PatchProbe::Bits cells
    Plain   // tiles of the plain surface
  };
  bool Visit(March& march, int bits, std::int64_t c, std::int64_t r, double t0, double t1,
             Way way) const;
  bool VisitCell(March& march, std::int64_t c, std::int64_t r, double t0, double t1, Way way) const;
  template<typename Posts>
  bool Follow(March& march, const PostSurface& surface, const Posts& posts, std::int64_t c,
              std::int64_t r, double t0, double t1) const;
  bool Misses(March& march, int bits, std::int64_t c, std::int64_t r, double t0, double t1,
              Way way) const;
  Way WayOf(March& march, int bits, std::int64_t c, std::int64_t r) const;

  std::unique_ptr<RayLayer> Layer_;
  std::unique_ptr<RayLayer> Plain_; // null: there is none; nor a cover
  std::unique_ptr<const RayCover> Cover_;
};

} // namespace dspace

#endif
