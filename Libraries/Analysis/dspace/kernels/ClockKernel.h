// Clocks of spacecraft, from SCLK kernels.
#ifndef DSPACE_KERNELS_CLOCK_KERNEL_H
#define DSPACE_KERNELS_CLOCK_KERNEL_H

#include <string>
#include <vector>

#include <dspace/kernels/KernelPool.h>
#include <dspace/time/TimeScales.h>

namespace dspace {

// A spacecraft's clock of type 1 (NAIF, "SCLK Required Reading"). Ticks are the smallest counts
// since the beginning of its first partition: what CK files hold ("encoded SCLK"), fractions
// allowed.
//
// The relation of ticks and TDB is piecewise linear, as the kernel tabulates it; it is continuous
// only as far as the kernel's numbers are. Its error is that of the kernel's correlation.
class ClockKernel {
public:
  // `clock` is the clock's id, below 0: -82 for Cassini. `scales` convert the TT of the kernel.
  // Throws Error(NotFound) where the pool has no such clock, and names the clocks that it has;
  // Error(Unsupported) for types other than 1; Error(Corrupt) for tables that make no sense.
  ClockKernel(const KernelPool& pool, int clock, const TimeScales& scales);

  // The ids of all clocks of a pool, ascending.
  static std::vector<int> Clocks(const KernelPool& pool);

  int Clock() const { return this->Clock_; }
  // Ticks of one count of the most significant field.
  double TicksACount() const { return this->TicksACount_; }
  // The first and last tick, and the same as TDB [s].
  double FirstTick() const { return 0.0; }
  double LastTick() const { return this->PartitionEnds_.back(); }
  double FirstTdb() const { return this->TdbOf(this->FirstTick()); }
  double LastTdb() const { return this->TdbOf(this->LastTick()); }

  // Throws Error(InvalidArgument), naming the clock and its span, outside first to last tick.
  double TdbOf(double ticks) const;
  // Continuous ticks. Throws Error(InvalidArgument) outside FirstTdb() to LastTdb().
  double TicksOf(double tdb) const;

  // Ticks of a text "1/1465674964.105": a partition (absent: the first that has this count), then
  // the fields, from the most significant one; those that are left out are 0. Fields are separated
  // by any of ".:-, ". Throws Error(InvalidArgument) that says what is accepted.
  double TicksOfText(const std::string& text) const;
  // The text of ticks, rounded to whole ones: "1/1465674964.105". Throws as TdbOf.
  std::string TextOf(double ticks) const;

private:
  [[noreturn]] void Fail(const std::string& variable, const std::string& what) const;
  std::string Label() const;

  int Clock_;
  TimeScales Scales_;
  bool ParallelIsTt_ = false;
  double TicksACount_ = 1.0;
  std::vector<double> Moduli_;
  std::vector<double> Offsets_;
  std::string Delimiter_;
  std::vector<double> PartitionStarts_; // [ticks] that the clock shows at the partition's beginning
  std::vector<double> PartitionEnds_;   // [ticks] since the first partition's beginning
  struct Record {
    double ticks, parallel, rate; // rate: seconds of parallel time a most significant count
  };
  std::vector<Record> Records_;
};

} // namespace dspace

#endif
