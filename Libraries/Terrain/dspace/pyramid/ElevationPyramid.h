// Tiles of a post source in memory, under a byte budget, read by threads of its own.
#ifndef DSPACE_TERRAIN_ELEVATIONPYRAMID_H
#define DSPACE_TERRAIN_ELEVATIONPYRAMID_H

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <dspace/posts/PostSource.h>

namespace dspace {

struct ElevationPyramidOptions {
  std::size_t byteBudget = std::size_t(256) << 20; // at least 4 MiB
  int threads = 2;                                 // 1 to 64
  double retryDelay = 0.5;                         // [s] after a failed read; doubles up to 30 s
  int attempts = 3; // failed reads of a tile before a waiting read gives up
};

struct ElevationPyramidStatistics {
  std::size_t bytes = 0;     // of tiles in memory
  std::uint64_t loads = 0;   // tiles read so far
  std::uint64_t patches = 0; // parts of tiles read again after a change
  std::uint64_t evictions = 0;
  std::uint64_t failures = 0; // reads that failed, each attempt counted
  std::size_t pending = 0;    // tiles asked for and not there yet
  std::string lastFailure;    // its message; empty without any
};

// What changed up to a moment, in posts of level 0.
struct PyramidChanges {
  std::uint64_t stamp = 0; // of that moment
  std::vector<PostRectangle> rectangles;
};

// What a drawing thread asks is answered at once, from memory, or not; what is missing is then on
// its way. Captures, queries and analyses wait. Any thread may call.
class ElevationPyramid {
public:
  static constexpr int TileSize = 128; // posts a side

  // Throws Error(InvalidArgument) for an option out of range.
  explicit ElevationPyramid(std::shared_ptr<const PostSource> source,
                            const ElevationPyramidOptions& options = {});
  ElevationPyramid(const ElevationPyramid&) = delete;
  ElevationPyramid& operator=(const ElevationPyramid&) = delete;
  ~ElevationPyramid(); // waits for reads under way

  const PostSource& Source() const { return *this->Source_; }
  const PostLattice& Lattice() const { return this->Source_->GetLattice(); }

  // The block as PostSource::Read gives it, from tiles in memory. False, and nothing written, where
  // one is missing: it is then asked for, latest requests first and of them the coarsest.
  bool TryRead(const PostBlock& block, float* heights);
  // The same, and nothing is asked for.
  bool ReadHeld(const PostBlock& block, float* heights);
  // Reads what is missing first. Throws Error: what the last of the failed attempts threw;
  // DeadlineExceeded when `seconds` ran out.
  void Read(const PostBlock& block, float* heights,
            double seconds = std::numeric_limits<double>::infinity());

  // The same, and into `tracks` what PostSource::ReadWithTracks gives, 0 where none is.
  bool TryRead(const PostBlock& block, float* heights, float* tracks);
  void Read(const PostBlock& block, float* heights, float* tracks, double seconds);

  // The source gives other posts in these rectangles of level 0 from now on: what is in memory of
  // them is read again when it is asked for, and a read under way does not bring the old ones back.
  void Invalidate(const std::vector<PostRectangle>& rectangles);
  // Of all calls of Invalidate since `stamp`; all of the lattice where that is long ago.
  PyramidChanges Changes(std::uint64_t since) const;
  // The stamp that Changes() would give, without waiting for anything.
  std::uint64_t LatestChange() const;

  // Grows with each tile that arrives and with each change.
  std::uint64_t Arrivals() const;
  ElevationPyramidStatistics Statistics() const;

private:
  struct Implementation;
  std::shared_ptr<const PostSource> Source_;
  std::unique_ptr<Implementation> Impl_;
};

} // namespace dspace

#endif
