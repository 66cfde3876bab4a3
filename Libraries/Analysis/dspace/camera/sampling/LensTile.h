// A part of a picture through a lens, made from the pixels of source views.
#ifndef DSPACE_CAMERA_SAMPLING_LENS_TILE_H
#define DSPACE_CAMERA_SAMPLING_LENS_TILE_H

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <dspace/camera/sampling/LensMap.h>

namespace dspace {

// The planes of a block or a tile; each is empty unless it is asked for. Row 0 is the top row.
struct LensPlanes {
  int width = 0;
  int height = 0;
  std::vector<float> radiance; // three a pixel; of a pixel without a ray: 0
  std::vector<float> depth;    // along the view's or camera's Z [m]; +infinity: nothing, no ray
  std::vector<float> range;    // of a tile only: from the pixel's entrance pupil along its ray [m]
  std::vector<std::uint32_t> label;
  std::vector<float> litFraction; // NaN: nothing, no ray; as the angles [deg]
  std::vector<float> incidence;
  std::vector<float> emission;
  std::vector<float> phase;
  std::vector<float> normal; // three a pixel, in the root; NaN

  std::size_t Bytes() const;
};

// Which planes of a tile are wanted.
struct LensWishes {
  bool radiance = false, depth = false, range = false, label = false, litFraction = false,
       incidence = false, emission = false, phase = false, normal = false;

  bool OnlyRadiance() const {
    return this->radiance && !(this->depth || this->range || this->label || this->litFraction ||
                               this->incidence || this->emission || this->phase || this->normal);
  }
};

// Radiance is interpolated between source pixels, over the footprint of the pixel where the source
// is finer than the picture; all other planes take the nearest source pixel and are never blended.
// With a moving entrance pupil the source pixel is the one that shows the point which the pixel's
// own ray meets, found from the source's depth; what the pupil's own place uncovers is not.
class LensTile {
public:
  LensTile(const SourceViews& views, std::shared_ptr<const LensMap> map, const LensWishes& wishes);

  // Whether it needs depth of its blocks: for depth, range and a moving pupil.
  bool NeedsDepth() const;
  // Each block of the map once, in any order.
  void Take(const SourceViews::Block& block, const LensPlanes& from);

  const LensPlanes& Planes() const { return this->Planes_; }
  LensPlanes TakePlanes() { return std::move(this->Planes_); } // the tile then has none
  // The farthest that a moving pupil moved a pixel's place in a source view [source pixels], and
  // pixels whose place left the block that was drawn for it and stayed at its edge.
  double PupilPixels() const { return this->PupilPixels_; }
  std::uint64_t Beyond() const { return this->Beyond_; }

private:
  void Follow(LensMap::Pixel& pixel, const SourceViews::View& view, const LensPlanes& from,
              double nearest);
  void PutRadiance(const LensMap::Sample& sample, const SourceViews::View& view,
                   const LensPlanes& from);

  const SourceViews& Views_;
  std::shared_ptr<const LensMap> Map_;
  LensWishes Wishes_;
  LensPlanes Planes_;
  std::uint64_t Beyond_ = 0;
  double PupilPixels_ = 0.0;
};

} // namespace dspace

#endif
