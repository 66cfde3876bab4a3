// What the reader of DE405's table does with files from anywhere. A fuzz target: input is the bytes
// from the file's begin on; the rest up to the size of the table is zero, unless the input begins
// with "=", which gives the file its own size. Nothing in it may crash, hang, or throw anything but
// Error; and what is read is finite.
//
// How it is built and run: FuzzMain.h.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <dspace/ephemeris/De405Source.h>

#include "FuzzMain.h"
#include "TemporaryFolder.h"

using namespace dspace;
using dspace::testing::Fail;
using dspace::testing::Try;

namespace {

constexpr std::size_t Header = 12;
constexpr std::size_t Words = 1018;
constexpr std::uintmax_t TableBytes = Header + 1143 * 8160;
constexpr double Begin = (36912.0 - 51544.5) * 86400.0; // of the first record, TDB

int Use(const std::string& path) {
  int states = 0;
  Try([&] {
    const De405Source source(path);
    for (const double days : {0.0, 1.0, 15.9, 16.0, 31.99, 32.0, 40.0, 1143.0 * 32.0, 1e9}) {
      const double tdb = Begin + days * 86400.0;
      for (const StateSource::Coverage& coverage : source.Coverages()) {
        Try([&] {
          const auto link = source.Find(coverage.body, tdb);
          if (link) {
            ++states;
            if (!link->state.position.allFinite() || !link->state.velocity.allFinite()) {
              Fail("a state that is not finite was read");
            }
          }
        });
      }
      Try([&] {
        const auto libration = source.LibrationAt(tdb);
        if (libration && !(libration->angles.allFinite() && libration->rates.allFinite())) {
          Fail("a libration that is not finite was read");
        }
      });
    }
  });
  return states;
}

// Bytes of two records in which the Earth goes round the Sun and the rest stands still.
std::string Record() {
  std::string bytes(Header + 2 * 8 * (Words + 2), '\0');
  const auto put = [&](std::size_t record, std::size_t word, double value) {
    std::memcpy(bytes.data() + Header + 8 * ((Words + 2) * record + word), &value, 8);
  };
  for (std::size_t record = 0; record < 2; ++record) {
    put(record, 0, 2436912.5 + 32.0 * double(record));
    for (std::size_t part = 0; part < 2; ++part) {
      put(record, 230 + part * 39, 1.496e8); // the first coefficient of x [km]
      put(record, 230 + part * 39 + 14, 2e7);
    }
  }
  return bytes;
}

const std::vector<std::string>& Seeds() {
  static const std::vector<std::string> seeds = {Record(), "=" + Record(), "", "="};
  return seeds;
}

std::string Mutate(std::mt19937_64& random) {
  static const double Doubles[] = {std::nan(""), HUGE_VAL, -1e308, 1e308, 1e-310, 0.0, 1e9, -1.0};
  const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
  std::string bytes = Seeds()[below(12) == 0 ? 1 : 0];
  for (std::size_t n = 1 + below(8); n > 0; --n) {
    const std::size_t word = below(2 * (Words + 2));
    switch (below(4)) {
    case 0:
      bytes[below(bytes.size())] = char(random());
      break;
    case 1:
      if (below(8) == 0) {
        bytes.resize(below(bytes.size()) + 1);
        return bytes;
      }
      break;
    default:
      std::memcpy(bytes.data() + Header + 8 * word, &Doubles[below(std::size(Doubles))], 8);
    }
  }
  return bytes;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const dspace::testing::TemporaryFolder folder;
  static const std::string path = folder / "input";
  const bool own = size > 0 && data[0] == '=';
  {
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(data) + (own ? 1 : 0),
              std::streamsize(own ? size - 1 : size));
  }
  if (!own) {
    std::filesystem::resize_file(path, TableBytes); // the rest is a hole
  }
  Use(path);
  return 0;
}

#ifndef DSPACE_LIBFUZZER
int main(int argc, char** argv) {
  const dspace::testing::TemporaryFolder folder;
  std::ofstream(folder / "seed", std::ios::binary) << Record();
  std::filesystem::resize_file(folder / "seed", TableBytes);
  if (Use(folder / "seed") == 0) {
    Fail("the table to begin with is not read");
  }
  return dspace::testing::FuzzMain(argc, argv, "fuzz-de405", Seeds(), Mutate);
}
#endif
