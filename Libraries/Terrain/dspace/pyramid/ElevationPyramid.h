// Caches tiles of a post source in memory under a byte budget. Its own threads read them.
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
  std::size_t pending = 0;    // tiles requested and not loaded yet
  std::string lastFailure;    // its message; empty without any
};

// Changes up to a stamp, in posts of level 0.
struct PyramidChanges {
  std::uint64_t stamp = 0; // of that moment
  std::vector<PostRectangle> rectangles;
};

// TryRead() is for drawing threads: it returns at once and requests missing tiles. Read() is for
// captures, queries and analyses: it waits. Any thread may call.
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

  // Reads the block as PostSource::Read does, from tiles in memory. Returns false, and writes
  // nothing, if a tile is missing; it is then requested. Later requests are served first, of one
  // call the coarsest tiles first.
  bool TryRead(const PostBlock& block, float* heights);
  // The same without requesting missing tiles.
  bool ReadHeld(const PostBlock& block, float* heights);
  // Waits for missing tiles. Throws the error of the last failed attempt, or
  // Error(DeadlineExceeded) after `seconds`.
  void Read(const PostBlock& block, float* heights,
            double seconds = std::numeric_limits<double>::infinity());

  // The same, and writes to `tracks` the result of PostSource::ReadWithTracks, 0 without tracks.
  bool TryRead(const PostBlock& block, float* heights, float* tracks);
  void Read(const PostBlock& block, float* heights, float* tracks, double seconds);

  // Call after the source's posts have changed in these rectangles of level 0. Tiles in memory are
  // read again on demand, and a running read does not store old posts.
  void Invalidate(const std::vector<PostRectangle>& rectangles);
  // Rectangles of all calls of Invalidate since `since`; the whole lattice if that is too long ago.
  PyramidChanges Changes(std::uint64_t since) const;
  // The stamp that Changes() would return. Does not wait.
  std::uint64_t LatestChange() const;

  // Increases with each loaded tile and with each change.
  std::uint64_t Arrivals() const;
  ElevationPyramidStatistics Statistics() const;

private:
  struct Implementation;
  std::shared_ptr<const PostSource> Source_;
  std::unique_ptr<Implementation> Impl_;
};

} // namespace dspace

#endif
