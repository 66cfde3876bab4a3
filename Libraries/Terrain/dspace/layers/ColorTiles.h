// Composes and caches tiles of a stack of layers, colours and normals apart, in its own threads,
// under a byte budget.
#ifndef DSPACE_LAYERS_COLORTILES_H
#define DSPACE_LAYERS_COLORTILES_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <dspace/layers/LayerStack.h>

namespace dspace {

struct ColorTilesOptions {
  std::size_t byteBudget = std::size_t(192) << 20; // at least 16 MiB
  int threads = 2;                                 // 1 to 64
  double retryDelay = 0.5;                         // [s] after a failed read; doubles up to 30 s
  int attempts = 3; // failed reads of a tile before a waiting call gives up
};

struct ColorTilesStatistics {
  std::size_t bytes = 0;     // of tiles in memory: the layers' own and composed ones
  std::size_t keptBytes = 0; // of files that are decoded as a whole, beside these
  std::uint64_t reads = 0;   // of one tile of one layer
  std::uint64_t compositions = 0;
  std::uint64_t failures = 0;
  std::size_t pending = 0;
  std::string lastFailure; // its message; empty without any
};

// TryGet() is for drawing threads and returns at once; Get() is for captures and waits. After a
// change of the stack, tiles are composed again from the layers' tiles in memory, without reading.
// Any thread may call.
class ColorTiles {
public:
  static constexpr int Side = ColorGrid::TileTexels + 2; // a texel of border all around

  struct Tile {
    std::uint64_t revision = 0; // of the stack that it shows
    // Side x Side texels of four bytes, top row first: opacity times the root of each colour in
    // linear light, then opacity. Interpolated, the first one's square over the second is linear
    // light times opacity, right between colours of one opacity and towards transparency; a
    // software renderer takes half of the time of sRGB textures for it. Empty where all of it is
    // transparent. Of LayerChoice::Part::Normals: NormalTexels, eight bytes.
    std::vector<std::uint8_t> texels;
  };
  using TilePointer = std::shared_ptr<const Tile>;

  // Throws Error(InvalidArgument) for an option out of range.
  ColorTiles(std::shared_ptr<const LayerStack> stack, std::vector<ColorGrid> grids,
             const ColorTilesOptions& options = {});
  ColorTiles(const ColorTiles&) = delete;
  ColorTiles& operator=(const ColorTiles&) = delete;
  ~ColorTiles(); // waits for reads under way

  const LayerStack& Stack() const;
  const std::vector<ColorGrid>& Grids() const;

  // The number of a composition, for the functions below; it stays the same. 0: all layers. Several
  // compositions of one tile are kept beside each other, under the one budget.
  int CompositionOf(const LayerChoice& choice);

  // Returns one entry per requested tile, in order of priority: the tile in memory, of this or an
  // earlier revision; null if there is none. Missing and outdated tiles are requested. Requests of
  // earlier calls that are not among these are served later.
  std::vector<TilePointer> TryGet(const std::vector<ColorTile>& tiles, int composition = 0);
  // Returns all tiles, of the revision at the time of the call or a later one. Throws the error of
  // the last failed attempt, or Error(DeadlineExceeded) after `seconds`.
  std::vector<TilePointer> Get(const std::vector<ColorTile>& tiles, double seconds,
                               int composition = 0);

  // Increases with each loaded tile and with each change of the stack.
  std::uint64_t Arrivals() const;
  ColorTilesStatistics Statistics() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Impl_;
};

} // namespace dspace

#endif
