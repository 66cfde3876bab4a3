#include <dspace/kernels/SpkDifferences.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <dspace/kernels/KernelWords.h>

namespace dspace {

SpkDifferences::SpkDifferences(const DafFile& file, const DafFile::Array& array, int type)
    : File_(file), Array_(array) {
  const KernelWords words(file, array);
  words.RequireCount(type == 21 ? 3 : 2);
  if (type == 21) {
    this->Differences_ = words.Whole(array.last - 1, 1, 1000, "the number of differences a record");
    this->RecordWords_ = 4 * this->Differences_ + 11;
  }
  this->Records_ = words.Whole(array.last, 1, array.Count(), "the number of records");
  if (this->Records_ * (this->RecordWords_ + 1) > array.Count() - (type == 21 ? 2 : 1)) {
    words.Damaged(std::to_string(this->Records_) + " records of " +
                  std::to_string(this->RecordWords_) + " words do not fit into " +
                  std::to_string(array.Count()) + " words");
  }
}

State SpkDifferences::At(double tdb) const {
  const KernelWords check(this->File_, this->Array_);
  const std::int64_t epochs = this->Array_.first + this->Records_ * this->RecordWords_;
  const std::int64_t record = FirstNotBefore(this->File_, epochs, this->Records_, tdb);
  if (record == this->Records_) {
    check.Damaged("its last record ends before " + NumberText(tdb) + " s past J2000");
  }
  const auto most = std::size_t(this->Differences_);
  thread_local std::vector<double> kept;
  const double* words =
      this->File_.View(this->Array_.first + record * this->RecordWords_, this->RecordWords_, kept);
  const double reference = words[0];
  const double* steps = words + 1;              // of the integrator
  const double* state = words + 1 + most;       // x, vx, y, vy, z, vz
  const double* differences = words + 7 + most; // `most` each of x, y, z
  const double* orders = words + 7 + 4 * most;  // the highest plus one, then one each
  const double highest = orders[0];
  bool good = highest >= 2.0 && highest <= double(most + 1) && highest == std::floor(highest);
  for (int i = 1; i <= 3; ++i) {
    good = good && orders[i] >= 0.0 && orders[i] <= std::min(double(most), highest) &&
           orders[i] == std::floor(orders[i]);
  }
  if (!good || !std::isfinite(reference)) {
    check.Damaged("the orders of its record " + std::to_string(record) + " make no sense");
  }

  const double delta = tdb - reference;
  const auto order = std::size_t(highest) - 2;
  thread_local std::vector<double> factors, ratios, weights;
  factors.assign(order + 2, 1.0);
  ratios.assign(order + 1, 0.0);
  weights.assign(most + 4, 0.0);
  double passed = delta;
  for (std::size_t j = 0; j < order; ++j) {
    if (steps[j] == 0.0 || !std::isfinite(steps[j])) {
      check.Damaged("a step of its record " + std::to_string(record) + " is " +
                    NumberText(steps[j]));
    }
    factors[j + 1] = passed / steps[j];
    ratios[j] = delta / steps[j];
    passed = delta + steps[j];
  }
  for (std::size_t j = 0; j <= order + 1; ++j) {
    weights[j] = 1.0 / double(j + 1);
  }
  // The coefficients of the second integral of the differences; one step more gives those of the
  // first.
  std::size_t count = 0;
  std::size_t shift = order + 1;
  const auto integrate = [&] {
    for (std::size_t j = 0; j < count; ++j) {
      weights[j + shift] = factors[j + 1] * weights[j + shift - 1] - ratios[j] * weights[j + shift];
    }
  };
  while (shift >= 2) {
    ++count;
    integrate();
    --shift;
  }
  const auto sum = [&](int axis) {
    double total = 0.0;
    for (auto j = std::size_t(orders[axis + 1]); j-- > 0;) {
      total += differences[std::size_t(axis) * most + j] * weights[j + shift];
    }
    return total;
  };
  State result;
  for (int axis = 0; axis < 3; ++axis) {
    result.position[axis] = state[2 * axis] + delta * (state[2 * axis + 1] + delta * sum(axis));
  }
  integrate();
  --shift;
  for (int axis = 0; axis < 3; ++axis) {
    result.velocity[axis] = state[2 * axis + 1] + delta * sum(axis);
  }
  result.position *= 1000.0; // from km
  result.velocity *= 1000.0;
  return result;
}

} // namespace dspace
