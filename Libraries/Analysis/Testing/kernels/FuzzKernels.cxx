// What the readers of binary kernels do with files from anywhere. A fuzz target: input is the bytes
// of an SPK, a CK or a binary PCK. Nothing in it may crash, hang, or throw anything but Error; and
// what is read is finite.
//
// With clang and -DDSPACE_LIBFUZZER=ON it is libFuzzer's program. Else it changes valid kernels of
// every type that is read, 20,000 times, seed 1 (for five minutes with DSPACE_LONG), or runs the
// files that it is given. An input that fails is left in the working folder.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <unistd.h>

#include <dspace/Error.h>
#include <dspace/kernels/BinaryPck.h>
#include <dspace/kernels/CkFile.h>
#include <dspace/kernels/SpkFile.h>

#include "FuzzMain.h"
#include "KernelWriter.h"
#include "TemporaryFolder.h"

using namespace dspace;
using dspace::testing::Fail;
using dspace::testing::Try;

namespace {

void Use(const std::string& path) {
  std::shared_ptr<const DafFile> file;
  Try([&] { file = std::make_shared<const DafFile>(path); });
  if (!file) {
    return;
  }
  Try([&] { file->Comments(); });
  const auto times = [](double begin, double end) {
    return std::vector<double>{begin, begin + 0.37 * (end - begin), 0.5 * (begin + end), end};
  };
  Try([&] {
    const SpkFile spk(file);
    for (std::size_t i = 0; i < spk.Segments().size(); ++i) {
      for (const double t : times(spk.Segments()[i].begin, spk.Segments()[i].end)) {
        Try([&] {
          const State state = spk.At(i, t);
          if (!state.position.allFinite() || !state.velocity.allFinite()) {
            Fail("a state that is not finite");
          }
        });
      }
    }
  });
  Try([&] {
    const BinaryPck pck(file);
    for (std::size_t i = 0; i < pck.Segments().size(); ++i) {
      for (const double t : times(pck.Segments()[i].begin, pck.Segments()[i].end)) {
        Try([&] {
          if (!std::isfinite(pck.At(i, t).phi + pck.At(i, t).wRate)) {
            Fail("an angle that is not finite");
          }
        });
      }
    }
  });
  Try([&] {
    const CkFile ck(file);
    for (std::size_t i = 0; i < ck.Segments().size(); ++i) {
      Try([&] { ck.Intervals(i); });
      for (const double t : times(ck.Segments()[i].begin, ck.Segments()[i].end)) {
        Try([&] {
          const auto pointing = ck.At(i, t, 10.0);
          if (pointing && !pointing->rotation.allFinite()) {
            Fail("a rotation that is not finite");
          }
        });
      }
    }
  });
}

// Valid kernels of each type and byte order.
const std::vector<std::string>& Seeds() {
  static const std::vector<std::string> seeds = [] {
    namespace t = dspace::testing;
    const t::TemporaryFolder folder;
    const t::Components state = [](double s) {
      return std::vector<double>{
          7e3 * std::cos(s / 900),        7e3 * std::sin(s / 900),       1.0,
          -7e3 / 900 * std::sin(s / 900), 7e3 / 900 * std::cos(s / 900), 0.0};
    };
    const t::Components position = [&](double s) {
      auto p = state(s);
      p.resize(3);
      return p;
    };
    std::vector<double> uneven;
    for (int i = 0; i < 12; ++i) {
      uneven.push_back(60.0 * i + 3.0 * (i % 3));
    }
    std::vector<std::string> files;
    const auto keep = [&](const t::DafWriter& writer) {
      writer.Write(folder / "seed");
      std::ifstream in(folder / "seed", std::ios::binary);
      files.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    };
    for (const bool big : {false, true}) {
      const double end = uneven.back();
      const std::vector<std::pair<int, std::vector<double>>> segments = {
          {2, t::ChebyshevWords(position, 0.0, end / 3, 3, 8)},
          {3, t::ChebyshevWords(state, 0.0, end / 3, 3, 8)},
          {8, t::EqualStates(state, 0.0, end / 11, 12, 5)},
          {9, t::TimedStates(state, uneven, 4)},
          {13, t::TimedStates(state, uneven, 3)}};
      for (const auto& segment : segments) {
        t::DafWriter writer("DAF/SPK ", 2, 6, big);
        writer.Add("spk", {0.0, end}, {-1000, 399, 1, segment.first}, segment.second);
        keep(writer);
      }
      for (const int type : {1, 21}) { // one line of differences, all of them 0
        std::vector<double> line(71, 0.0);
        std::fill(line.begin() + 1, line.begin() + 16, 60.0);
        line[16] = 7e3;
        line[67] = 4.0;
        line[68] = line[69] = line[70] = 3.0;
        line.push_back(end);
        if (type == 21) {
          line.push_back(15.0);
        }
        line.push_back(1.0);
        t::DafWriter writer("DAF/SPK ", 2, 6, big);
        writer.Add("mda", {0.0, end}, {-1000, 399, 1, type}, line);
        keep(writer);
      }
      t::DafWriter pck("DAF/PCK ", 2, 5, big);
      pck.Add("pck", {0.0, end}, {3000, 17, 2}, t::ChebyshevWords(position, 0.0, end / 3, 3, 8));
      keep(pck);
      std::vector<double> words; // two pointings and their rates in one interval
      for (int i = 0; i < 2; ++i) {
        const double half = 0.1 * i;
        for (const double word : {std::cos(half), 0.0, 0.0, std::sin(half), 0.0, 0.0, 1e-3}) {
          words.push_back(word);
        }
      }
      for (const double word : {0.0, 200.0, 0.0, 1.0, 2.0}) {
        words.push_back(word);
      }
      t::DafWriter ck("DAF/CK  ", 2, 6, big);
      ck.Add("ck", {0.0, 200.0}, {-82000, 1, 3, 1}, words);
      keep(ck);
    }
    return files;
  }();
  return seeds;
}

std::string Mutate(std::mt19937_64& random) {
  const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
  std::string bytes = Seeds()[below(Seeds().size())];
  static const double Doubles[] = {0.0,   -0.0,         1.0, -1.0,     2.0,       99.0,
                                   100.0, 101.0,        1e9, 1e18,     1e300,     -1e300,
                                   0.5,   4294967296.0, NAN, INFINITY, -INFINITY, 5e-324};
  static const std::int32_t Integers[] = {
      0, 1, -1, 2, 3, 5, 8, 9, 13, 21, 125, 126, 385, 1 << 20, 2147483647, -2147483647 - 1};
  for (std::size_t n = 1 + below(4); n > 0; --n) {
    if (bytes.size() < 16) {
      break;
    }
    // Most changes hit the file record, the summaries and the ends of arrays, which have structure.
    const bool end = below(3) == 0;
    const std::size_t words = bytes.size() / 8;
    const std::size_t word = end        ? words - 1 - below(std::min<std::size_t>(words, 140))
                             : below(2) ? below(words)
                                        : below(std::min<std::size_t>(words, 150));
    switch (below(6)) {
    case 0:
      bytes[below(bytes.size())] = char(random());
      break;
    case 1:
      bytes.resize(below(bytes.size()));
      break;
    case 2: {
      std::int32_t value = Integers[below(std::size(Integers))];
      if (below(2)) {
        value = std::int32_t(__builtin_bswap32(std::uint32_t(value)));
      }
      std::memcpy(bytes.data() + 8 * word + 4 * below(2), &value, 4);
      break;
    }
    default: {
      std::uint64_t value = 0;
      std::memcpy(&value, &Doubles[below(std::size(Doubles))], 8);
      if (below(2)) {
        value = __builtin_bswap64(value);
      }
      std::memcpy(bytes.data() + 8 * word, &value, 8);
    }
    }
  }
  return bytes;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const dspace::testing::TemporaryFolder folder;
  static const std::string path = folder / "input";
  {
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(data), std::streamsize(size));
  }
  Use(path);
  return 0;
}

#ifndef DSPACE_LIBFUZZER
int main(int argc, char** argv) {
  const dspace::testing::TemporaryFolder folder;
  int good = 0;
  for (const std::string& seed : Seeds()) {
    std::ofstream(folder / "seed", std::ios::binary) << seed;
    const auto file = std::make_shared<const DafFile>(folder / "seed"); // throws: a seed is wrong
    if (file->Kind() == "SPK") {
      good += SpkFile(file).At(0, 100.0).position.allFinite() ? 1 : 0;
    } else if (file->Kind() == "PCK") {
      good += std::isfinite(BinaryPck(file).At(0, 100.0).w) ? 1 : 0;
    } else {
      good += CkFile(file).At(0, 100.0) ? 1 : 0;
    }
  }
  if (good != int(Seeds().size())) {
    Fail("a kernel to begin with is not read");
  }
  return dspace::testing::FuzzMain(argc, argv, "fuzz-kernels", Seeds(), Mutate);
}
#endif
