// Chebyshev polynomials of three functions over intervals of equal length.
#ifndef DSPACE_ANALYSIS_CHEBYSHEV_RECORDS_H
#define DSPACE_ANALYSIS_CHEBYSHEV_RECORDS_H

#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include <dspace/kernels/DafFile.h>

namespace dspace {

// The value and the derivative of a sum of `count` Chebyshev polynomials at `x` in [-1, 1].
void ChebyshevSum(const double* coefficients, std::size_t count, double x, double& value,
                  double& derivative);

// The arrays of SPK types 2 and 3 and of PCK type 2: records of a middle, a radius and
// coefficients, then the first interval's begin, the intervals' length, the words a record and the
// number of records.
class ChebyshevRecords {
public:
  // `functions`: 3 (types 2), or 6 (type 3). Throws Error(Corrupt).
  ChebyshevRecords(const DafFile& file, const DafFile::Array& array, int functions);

  // The first three functions, and their derivatives or, of six functions, the other three.
  void At(double tdb, Eigen::Vector3d& values, Eigen::Vector3d& rates) const;

private:
  const DafFile* File_;
  std::int64_t First_;
  int Functions_;
  double Begin_ = 0.0;
  double Length_ = 0.0;
  std::int64_t RecordWords_ = 0;
  std::int64_t Records_ = 0;
  std::size_t Coefficients_ = 0;
};

} // namespace dspace

#endif
