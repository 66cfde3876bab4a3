// Where the pixels of a part of a picture lie in the source views.
#ifndef DSPACE_CAMERA_SAMPLING_LENS_MAP_H
#define DSPACE_CAMERA_SAMPLING_LENS_MAP_H

#include <cstdint>
#include <map>
#include <vector>

#include <dspace/camera/sampling/SourceViews.h>

namespace dspace {

// Depends on the lens alone, and serves every picture that is taken through it. Immutable.
class LensMap {
public:
  struct Pixel {
    SourceViews::Place place; // of the ray's direction; face < 0: the pixel has no ray
    LensRay ray;              // in the camera's axes
    float footprint = 1.0f;   // source pixels across a pixel of the picture
  };

  // The same of a pixel that is in a block, from the first pixel of the block's view.
  struct Sample {
    std::uint32_t at; // in Pixels()
    float x, y;
    float footprint;
  };

  // Pixels x to x + width - 1, y to y + height - 1 of the picture.
  LensMap(const SourceViews& views, const LensModel& lens, int x, int y, int width, int height);

  int Width() const { return this->Width_; }
  int Height() const { return this->Height_; }
  bool MovesPupil() const { return this->Moves_; }
  const std::vector<Pixel>& Pixels() const { return this->Pixels_; } // rows from the top
  // The pixels of each block that has some.
  const std::map<SourceViews::Block, std::vector<Sample>>& Blocks() const { return this->Blocks_; }
  std::uint64_t WithoutRay() const { return this->WithoutRay_; } // pixels
  std::size_t Bytes() const;

private:
  int Width_;
  int Height_;
  bool Moves_;
  std::vector<Pixel> Pixels_;
  std::map<SourceViews::Block, std::vector<Sample>> Blocks_;
  std::uint64_t WithoutRay_ = 0;
};

} // namespace dspace

#endif
