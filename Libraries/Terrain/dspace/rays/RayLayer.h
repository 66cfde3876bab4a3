// A surface as rays follow it: its tiles, and the heights that its blocks lie between.
#ifndef DSPACE_TERRAIN_RAYLAYER_H
#define DSPACE_TERRAIN_RAYLAYER_H

#include <functional>
#include <memory>

#include <dspace/pyramid/PostSurface.h>
#include <dspace/rays/RayTiles.h>

namespace dspace {

class RayLayer {
public:
  // State of one ray in a layer: its latest tile and the remaining time.
  struct Hold {
    std::shared_ptr<const RayTile> tile;
    std::function<double()> remaining; // [s]
  };

  // Keeps a reference to `surface`, which must outlive it.
  explicit RayLayer(const PostSurface& surface)
      : Surface_(surface), Tiles_(surface.SharedPyramid()) {}

  const PostSurface& Surface() const { return this->Surface_; }
  // A tile has 2^Bits() cells of level 0 a side.
  int Bits() const { return RayTile::Bits + this->Surface_.Level(); }
  void Refresh() { this->Tiles_.Refresh(); }
  // (c, r) counts tiles. Throws what the pyramid's Read() throws, as the next one.
  const RayTile& TileOf(Hold& hold, std::int64_t c, std::int64_t r);
  // Of a block of 2^bits cells of level 0, bits <= Bits(); (c, r) counts such blocks.
  RayTile::Range RangeOf(Hold& hold, int bits, std::int64_t c, std::int64_t r);

private:
  const PostSurface& Surface_;
  RayTiles Tiles_;
};

} // namespace dspace

#endif
