// What wheels have rolled over: ruts as lines of contacts, found by place, under a byte budget.
#ifndef DSPACE_TERRAIN_WHEELTRACKS_H
#define DSPACE_TERRAIN_WHEELTRACKS_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <dspace/tracks/TrackDraft.h>
#include <dspace/tracks/TrackSegment.h>
#include <dspace/tracks/TrackStroke.h>

namespace dspace {

struct TrackAddition : TrackStroke {
  bool begin = false; // a new stroke; else the wheel's latest one goes on, where there is one
  bool exact = false; // all contacts are kept
};

// What changed, and how wide the ruts there are.
struct TrackReach {
  Eigen::AlignedBox2d box;
  double width = 0.0; // [m], rims included
};

struct TrackStatistics {
  std::size_t bytes = 0;
  std::size_t strokes = 0;
  std::size_t contacts = 0; // that are kept
  double length = 0.0;      // [m] of all strokes
};

struct WheelTracksOptions {
  // All that is kept is counted: 33 bytes a contact, 16 to 32 more for finding it, 96 a square of
  // 2 m that is rolled over, 4 kB a stroke. Straight ahead that is some 180 bytes a metre of one
  // wheel, in a curve of 5 m radius some 400: 64 MiB hold 25 km of a vehicle with six wheels.
  std::size_t byteBudget = std::size_t(64) << 20; // at least 64 KiB
  // Contacts that lie on the line between others to this are left out [m]: place, sinkage and
  // distance rolled. Then headings depart by at most half a degree, and no line is longer than 1 m.
  double tolerance = 1e-3;
};

// Any thread may call. Where ruts overlap the deepest counts, and where only their rims do the one
// of the nearest: their order does not matter.
class WheelTracks {
public:
  // `name` is for messages. Throws Error(InvalidArgument) for an option out of range.
  explicit WheelTracks(std::string name, const WheelTracksOptions& options = {});

  // All of them or, with an Error, none: InvalidArgument for a value that is not accepted, Resource
  // when the budget is used up. A stroke that goes on with another profile is a new one that begins
  // where the old one ends.
  std::vector<TrackReach> Add(const std::vector<TrackAddition>& additions);
  std::vector<TrackReach> Clear();
  // Strokes as Strokes() gives them, of these or of other tracks: to the bit, and what is added
  // later is kept as it would be there, if the tolerance is the same. They come after those that
  // there are; `continues`: the first goes on with the last of these, of the same name and profile.
  // They need what they need there and no more. Throws as Add.
  std::vector<TrackReach> Restore(const std::vector<TrackStroke>& strokes, bool continues = false);

  bool Empty() const;
  TrackStatistics Statistics() const;
  std::size_t StrokeCount() const;
  // As they are kept, in the order in which they were begun; without the first ones.
  std::vector<TrackStroke> Strokes(std::size_t first = 0) const;
  // Whether anything may reach into a box; true more often than that, by some metres or, for large
  // boxes, by their size.
  bool Reaches(const Eigen::AlignedBox2d& box) const;
  // By how much ruts change heights at most [m]: downwards (at most 0) and upwards.
  std::array<double, 2> Changes() const;
  // What reaches into a box, of ruts at least `width` wide; in no order that depends on time.
  std::vector<TrackSegment> Near(const Eigen::AlignedBox2d& box, double width = 0.0) const;

private:
  struct Stroke {
    std::string name;
    TrackProfile profile;
    std::deque<KeptContact> contacts;
    std::vector<KeptContact> skipped; // since the last but one
  };
  using Cell = std::uint64_t;

  static TrackContact Whole(const KeptContact& contact);
  TrackDraft Begin(const TrackAddition& addition) const;
  TrackSegment SegmentOf(const Stroke& stroke, std::size_t index) const;
  std::size_t CostOf(const TrackDraft& draft, std::unordered_set<Cell>& taken) const;
  void RequireBudget(std::size_t cost) const;
  void Commit(TrackDraft& draft, std::vector<TrackReach>& changed);
  void Forget(std::uint64_t entry, const Eigen::AlignedBox2d& box);
  void AllocateSquares(Cell cell);
  void ReleaseSquares(Cell cell);

  std::string Name_;
  WheelTracksOptions Options_;
  mutable std::mutex Mutex_; // of what follows
  std::vector<Stroke> Strokes_;
  std::map<std::string, std::size_t> Latest_;                  // of a name
  std::unordered_map<Cell, std::vector<std::uint64_t>> Cells_; // stroke << 32 | first contact
  // Squares that hold any such cells, each 8 times as wide as those before it, with how many cells
  // or lesser squares they hold; in a cell's price.
  std::array<std::unordered_map<Cell, std::uint32_t>, 10> Squares_;
  std::array<double, 2> Changes_ = {0.0, 0.0};
  std::size_t Bytes_ = 0;
};

} // namespace dspace

#endif
