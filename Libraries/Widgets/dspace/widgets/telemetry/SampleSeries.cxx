#include <dspace/widgets/telemetry/SampleSeries.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <dspace/Checks.h>

namespace dspace::widgets {
namespace {

constexpr int MostColumns = 1000000;
constexpr double None = std::numeric_limits<double>::quiet_NaN();

// As NumberText, with all digits: times of a long mission differ in the last ones.
std::string ExactText(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

} // namespace

void SampleSeries::Append(double time_s, double value) {
  RequireFinite("samples", "a time", time_s);
  if (std::isinf(value)) {
    Reject("samples",
           "a value is " + NumberText(value) + "; accepted: a finite number, or NaN for a gap");
  }
  if (this->Size_ > 0 && time_s < this->Time(this->Size_ - 1)) {
    Reject("samples", "a time is " + ExactText(time_s) + "; accepted: at least that of the last " +
                          "sample, " + ExactText(this->Time(this->Size_ - 1)));
  }
  if (this->Size_ == this->Chunks_.size() * Chunk) {
    this->Chunks_.push_back(std::make_shared<Samples>());
  }
  Samples& samples = *this->Chunks_.back();
  samples.times[this->Size_ % Chunk] = time_s;
  samples.values[this->Size_ % Chunk] = value;
  ++this->Size_;
  std::size_t blocks = this->Size_;
  for (std::size_t level = 0; blocks % Block == 0; ++level) {
    SampleExtent extent;
    for (std::size_t i = blocks - Block; i < blocks; ++i) {
      if (level == 0) {
        extent.Add(this->Value(i));
      } else {
        extent.Add(this->Levels_[level - 1][i].min);
        extent.Add(this->Levels_[level - 1][i].max);
      }
    }
    if (level == this->Levels_.size()) {
      this->Levels_.emplace_back();
    }
    this->Levels_[level].push_back(extent);
    blocks /= Block;
  }
}

void SampleSeries::RemoveFrom(double time_s) {
  const std::size_t size = this->Lower(time_s);
  if (size == this->Size_) {
    return;
  }
  this->Size_ = size;
  this->Chunks_.resize((size + Chunk - 1) / Chunk);
  if (size % Chunk != 0) { // a copy of the series may still read what was removed
    auto& last = this->Chunks_.back();
    last = std::make_shared<Samples>(*last);
  }
  std::size_t blocks = size;
  for (auto& level : this->Levels_) {
    blocks /= Block;
    level.resize(blocks);
  }
}

void SampleSeries::Clear() {
  *this = {};
}

std::size_t SampleSeries::Lower(double time_s) const {
  std::size_t low = 0;
  std::size_t high = this->Size_;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (this->Time(middle) < time_s) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

std::size_t SampleSeries::Upper(double time_s) const {
  std::size_t low = 0;
  std::size_t high = this->Size_;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (this->Time(middle) <= time_s) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

// Level 0 has the samples themselves, level n + 1 the blocks of Levels_[n].
void SampleSeries::Gather(std::size_t level, std::size_t begin, std::size_t end,
                          SampleExtent& all) const {
  const auto add = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      if (level == 0) {
        all.Add(this->Value(i));
      } else {
        all.Add(this->Levels_[level - 1][i].min);
        all.Add(this->Levels_[level - 1][i].max);
      }
    }
  };
  const std::size_t first = (begin + Block - 1) / Block;
  const std::size_t last = end / Block;
  if (first >= last) {
    add(begin, end);
    return;
  }
  add(begin, first * Block);
  this->Gather(level + 1, first, last, all);
  add(last * Block, end);
}

SampleExtent SampleSeries::Extent(std::size_t begin, std::size_t end) const {
  SampleExtent all;
  this->Gather(0, begin, std::min(end, this->Size_), all);
  return all;
}

double SampleSeries::Edge(double from, double to, int columns, int column) {
  return column >= columns ? to : std::min(from + (to - from) * (double(column) / columns), to);
}

std::vector<SampleColumn> SampleSeries::Decimate(double from, double to, int columns) const {
  if (!std::isfinite(from) || !(from < to) || !std::isfinite(to - from)) {
    Reject("samples", "an interval is " + ExactText(from) + " to " + ExactText(to) +
                          "; accepted: finite, and not empty");
  }
  Require(columns >= 1 && columns <= MostColumns, "samples", "the number of columns", columns,
          "1 to 1,000,000");
  std::vector<SampleColumn> all(static_cast<std::size_t>(columns));
  std::size_t begin = this->Lower(from);
  for (int c = 0; c < columns; ++c) {
    SampleColumn& column = all[std::size_t(c)];
    column.begin = begin;
    column.end = begin;
    if (begin < this->Size_ || c == 0) {
      column.end = c + 1 == columns ? this->Upper(to) : this->Lower(Edge(from, to, columns, c + 1));
    }
    if (column.begin < column.end) {
      column.extent = this->Extent(column.begin, column.end);
      column.first = this->Value(column.begin);
      column.last = this->Value(column.end - 1);
    }
    begin = column.end;
  }
  return all;
}

double SampleSeries::At(double time_s, bool hold) const {
  const std::size_t after = this->Upper(time_s);
  if (after == 0) {
    return None;
  }
  const double value = this->Value(after - 1);
  const double time = this->Time(after - 1);
  if (hold || time == time_s) {
    return value;
  }
  if (after == this->Size_) {
    return None;
  }
  const double part = (time_s - time) / (this->Time(after) - time);
  return (1.0 - part) * value + part * this->Value(after);
}

} // namespace dspace::widgets
