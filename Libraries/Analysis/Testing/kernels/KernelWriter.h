// Writes SPICE's binary kernels for tests, from closed forms, in both byte orders. Made from NAIF's
// published formats ("DAF", "SPK", "CK" and "PCK Required Reading") without a look at the readers,
// so that a mistake in one is not repeated in the other.
#ifndef DSPACE_TEST_KERNEL_WRITER_H
#define DSPACE_TEST_KERNEL_WRITER_H

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace dspace::testing {

// A double precision array file with ND doubles and NI integers a summary.
class DafWriter {
public:
  DafWriter(const std::string& word, int doubles, int integers, bool bigEndian)
      : Word_(word), Doubles_(doubles), Integers_(integers), BigEndian_(bigEndian) {}

  // `integers` without the two addresses.
  void Add(const std::string& name, const std::vector<double>& doubles,
           const std::vector<int>& integers, std::vector<double> words) {
    this->Arrays_.push_back({name, doubles, integers, std::move(words)});
  }

  // Summary records of at most `most` summaries, so that several are linked; each is followed by
  // its names, and by the words of its arrays.
  void Write(const std::string& path, int most = 25) const {
    const int size = this->Doubles_ + (this->Integers_ + 1) / 2; // of a summary [words]
    most = std::min(most, 125 / size);
    std::string file(1024, '\0');
    std::vector<std::size_t> records; // of the summaries, from 1 on
    for (std::size_t first = 0; first < this->Arrays_.size(); first += std::size_t(most)) {
      const std::size_t last = std::min(first + std::size_t(most), this->Arrays_.size());
      records.push_back(file.size() / 1024 + 1);
      const std::size_t at = file.size();
      file.resize(at + 2048, ' '); // names are padded with blanks
      std::fill(file.begin() + std::ptrdiff_t(at), file.begin() + std::ptrdiff_t(at) + 1024, '\0');
      this->Put(file, at + 16, double(last - first));
      for (std::size_t i = first; i < last; ++i) {
        const Array& array = this->Arrays_[i];
        const std::size_t begin = file.size();
        for (const double word : array.words) {
          file.resize(file.size() + 8);
          this->Put(file, file.size() - 8, word);
        }
        const std::size_t summary = at + 24 + 8 * std::size_t(size) * (i - first);
        for (std::size_t k = 0; k < array.doubles.size(); ++k) {
          this->Put(file, summary + 8 * k, array.doubles[k]);
        }
        std::vector<int> integers = array.integers;
        integers.push_back(int(begin / 8 + 1)); // the file's first word is 1
        integers.push_back(int(file.size() / 8));
        for (std::size_t k = 0; k < integers.size(); ++k) {
          this->Put(file, summary + 8 * std::size_t(this->Doubles_) + 4 * k,
                    std::int32_t(integers[k]));
        }
        array.name.copy(file.data() + at + 1024 + 8 * std::size_t(size) * (i - first),
                        8 * std::size_t(size));
      }
      file.resize((file.size() + 1023) / 1024 * 1024, '\0');
    }
    for (std::size_t i = 0; i < records.size(); ++i) {
      const std::size_t at = 1024 * (records[i] - 1);
      this->Put(file, at, i + 1 < records.size() ? double(records[i + 1]) : 0.0);
      this->Put(file, at + 8, i > 0 ? double(records[i - 1]) : 0.0);
    }
    std::fill(file.begin(), file.begin() + 96, ' ');
    this->Word_.copy(file.data(), 8);
    this->Put(file, 8, std::int32_t(this->Doubles_));
    this->Put(file, 12, std::int32_t(this->Integers_));
    std::string("closed forms").copy(file.data() + 16, 60);
    this->Put(file, 76, std::int32_t(records.front()));
    this->Put(file, 80, std::int32_t(records.back()));
    this->Put(file, 84, std::int32_t(file.size() / 8 + 1));
    std::memcpy(file.data() + 88, this->BigEndian_ ? "BIG-IEEE" : "LTL-IEEE", 8);
    static const char Transfer[] = "FTPSTR:\r:\n:\r\n:\r\0:\x81:\x10\xce:ENDFTP";
    std::memcpy(file.data() + 699, Transfer, 28);
    std::ofstream(path, std::ios::binary).write(file.data(), std::streamsize(file.size()));
  }

private:
  struct Array {
    std::string name;
    std::vector<double> doubles;
    std::vector<int> integers;
    std::vector<double> words;
  };
  template<class T> void Put(std::string& file, std::size_t at, T value) const {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (this->BigEndian_) { // the machine is little-endian
      std::reverse(bytes, bytes + sizeof(T));
    }
    std::memcpy(file.data() + at, bytes, sizeof(T));
  }
  std::string Word_;
  int Doubles_;
  int Integers_;
  bool BigEndian_;
  std::vector<Array> Arrays_;
};

// Components at a time: kilometres, radians.
using Components = std::function<std::vector<double>(double t)>;

// Chebyshev coefficients of each component over [middle - radius, middle + radius]: interpolation
// at the polynomial's zeros.
inline std::vector<double> Chebyshev(const Components& f, double middle, double radius, int count) {
  std::vector<std::vector<double>> values;
  for (int k = 0; k < count; ++k) {
    values.push_back(f(middle + radius * std::cos(M_PI * (k + 0.5) / count)));
  }
  std::vector<double> out;
  for (std::size_t c = 0; c < values[0].size(); ++c) {
    for (int j = 0; j < count; ++j) {
      double sum = 0.0;
      for (int k = 0; k < count; ++k) {
        sum += values[std::size_t(k)][c] * std::cos(M_PI * j * (k + 0.5) / count);
      }
      out.push_back((j == 0 ? 1.0 : 2.0) / count * sum);
    }
  }
  return out;
}

// Types 2 and 3 of SPK, and 2 of PCK: records of equal length from `begin` on.
inline std::vector<double> ChebyshevWords(const Components& f, double begin, double length,
                                          int records, int count) {
  std::vector<double> words;
  std::size_t size = 0;
  for (int i = 0; i < records; ++i) {
    const double middle = begin + (i + 0.5) * length;
    const std::vector<double> coefficients = Chebyshev(f, middle, 0.5 * length, count);
    words.push_back(middle);
    words.push_back(0.5 * length);
    words.insert(words.end(), coefficients.begin(), coefficients.end());
    size = coefficients.size() + 2;
  }
  words.insert(words.end(), {begin, length, double(size), double(records)});
  return words;
}

// Every hundredth of `all`, of the first `count`.
inline std::vector<double> Directory(const std::vector<double>& all, std::size_t count) {
  std::vector<double> directory;
  for (std::size_t i = 100; i <= count; i += 100) {
    directory.push_back(all[i - 1]);
  }
  return directory;
}

inline void Append(std::vector<double>& words, const std::vector<double>& more) {
  words.insert(words.end(), more.begin(), more.end());
}

// Type 8: states (6 components) at equal steps.
inline std::vector<double> EqualStates(const Components& state, double begin, double step,
                                       int count, int degree) {
  std::vector<double> words;
  for (int i = 0; i < count; ++i) {
    Append(words, state(begin + step * i));
  }
  Append(words, {begin, step, double(degree), double(count)});
  return words;
}

// Types 9 (`tail`: the degree) and 13 (`tail`: the size of the window, less 1) at any times.
inline std::vector<double> TimedStates(const Components& state, const std::vector<double>& times,
                                       int tail) {
  std::vector<double> words;
  for (const double t : times) {
    Append(words, state(t));
  }
  Append(words, times);
  Append(words, Directory(times, times.size() - 1));
  Append(words, {double(tail), double(times.size())});
  return words;
}

// A difference line of type 21 (and of type 1 with `size` 15): the state at `at`, and the modified
// divided differences of the acceleration at `at`, at - gaps[0], at - gaps[0] - gaps[1], ... (F.
// Krogh, "Changing step size in the integration of differential equations using modified divided
// differences", 1974). `at` is its reference epoch.
inline std::vector<double> DifferenceLine(const Components& state, const Components& acceleration,
                                          double at, const std::vector<double>& gaps, int size) {
  const std::size_t k = gaps.size() + 1; // accelerations
  std::vector<double> times = {at};
  for (const double gap : gaps) {
    times.push_back(times.back() - gap);
  }
  std::vector<double> line(std::size_t(4 * size + 11), 0.0);
  line[0] = at;
  for (std::size_t j = 0; j + 1 < k; ++j) {
    line[1 + j] = at - times[j + 1];
  }
  const std::vector<double> reference = state(at);
  for (std::size_t c = 0; c < 3; ++c) {
    line[std::size_t(1 + size) + 2 * c] = reference[c];
    line[std::size_t(1 + size) + 2 * c + 1] = reference[c + 3];
    std::vector<double> differences;
    for (const double t : times) {
      differences.push_back(acceleration(t)[c]);
    }
    for (std::size_t order = 1; order < k; ++order) { // divided differences from the newest back
      for (std::size_t i = k - 1; i >= order; --i) {
        differences[i] = (differences[i] - differences[i - 1]) / (times[i] - times[i - order]);
      }
    }
    double product = 1.0;
    for (std::size_t j = 0; j < k; ++j) {
      line[std::size_t(7 + size) + c * std::size_t(size) + j] = product * differences[j];
      if (j + 1 < k) {
        product *= at - times[j + 1];
      }
    }
    line[std::size_t(4 * size + 8) + c] = double(k);
  }
  line[std::size_t(4 * size + 7)] = double(k + 1);
  return line;
}

// Type 21: `lines` and the last time of each.
inline std::vector<double> DifferenceWords(const std::vector<std::vector<double>>& lines,
                                           const std::vector<double>& ends, int size, bool type1) {
  std::vector<double> words;
  for (const auto& line : lines) {
    Append(words, line);
  }
  Append(words, ends);
  Append(words, Directory(ends, ends.size()));
  if (!type1) {
    words.push_back(double(size));
  }
  words.push_back(double(lines.size()));
  return words;
}

// CK type 3: quaternions (scalar first, from the base frame to the instrument's) at ticks, with
// angular velocities in the base frame [rad/s] where there are any; `starts` of the intervals.
inline std::vector<double> PointingWords(const std::vector<double>& ticks,
                                         const std::vector<Eigen::Quaterniond>& pointings,
                                         const std::vector<Eigen::Vector3d>& rates,
                                         const std::vector<double>& starts) {
  std::vector<double> words;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const Eigen::Quaterniond& q = pointings[i];
    Append(words, {q.w(), q.x(), q.y(), q.z()});
    if (!rates.empty()) {
      Append(words, {rates[i].x(), rates[i].y(), rates[i].z()});
    }
  }
  Append(words, ticks);
  Append(words, Directory(ticks, ticks.size() - 1));
  Append(words, starts);
  Append(words, Directory(starts, starts.size() - 1));
  Append(words, {double(starts.size()), double(ticks.size())});
  return words;
}

} // namespace dspace::testing

#endif
