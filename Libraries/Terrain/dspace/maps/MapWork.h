// Works through the tiles of a map on several threads.
#ifndef DSPACE_MAPS_MAP_WORK_H
#define DSPACE_MAPS_MAP_WORK_H

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include <dspace/maps/TileFile.h>

namespace dspace {

struct MapProgress {
  double fraction = 0.0;     // 0 to 1
  double elapsed = 0.0;      // [s] of this run
  double left = 0.0;         // [s], estimated; infinity before the first result
  std::uint64_t resumed = 0; // tiles that an earlier run had made
};

struct MapControl {
  int threads = 0;      // 0: as many as the processor runs at once; 1 to 256
  bool replace = false; // TileFile
  // Called by the calling thread ten times a second and at the end. False ends the work: what is
  // done stays in the partial file.
  std::function<bool(const MapProgress&)> progress;
};

// Fills the tiles that `file` lacks and finishes it: `make` computes the tile (column, row), bands
// after bands, and may give up where `stop` becomes true (the tile does not count then). Returns
// false if progress ended it. Throws the first error of any thread, and Error(InvalidArgument) for
// threads out of range.
using MakeTile = std::function<void(int column, int row, std::vector<float>& cells,
                                    const std::atomic<bool>& stop)>;
bool FillTiles(TileFile& file, std::size_t bands, const MapControl& control, const MakeTile& make);

} // namespace dspace

#endif
