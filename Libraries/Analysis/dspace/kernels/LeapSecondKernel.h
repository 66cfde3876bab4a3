// Leap seconds and TDB - TT from a loaded LSK.
#ifndef DSPACE_KERNELS_LEAP_SECOND_KERNEL_H
#define DSPACE_KERNELS_LEAP_SECOND_KERNEL_H

#include <dspace/kernels/KernelPool.h>
#include <dspace/time/TimeScales.h>

namespace dspace {

// Whether a pool has the variables of an LSK (DELTET/DELTA_AT).
bool HasLeapSeconds(const KernelPool& pool);

// The time scales of a pool's LSK (NAIF, "Time Required Reading"): the table DELTET/DELTA_AT and
// the term of TDB - TT. Throws Error(NotFound, Corrupt), naming the file and line, where a variable
// is missing, a date is no day's beginning, or the table does not ascend.
TimeScales TimeScalesOf(const KernelPool& pool);

} // namespace dspace

#endif
