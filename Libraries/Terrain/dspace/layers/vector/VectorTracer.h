// Placed shapes to chains of texels of one block. Not for public headers.
#ifndef DSPACE_LAYERS_VECTORTRACER_H
#define DSPACE_LAYERS_VECTORTRACER_H

#include <vector>

#include <dspace/layers/TexelSides.h>
#include <dspace/layers/vector/VectorCanvas.h>
#include <dspace/layers/vector/VectorPlaces.h>

namespace dspace {

class VectorTracer {
public:
  // `turn` as in VectorPlaces.
  VectorTracer(const ColorGrid& grid, const ColorBlock& block, double turn);

  // Width of a line: of metres, or of texels where `metres` is 0.
  struct Width {
    double metres = 0.0;
    double pixels = 0.0;
  };
  // Half axes [texels] of a pen there that is round on the ground; on a body
  // accurate to a hundredth.
  Eigen::Vector2d PenAt(const Eigen::Vector2d& texel, const Width& width) const;
  // The greatest in the block, or a little more.
  double Reach(const Width& width) const;

  // Offsets [texels] of the turns in which a box of the map, grown by `reach` texels, meets the
  // block; none where it does not.
  std::vector<Eigen::Vector2d> Turns(const Eigen::AlignedBox2d& map, double reach) const;

  // Both follow the edges of the file's CRS to a quarter of a texel, as far as they may be seen.
  TexelChain Block() const; // a little more than all of it
  TexelChain Area(const PlacedRing& ring, const MapConversion& conversion,
                  const Eigen::Vector2d& offset) const;
  void Path(const PlacedRing& ring, const MapConversion& conversion, const Eigen::Vector2d& offset,
            const Width& width, std::vector<TexelStroke>& strokes) const;

  Eigen::Vector2d ToTexel(const Eigen::Vector2d& map) const { return this->MapToTexel_ * map; }

private:
  struct Place { // in the file's CRS, on the map, in texels
    Eigen::Vector2d from, map, texel;
  };
  TexelChain Follow(const PlacedRing& ring, std::size_t count, const MapConversion& conversion,
                    const Eigen::Vector2d& offset, double reach) const;
  void Refine(const Place& a, const Place& b, const MapConversion& conversion,
              const Eigen::AlignedBox2d& window, const Eigen::Vector2d& offset, int depth,
              TexelChain& chain) const;
  void Stroke(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Width& width, int depth,
              std::vector<TexelStroke>& strokes) const;
  Eigen::AlignedBox2d Window(double reach) const; // the block, grown

  const ColorGrid& Grid_;
  TexelSides Sides_;
  Eigen::Affine2d TexelToPost_;
  Eigen::Affine2d MapToTexel_;
  Eigen::Vector2d Size_; // of the block
  double Turn_;
};

} // namespace dspace

#endif
