// Deterministic damage to files, for the fuzz tests.
#ifndef DSPACE_FUZZ_MUTATOR_H
#define DSPACE_FUZZ_MUTATOR_H

#include <cctype>
#include <cstdint>
#include <random>
#include <string>

namespace dspace::testing {

// Makes mutants of a seed file: the same number gives the same bytes on every machine.
class FuzzMutator {
public:
  explicit FuzzMutator(std::uint64_t number) : Random_(0x9e3779b97f4a7c15ULL + number) {}

  std::string Mutate(std::string bytes) {
    // Most mutants are but slightly wrong: those get deepest into a reader.
    const std::size_t changes = this->Below(2) ? 1 : 1 + this->Below(4);
    for (std::size_t i = 0; i < changes; ++i) {
      switch (this->Below(bytes.empty() ? 1 : 12)) {
      case 0:
        this->InsertNoise(bytes);
        break;
      case 1:
        bytes.resize(this->Below(bytes.size()));
        break;
      case 2:
        this->DuplicateBlock(bytes);
        break;
      case 3:
        bytes.erase(this->Below(bytes.size()), 1 + this->Below(40));
        break;
      case 4:
      case 5:
      case 6:
      case 7:
      case 8:
      case 9:
        this->EditNumber(bytes);
        break;
      default:
        this->FlipBits(bytes);
      }
    }
    return bytes;
  }

  std::size_t Below(std::size_t n) { return n ? static_cast<std::size_t>(this->Random_() % n) : 0; }

private:
  void FlipBits(std::string& bytes) {
    const std::size_t flips = 1 + this->Below(8);
    for (std::size_t i = 0; i < flips; ++i) {
      bytes[this->Below(bytes.size())] ^= static_cast<char>(1 << this->Below(8));
    }
  }

  void InsertNoise(std::string& bytes) {
    static const char* const words[] = {"{",    "}",     "[",  "]", "\"",    "\n",
                                        "NULL", "USE A", "-1", "#", "DEF A", "children ",
                                        "/",    "\\\n",  "<",  ">"};
    std::string noise;
    if (this->Below(2) == 0) {
      noise = words[this->Below(sizeof words / sizeof *words)];
    } else {
      for (std::size_t i = 1 + this->Below(8); i > 0; --i) {
        noise.push_back(static_cast<char>(this->Below(256)));
      }
    }
    bytes.insert(this->Below(bytes.size() + 1), noise);
  }

  void DuplicateBlock(std::string& bytes) {
    const std::size_t begin = this->Below(bytes.size());
    const std::string block = bytes.substr(begin, 1 + this->Below(bytes.size() / 2 + 1));
    bytes.insert(this->Below(bytes.size() + 1), block);
  }

  // Replaces a run of digits, or four bytes where there is none.
  void EditNumber(std::string& bytes) {
    static const char* const numbers[] = {
        "0",           "-1",         "1",        "255",    "65536",      "2147483647",
        "-2147483648", "4294967295", "1e38",     "1e39",   "-1e308",     "1e-320",
        "nan",         "inf",        "99999999", "0.0001", "0x7fffffff", "12345678901234567890"};
    const std::size_t start = this->Below(bytes.size());
    std::size_t i = start;
    while (i < bytes.size() && !std::isdigit(static_cast<unsigned char>(bytes[i]))) {
      ++i;
    }
    if (i == bytes.size()) {
      for (std::size_t k = start; k < bytes.size() && k < start + 4; ++k) {
        bytes[k] = static_cast<char>(this->Below(2) ? 0xff : 0x7f);
      }
      return;
    }
    std::size_t end = i;
    while (end < bytes.size() && std::isdigit(static_cast<unsigned char>(bytes[end]))) {
      ++end;
    }
    bytes.replace(i, end - i, numbers[this->Below(sizeof numbers / sizeof *numbers)]);
  }

  std::mt19937_64 Random_; // its raw output is the same everywhere; distributions are not
};

} // namespace dspace::testing

#endif
