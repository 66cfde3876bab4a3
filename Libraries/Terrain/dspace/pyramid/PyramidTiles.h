// Arithmetic of a pyramid's tiles: blocks cut at their borders, and what a change touches.
#ifndef DSPACE_TERRAIN_PYRAMIDTILES_H
#define DSPACE_TERRAIN_PYRAMIDTILES_H

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include <dspace/pyramid/ElevationPyramid.h>

namespace dspace {

inline constexpr int PyramidTileSize = ElevationPyramid::TileSize; // posts a side

using TileKey = std::array<std::int64_t, 3>; // level, tile column, tile row

// Posts of a tile: columns left..right-1, rows top..bottom-1 of it.
struct TileBox {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;
  bool Empty() const { return this->left >= this->right || this->top >= this->bottom; }
  bool Meets(const TileBox& o) const;
  void Widen(const TileBox& by); // to hold both
};

// A rectangle of a block that lies in one tile.
struct TilePiece {
  TileKey key;
  TileBox box;
  int column; // of its first post in the block
  int row;
};

// The block cut at tile borders and, where the lattice is periodic, at its ends. What lies outside
// the lattice is in no piece.
std::vector<TilePiece> CutIntoTiles(const PostLattice& lattice, const PostBlock& block);

// The part of a tile that a change touches, given as posts of the tile's level (PostsTouched).
TileBox TouchedOfTile(const PostLattice& lattice, const PostRectangle& posts, const TileKey& key);

// Rows of posts; the second plane is empty where nothing is rolled over.
struct PyramidTile {
  std::vector<float> heights;
  std::vector<float> tracks;
  std::size_t Bytes() const { return (this->heights.size() + this->tracks.size()) * sizeof(float); }
};

struct PostPlanes {
  float* heights;
  float* tracks; // null: not asked for
};

// The posts of a box of a tile, copied from `old` elsewhere; that is null for all of a tile.
std::shared_ptr<const PyramidTile> ReadPyramidTile(const PostSource& source, const TileKey& key,
                                                   const TileBox& box, const PyramidTile* old);

// Into a block of `blockWidth` posts a row.
void CopyPiece(const PyramidTile& tile, const TilePiece& piece, int blockWidth,
               const PostPlanes& planes);

// The latest changes, each with its number.
class PyramidChangeLog {
public:
  void Add(const PostRectangle& rectangle);
  std::uint64_t Latest() const { return this->Latest_; } // its number; 0 before all
  PyramidChanges Since(std::uint64_t stamp, const PostLattice& lattice) const;

private:
  std::uint64_t Latest_ = 0;
  std::deque<std::pair<std::uint64_t, PostRectangle>> Log_; // latest last
};

} // namespace dspace

#endif
