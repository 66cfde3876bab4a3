#include <dspace/kernels/SpkNodes.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <dspace/kernels/KernelWords.h>

namespace dspace {
namespace {

// Neville's scheme: the polynomial through (times[i], states[6 i + component]).
double Lagrange(const std::vector<double>& times, const double* states, int component, double tdb,
                std::vector<double>& work) {
  const std::size_t count = times.size();
  work.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    work[i] = states[6 * i + std::size_t(component)];
  }
  for (std::size_t step = 1; step < count; ++step) {
    for (std::size_t i = 0; i + step < count; ++i) {
      work[i] = ((tdb - times[i + step]) * work[i] + (times[i] - tdb) * work[i + 1]) /
                (times[i] - times[i + step]);
    }
  }
  return work[0];
}

// The polynomial through positions and velocities, and its derivative: Neville's scheme on doubled
// times, where the first step takes the velocities.
void Hermite(const std::vector<double>& times, const double* states, int axis, double tdb,
             double& value, double& derivative, std::vector<double>& work,
             std::vector<double>& slopes) {
  const std::size_t count = 2 * times.size();
  work.resize(count);
  slopes.assign(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    work[i] = states[6 * (i / 2) + std::size_t(axis)];
  }
  for (std::size_t step = 1; step < count; ++step) {
    for (std::size_t i = 0; i + step < count; ++i) {
      const double low = times[i / 2];
      const double high = times[(i + step) / 2];
      if (low == high) { // step 1, of one state
        const double rate = states[6 * (i / 2) + 3 + std::size_t(axis)];
        work[i] += rate * (tdb - low);
        slopes[i] = rate;
        continue;
      }
      const double length = low - high;
      slopes[i] =
          ((tdb - high) * slopes[i] + work[i] + (low - tdb) * slopes[i + 1] - work[i + 1]) / length;
      work[i] = ((tdb - high) * work[i] + (low - tdb) * work[i + 1]) / length;
    }
  }
  value = work[0];
  derivative = slopes[0];
}

} // namespace

SpkNodes::SpkNodes(const DafFile& file, const DafFile::Array& array, int type)
    : File_(file), Array_(array), Type_(type) {
  const KernelWords words(file, array);
  words.RequireCount(type == 8 ? 10 : 9);
  this->States_ = words.Whole(array.last, 1, array.Count() / 6, "the number of states");
  this->Window_ = 1 + words.Whole(array.last - 1, type == 13 ? 0 : 1, 200,
                                  type == 13 ? "the size of its window less one" : "the degree");
  std::int64_t needed = 6 * this->States_ + 4;
  if (type == 8) {
    this->Begin_ = words.Finite(array.last - 3, "the time of its first state");
    this->Step_ = words.Finite(array.last - 2, "the step between its states");
    if (!(this->Step_ > 0.0)) {
      words.Damaged("the step between its states is " + NumberText(this->Step_));
    }
  } else {
    needed = 7 * this->States_ + (this->States_ - 1) / 100 + 2;
  }
  if (needed > array.Count() || this->Window_ > this->States_) {
    words.Damaged(std::to_string(this->States_) + " states with windows of " +
                  std::to_string(this->Window_) + " do not fit into " +
                  std::to_string(array.Count()) + " words");
  }
}

State SpkNodes::At(double tdb) const {
  const std::int64_t epochs = this->Array_.first + 6 * this->States_;
  const auto timeOf = [&](std::int64_t index) {
    return this->Type_ == 8 ? this->Begin_ + double(index) * this->Step_
                            : this->File_.Read(epochs + index);
  };
  // The last state that is not after tdb, at most the last but one.
  std::int64_t low = 0;
  if (this->Type_ == 8) {
    low = std::int64_t(
        std::clamp(std::floor((tdb - this->Begin_) / this->Step_), 0.0, double(this->States_ - 1)));
  } else {
    low = FirstNotBefore(this->File_, epochs, this->States_, tdb);
    if (low == this->States_ || timeOf(low) > tdb) {
      low = std::max<std::int64_t>(0, low - 1);
    }
  }
  std::int64_t first = low;
  if (this->Window_ % 2 == 0) {
    first = low - (this->Window_ / 2 - 1);
  } else {
    const bool nearHigh = low + 1 < this->States_ && !(tdb - timeOf(low) < timeOf(low + 1) - tdb);
    first = low + (nearHigh ? 1 : 0) - this->Window_ / 2;
  }
  first = std::clamp<std::int64_t>(first, 0, this->States_ - this->Window_);

  thread_local std::vector<double> times, kept, work, slopes;
  times.resize(std::size_t(this->Window_));
  for (std::int64_t i = 0; i < this->Window_; ++i) {
    times[std::size_t(i)] = timeOf(first + i);
    if (!std::isfinite(times[std::size_t(i)]) ||
        (i > 0 && !(times[std::size_t(i)] > times[std::size_t(i - 1)]))) {
      KernelWords(this->File_, this->Array_).Damaged("the times of its states do not ascend");
    }
  }
  const double* states = this->File_.View(this->Array_.first + 6 * first, 6 * this->Window_, kept);
  State state;
  for (int axis = 0; axis < 3; ++axis) {
    if (this->Type_ == 13) {
      Hermite(times, states, axis, tdb, state.position[axis], state.velocity[axis], work, slopes);
    } else {
      state.position[axis] = Lagrange(times, states, axis, tdb, work);
      state.velocity[axis] = Lagrange(times, states, axis + 3, tdb, work);
    }
  }
  state.position *= 1000.0; // from km
  state.velocity *= 1000.0;
  return state;
}

} // namespace dspace
