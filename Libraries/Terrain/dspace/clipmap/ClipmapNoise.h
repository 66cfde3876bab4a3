// Noise on the posts that a clipmap draws. Not for public headers.
#ifndef DSPACE_TERRAIN_CLIPMAPNOISE_H
#define DSPACE_TERRAIN_CLIPMAPNOISE_H

#include <vector>

#include <dspace/clipmap/ClipmapStyle.h>
#include <dspace/layers/PerlinNoise.h>
#include <dspace/posts/PostLattice.h>
#include <dspace/posts/PostPlacement.h>
#include <dspace/posts/PostSource.h>

namespace dspace {

class ClipmapNoise {
public:
  // `placement` is where the posts stand. Throws what NoiseOptions::Check throws.
  ClipmapNoise(const ClipmapStyle::Noise& noise, const PostPlacement& placement);

  const ClipmapStyle::Noise& Noise() const { return this->Noise_; }
  // Raises each post of a block by the noise at its place. The value does not depend on the block,
  // nor on the turn around a body.
  void Roughen(const PostLattice& lattice, const PostBlock& block,
               std::vector<float>& heights) const;

private:
  ClipmapStyle::Noise Noise_;
  OctaveNoise Octaves_;
  PostPlacement Placement_;
};

} // namespace dspace

#endif
