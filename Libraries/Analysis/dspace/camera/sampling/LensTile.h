// A part of a picture through a lens, made from the pixels of source views.
#ifndef DSPACE_CAMERA_SAMPLING_LENS_TILE_H
#define DSPACE_CAMERA_SAMPLING_LENS_TILE_H

#include <cstdint>
#include <set>
#include <vector>

#include <dspace/camera/sampling/SourceViews.h>

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

  std::size_t Bytes() const;
};

// Which planes of a tile are wanted.
struct LensWishes {
  bool radiance = false, depth = false, range = false, label = false, litFraction = false,
       incidence = false, emission = false, phase = false;
};

// Radiance is interpolated between source pixels, over the footprint of the pixel where the source
// is finer than the picture; all other planes take the nearest source pixel and are never blended.
// With a moving entrance pupil the source pixel is the one that shows the point which the pixel's
// own ray meets, found from the source's depth; what the pupil's own place uncovers is not.
class LensTile {
public:
  // Pixels x to x + width - 1, y to y + height - 1 of the picture.
  LensTile(const SourceViews& views, const LensModel& lens, const LensWishes& wishes, int x, int y,
           int width, int height);

  // The blocks that it needs. They need depth for depth, range and a moving pupil.
  const std::set<SourceViews::Block>& Blocks() const { return this->Blocks_; }
  bool NeedsDepth() const;
  // Each needed block once, in any order.
  void Take(const SourceViews::Block& block, const LensPlanes& from);

  const LensPlanes& Planes() const { return this->Planes_; }
  std::uint64_t WithoutRay() const { return this->WithoutRay_; } // pixels
  // The farthest that a moving pupil moved a pixel's place in a source view [source pixels], and
  // pixels whose place left the block that was drawn for it and stayed at its edge.
  double PupilPixels() const { return this->PupilPixels_; }
  std::uint64_t Beyond() const { return this->Beyond_; }

private:
  struct Pixel {
    SourceViews::Place place;
    LensRay ray;
    float footprint = 1.0f; // source pixels
  };
  void Follow(Pixel& pixel, const SourceViews::View& view, const LensPlanes& from);
  void PutRadiance(std::size_t at, const Pixel& pixel, const SourceViews::View& view,
                   const LensPlanes& from);

  const SourceViews& Views_;
  LensWishes Wishes_;
  bool Moves_;
  std::set<SourceViews::Block> Blocks_;
  std::vector<Pixel> Pixels_;
  LensPlanes Planes_;
  std::uint64_t WithoutRay_ = 0;
  std::uint64_t Beyond_ = 0;
  double PupilPixels_ = 0.0;
};

} // namespace dspace

#endif
