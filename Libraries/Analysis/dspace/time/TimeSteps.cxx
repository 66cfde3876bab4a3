#include <dspace/time/TimeSteps.h>

#include <algorithm>
#include <cmath>

namespace dspace {

std::int64_t StepsBefore(double start, double end, double step) {
  const double near = std::min(5e-3, 0.1 * step);
  return std::max<std::int64_t>(1, std::int64_t(std::ceil((end - start - near) / step)));
}

} // namespace dspace
