// NAIF text kernels: leap seconds, planetary constants, frames, instruments, clocks, meta-kernels.
#ifndef DSPACE_KERNELS_TEXT_KERNEL_H
#define DSPACE_KERNELS_TEXT_KERNEL_H

#include <cstddef>
#include <string>
#include <vector>

namespace dspace {

// One assignment of a text kernel: either numbers or texts, at least one.
struct KernelAssignment {
  std::string name;
  bool append = false; // "+="
  bool isText = false;
  std::vector<double> numbers; // dates are seconds past J2000 of the same calendar, no leap seconds
  std::vector<std::string> texts; // without quotes
  int line = 0;                   // where the name stands, from 1
};

// The assignments of one file, in order (NAIF, "Kernel Required Reading").
//
// Only what lies between a line "\begindata" and the next line "\begintext" or the end is read.
// Names have 1 to 32 printable ASCII characters without "=", "(", ")", "," and "'", and keep their
// case. A value is one item or a list in parentheses, separated by blanks, line ends or commas
// (one may stand before the closing parenthesis). An item is a number (Fortran's exponents E, D, e,
// d), a text in single quotes on one line ('' stands for a quote), or a date after "@": 1972-JAN-1,
// 2016-05-10/23:26:03.40, 2004-JUN-11-19:32.
//
// Strict: anything else throws Error(Corrupt) that names the file, the line and what is accepted.
class TextKernel {
public:
  static constexpr std::size_t MaxBytes = 256u << 20; // of a file

  // Reads a file. Throws Error(NotFound, Io) for one that cannot be read, Error(Resource) above
  // MaxBytes, Error(Corrupt) for damaged content and for a file without data.
  static TextKernel Read(const std::string& path);
  // The same from text in memory; `name` stands for the file in errors.
  static TextKernel Parse(const std::string& text, const std::string& name);
  // Whether a file begins like a text kernel: no binary file, and a "\begindata" line or "KPL/".
  static bool Recognizes(const std::string& path);

  const std::string& Name() const { return this->Name_; }
  // "LSK", "PCK", "FK", "IK", "SCLK", "MK", "SPK" as the file's first line states it, or empty.
  const std::string& Kind() const { return this->Kind_; }
  const std::vector<KernelAssignment>& Assignments() const { return this->Assignments_; }

private:
  std::string Name_;
  std::string Kind_;
  std::vector<KernelAssignment> Assignments_;
};

} // namespace dspace

#endif
