// The samples of one channel, for plots.
#ifndef DSPACE_WIDGETS_SAMPLE_SERIES_H
#define DSPACE_WIDGETS_SAMPLE_SERIES_H

#include <array>
#include <cstddef>
#include <deque>
#include <limits>
#include <memory>
#include <vector>

namespace dspace::widgets {

// NaN equals NaN.
inline bool SameValue(double a, double b) {
  return a == b || (a != a && b != b);
}

// The least and the greatest value of some samples. NaN samples do not count; without any other
// sample both are NaN.
struct SampleExtent {
  double min = std::numeric_limits<double>::quiet_NaN();
  double max = std::numeric_limits<double>::quiet_NaN();

  void Add(double value) { // NaN changes nothing
    if (value < this->min || this->min != this->min) {
      this->min = value;
    }
    if (value > this->max || this->max != this->max) {
      this->max = value;
    }
  }
};

// The samples [begin, end) of one pixel column.
struct SampleColumn {
  std::size_t begin = 0;
  std::size_t end = 0; // begin: there are none, and all values are NaN
  SampleExtent extent;
  double first = std::numeric_limits<double>::quiet_NaN(); // may be a sample that is NaN
  double last = std::numeric_limits<double>::quiet_NaN();
};

// Times and values in the order of time. Samples may share a time; NaN is a gap.
// It keeps the least and greatest value of each 16, 256, 4096, ... samples, so that an interval of
// any length costs some hundred steps. A sample takes 17 bytes.
// A copy is cheap: it shares the memory of the samples, which change in neither. One thread may
// append while another reads a copy that was made before.
class SampleSeries {
public:
  // Throws Error(InvalidArgument) and changes nothing for a time that is not finite or before that
  // of the last sample, and for an infinite value.
  void Append(double time_s, double value);
  // Removes all samples at and after a time.
  void RemoveFrom(double time_s);
  void Clear();

  std::size_t Size() const { return this->Size_; }
  bool IsEmpty() const { return this->Size_ == 0; }
  // Of sample i, below Size(), which is not checked.
  double Time(std::size_t i) const { return this->Chunks_[i / Chunk]->times[i % Chunk]; }
  double Value(std::size_t i) const { return this->Chunks_[i / Chunk]->values[i % Chunk]; }

  // The first sample at or after a time; Size(): there is none.
  std::size_t Lower(double time_s) const;
  // The first sample after a time; Size(): there is none.
  std::size_t Upper(double time_s) const;

  // Of the samples [begin, end), both up to Size().
  SampleExtent Extent(std::size_t begin, std::size_t end) const;
  // The interval from `from` to `to`, split into columns of equal width. Column c has the samples
  // from Edge(from, to, columns, c) up to, but without, those at the next edge; the last column has
  // those at `to`, too. All values are exact. Throws Error(InvalidArgument) unless from < to, both
  // and their distance finite, and 1 <= columns <= 1,000,000.
  std::vector<SampleColumn> Decimate(double from, double to, int columns) const;
  static double Edge(double from, double to, int columns, int column);

  // The value at a time: that of a sample there (the last of several), else on the straight line
  // between its neighbours or, if values hold until they change, that of the sample before. NaN
  // before the first sample, after the last (unless values hold), and beside a gap.
  double At(double time_s, bool hold) const;

private:
  static constexpr std::size_t Chunk = 4096; // samples
  static constexpr std::size_t Block = 16;   // of one level in a block of the next
  struct Samples {
    std::array<double, Chunk> times;
    std::array<double, Chunk> values;
  };
  void Gather(std::size_t level, std::size_t begin, std::size_t end, SampleExtent& all) const;

  std::vector<std::shared_ptr<Samples>> Chunks_;
  std::vector<std::deque<SampleExtent>> Levels_; // complete blocks
  std::size_t Size_ = 0;
};

} // namespace dspace::widgets

#endif
