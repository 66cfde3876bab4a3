// Wheel tracks: ruts as lines of contacts with a spatial index, under a byte budget.
#ifndef DSPACE_TERRAIN_WHEELTRACKS_H
#define DSPACE_TERRAIN_WHEELTRACKS_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <dspace/tracks/TrackChart.h>
#include <dspace/tracks/TrackDraft.h>
#include <dspace/tracks/TrackSegment.h>
#include <dspace/tracks/TrackStroke.h>

namespace dspace {

struct TrackAddition : TrackStroke {
  bool begin = false; // starts a new stroke; else continues the wheel's latest one, if any
  bool exact = false; // all contacts are kept
};

// A changed area and the width of its ruts.
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
  // Budget for all stored data: 33 bytes a contact, 16 to 32 more for the index, 96 per square of 2
  // m that is rolled over, 4 kB a stroke. That is some 180 bytes per metre of one wheel straight
  // ahead, some 400 in a curve of 5 m radius: 64 MiB hold 25 km of a vehicle with six wheels.
  std::size_t byteBudget = std::size_t(64) << 20; // at least 64 KiB
  // Contacts that lie on the line between others within this tolerance are omitted [m]: place,
  // sinkage and distance rolled. Headings then depart by at most half a degree, and no line is
  // longer than 1 m.
  double tolerance = 1e-3;
};

// Any thread may call. Where ruts overlap, the deepest counts; where only their rims do, the rim of
// the nearest rut. The order of ruts does not matter.
class WheelTracks {
public:
  // `name` is for messages. Throws Error(InvalidArgument) for an option out of range.
  explicit WheelTracks(std::string name, const WheelTracksOptions& options = {});

  // Adds all of them or, on an error, none. Throws Error: InvalidArgument for a value out of range,
  // Resource if the budget is used up. A stroke that continues with another profile becomes a new
  // one, which begins at the end of the old one.
  std::vector<TrackReach> Add(const std::vector<TrackAddition>& additions);
  std::vector<TrackReach> Clear();
  // Adds strokes from Strokes() of this or another object, exactly. With the same tolerance, later
  // additions give the same result as in the original. The strokes come after existing ones.
  // `continues`: the first one continues the last existing stroke, which has the same name and
  // profile. They need the same budget as in the original. Throws as Add.
  std::vector<TrackReach> Restore(const std::vector<TrackStroke>& strokes, bool continues = false);

  // On a body: the chart that places are in, whose scale ruts, lengths and distances rolled follow.
  // Only where there are no tracks; null: a plane.
  void SetChart(std::shared_ptr<const TrackChart> chart);
  std::shared_ptr<const TrackChart> Chart() const;

  bool Empty() const;
  TrackStatistics Statistics() const;
  std::size_t StrokeCount() const;
  // As stored, in the order in which they began, from index `first` on.
  std::vector<TrackStroke> Strokes(std::size_t first = 0) const;
  // Whether a rut may reach into a box. Conservative by some metres or, for large boxes, by their
  // size.
  bool Reaches(const Eigen::AlignedBox2d& box) const;
  // Bounds of the change of heights by ruts [m]: downwards (at most 0) and upwards.
  std::array<double, 2> Changes() const;
  // Segments that reach into a box, of ruts at least `width` wide, in a reproducible order.
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
  double ScaleAt(double x, double y) const;
  TrackSegment SegmentOf(const Stroke& stroke, std::size_t index) const;
  TrackSegment SegmentOf(const TrackProfile& profile, const KeptContact& from,
                         const KeptContact& to) const;
  std::size_t CostOf(const TrackDraft& draft, std::unordered_set<Cell>& taken) const;
  void RequireBudget(std::size_t cost) const;
  void Commit(TrackDraft& draft, std::vector<TrackReach>& changed);
  void Forget(std::uint64_t entry, const Eigen::AlignedBox2d& box);
  void AllocateSquares(Cell cell);
  void ReleaseSquares(Cell cell);

  std::string Name_;
  WheelTracksOptions Options_;
  mutable std::mutex Mutex_; // of what follows
  std::shared_ptr<const TrackChart> Chart_;
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
