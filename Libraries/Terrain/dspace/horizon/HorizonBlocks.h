// Sweeps blocks of posts in its own threads, and keeps them.
#ifndef DSPACE_TERRAIN_HORIZONBLOCKS_H
#define DSPACE_TERRAIN_HORIZONBLOCKS_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <dspace/horizon/HorizonSweep.h>

namespace dspace {

// Elevations [rad] of the horizon at Side x Side posts, row by row; -pi / 2 where nothing is in
// sight, NaN where a post has no data.
struct HorizonBlock {
  std::vector<float> all;
  std::vector<float> distant;
};

// Blocks stand at fixed places of a level, and azimuths are whole multiples of StepDegrees: a Sun
// that moves, and a camera that moves, find most of what they need. TryGet() is for drawing threads
// and returns at once; Get() is for pictures that are kept and waits. Where posts change in the
// pyramid, the blocks that have read them are swept again. Any thread may call.
class HorizonBlocks {
public:
  static constexpr int Side = 32;
  static constexpr double StepDegrees = 0.25;
  static constexpr int Around = 1440; // azimuths

  using Key = std::array<std::int64_t, 4>; // level, column and row of blocks, 0 <= azimuth < Around
  using Pointer = std::shared_ptr<const HorizonBlock>;

  // `threads`: 1 to 64. `most`: blocks that are kept (10 KB each), at least 64; more while one call
  // needs more. Throws Error(InvalidArgument).
  explicit HorizonBlocks(HorizonSweep sweep, int threads = 2, std::size_t most = 8192);
  HorizonBlocks(const HorizonBlocks&) = delete;
  HorizonBlocks& operator=(const HorizonBlocks&) = delete;
  ~HorizonBlocks(); // waits for sweeps under way

  const HorizonSweep& Sweep() const;

  // An entry a key, in order of priority: the block, which may be older than a change of its posts,
  // or null. Missing and outdated ones are requested, outdated ones at most twice a second;
  // requests of earlier calls that are not among these are served later.
  std::vector<Pointer> TryGet(const std::vector<Key>& keys);
  // All of them, as the posts are now. Throws what HorizonSweep::Sweep throws, or
  // Error(DeadlineExceeded) after `seconds`.
  std::vector<Pointer> Get(const std::vector<Key>& keys, double seconds);

  // Increases with each block that was swept, and with each change in the pyramid.
  std::uint64_t Arrivals() const;
  std::uint64_t Sweeps() const; // so far

private:
  struct Implementation;
  std::unique_ptr<Implementation> Impl_;
};

} // namespace dspace

#endif
