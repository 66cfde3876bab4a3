#include <dspace/kernels/ChebyshevRecords.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/kernels/KernelWords.h>

namespace dspace {

void ChebyshevSum(const double* coefficients, std::size_t count, double x, double& value,
                  double& derivative) {
  // Clenshaw's recurrence, and its derivative.
  const double x2 = 2.0 * x;
  double b1 = 0.0, b2 = 0.0, d1 = 0.0, d2 = 0.0;
  for (std::size_t i = count; i-- > 1;) {
    const double d0 = 2.0 * b1 + x2 * d1 - d2;
    const double b0 = coefficients[i] + x2 * b1 - b2;
    d2 = d1;
    d1 = d0;
    b2 = b1;
    b1 = b0;
  }
  value = coefficients[0] + x * b1 - b2;
  derivative = b1 + x * d1 - d2;
}

ChebyshevRecords::ChebyshevRecords(const DafFile& file, const DafFile::Array& array, int functions)
    : File_(&file), First_(array.first), Functions_(functions) {
  const KernelWords words(file, array);
  words.RequireCount(4);
  this->Begin_ = words.Finite(array.last - 3, "the begin of its first interval");
  this->Length_ = words.Finite(array.last - 2, "the length of its intervals");
  this->RecordWords_ = words.Whole(array.last - 1, 2 + functions, 10000, "the words a record");
  this->Records_ = words.Whole(array.last, 1, array.Count(), "the number of records");
  if (!(this->Length_ > 0.0)) {
    words.Damaged("its intervals are " + NumberText(this->Length_) + " s long");
  }
  if ((this->RecordWords_ - 2) % functions != 0 ||
      this->RecordWords_ * this->Records_ > array.Count() - 4) {
    words.Damaged(std::to_string(this->Records_) + " records of " +
                  std::to_string(this->RecordWords_) + " words do not fit into " +
                  std::to_string(array.Count()) + " words");
  }
  this->Coefficients_ = std::size_t(this->RecordWords_ - 2) / std::size_t(functions);
}

void ChebyshevRecords::At(double tdb, Eigen::Vector3d& values, Eigen::Vector3d& rates) const {
  const double interval = std::floor((tdb - this->Begin_) / this->Length_);
  const auto record = std::int64_t(
      std::clamp(interval, 0.0, double(this->Records_ - 1))); // both ends are inclusive
  thread_local std::vector<double> kept;
  const double* words =
      this->File_->View(this->First_ + record * this->RecordWords_, this->RecordWords_, kept);
  const double radius = words[1];
  const double x = (tdb - words[0]) / radius;
  // A record whose middle and radius do not fit its place would be extrapolated without a limit.
  if (!(std::abs(x) <= 1.0 + 1e-6)) {
    throw Error(Error::Kind::Corrupt, this->File_->Label(),
                "record " + std::to_string(record) + " covers " + NumberText(words[0]) + " +- " +
                    NumberText(radius) + " s, not " + NumberText(tdb) + " s past J2000");
  }
  const std::size_t count = this->Coefficients_;
  if (this->Functions_ == 3) {
    // The three sums side by side.
    const double x2 = 2.0 * x;
    const double* cx = words + 2;
    const double* cy = cx + count;
    const double* cz = cy + count;
    double b1[3] = {}, b2[3] = {}, d1[3] = {}, d2[3] = {};
    for (std::size_t i = count; i-- > 1;) {
      const double c[3] = {cx[i], cy[i], cz[i]};
      for (int k = 0; k < 3; ++k) {
        const double d0 = 2.0 * b1[k] + x2 * d1[k] - d2[k];
        const double b0 = c[k] + x2 * b1[k] - b2[k];
        d2[k] = d1[k];
        d1[k] = d0;
        b2[k] = b1[k];
        b1[k] = b0;
      }
    }
    const double c[3] = {cx[0], cy[0], cz[0]};
    for (int k = 0; k < 3; ++k) {
      values[k] = c[k] + x * b1[k] - b2[k];
      rates[k] = (b1[k] + x * d1[k] - d2[k]) / radius;
    }
    return;
  }
  for (int k = 0; k < 3; ++k) {
    double unused = 0.0;
    ChebyshevSum(words + 2 + std::size_t(k) * count, count, x, values[k], unused);
    ChebyshevSum(words + 2 + std::size_t(k + 3) * count, count, x, rates[k], unused);
  }
}

} // namespace dspace
