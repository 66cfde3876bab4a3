// Single posts of level 0 with one patch on them, and bounds of their blocks. Not for public
// headers.
#ifndef DSPACE_TERRAIN_PATCHPROBE_H
#define DSPACE_TERRAIN_PATCHPROBE_H

#include <array>
#include <cstdint>
#include <memory>

#include <dspace/groups/PatchPlace.h>
#include <dspace/posts/PostProbe.h>

namespace dspace {

class Patch;

class PatchProbe {
public:
  // `patch` has a place in a lattice and must outlive this.
  explicit PatchProbe(const Patch& patch);
  ~PatchProbe();
  PatchProbe(PatchProbe&&) noexcept;

  // False where only blocks are read: its own coarser posts are blended.
  static bool Reads(const Patch& patch);

  // As Patch::Blend for one post without a mask: what it adds, and how much of that counts. Weight
  // 0 where it adds nothing.
  struct Share {
    double weight = 0.0;
    double height = 0.0; // [m]
  };
  Share At(std::int64_t column, std::int64_t row);

  // Least and greatest heights [m] of patch and weights over a block of 2^bits cells, (c, r) of
  // such; bits <= Bits. Least above greatest: it has no height there.
  struct Bounds {
    std::array<double, 2> heights;
    std::array<double, 2> weights;
  };
  static constexpr int Bits = 9; // those of PatchPlace::SquareSize
  Bounds Over(int bits, std::int64_t c, std::int64_t r);

private:
  const PatchPlace::Corners& CornersAbout(std::int64_t column, std::int64_t row);
  Eigen::AlignedBox2d PixelsOver(std::int64_t column, std::int64_t row, std::int64_t size);
  std::array<double, 2> HeightsIn(const Eigen::AlignedBox2d& pixels, bool& holed);

  const Patch& Patch_;
  std::unique_ptr<PostProbe> Posts_; // its own
  std::array<PatchPlace::Corners, 4> Corners_;
};

} // namespace dspace

#endif
