// Checks of the numbers in an array of a binary kernel.
#ifndef DSPACE_ANALYSIS_KERNEL_WORDS_H
#define DSPACE_ANALYSIS_KERNEL_WORDS_H

#include <cmath>
#include <cstdint>
#include <string>

#include <dspace/Checks.h>
#include <dspace/kernels/DafFile.h>

namespace dspace {

// Names the array in errors.
class KernelWords {
public:
  KernelWords(const DafFile& file, const DafFile::Array& array) : File_(file), Array_(array) {}

  [[noreturn]] void Damaged(const std::string& what) const {
    throw Error(Error::Kind::Corrupt, this->File_.Label(),
                "segment '" + this->Array_.name + "' is damaged: " + what);
  }
  void RequireCount(std::int64_t count) const {
    if (this->Array_.Count() < count) {
      this->Damaged("it has " + std::to_string(this->Array_.Count()) +
                    " words; accepted: at least " + std::to_string(count));
    }
  }
  double Finite(std::int64_t address, const char* what) const {
    const double value = this->File_.Read(address);
    if (!std::isfinite(value)) {
      this->Damaged(std::string(what) + " is " + NumberText(value));
    }
    return value;
  }
  // A whole number from `least` to `most`.
  std::int64_t Whole(std::int64_t address, std::int64_t least, std::int64_t most,
                     const char* what) const {
    const double value = this->File_.Read(address);
    if (!(value >= double(least) && value <= double(most)) || value != std::floor(value)) {
      this->Damaged(std::string(what) + " is " + NumberText(value) +
                    "; accepted: " + std::to_string(least) + " to " + std::to_string(most));
    }
    return std::int64_t(value);
  }

private:
  const DafFile& File_;
  const DafFile::Array& Array_;
};

// The first of `count` ascending words at `first` that is not before `value`; `count`: none.
inline std::int64_t FirstNotBefore(const DafFile& file, std::int64_t first, std::int64_t count,
                                   double value) {
  std::int64_t low = 0, high = count;
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    if (file.Read(first + middle) < value) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

} // namespace dspace

#endif
