// What runs a fuzz target where libFuzzer does not:
//   PROGRAM [--runs N] [--seconds S] [--seed N]  makes inputs by chance
//   PROGRAM FILE ...                             runs inputs, as libFuzzer leaves them
//   PROGRAM --corpus FOLDER                      writes valid inputs, to begin with
// With DSPACE_LONG set it makes them for five minutes, else for 20 s at most, seed 1. An input that
// fails is left in the working folder.
#ifndef DSPACE_FUZZ_DRIVER_H
#define DSPACE_FUZZ_DRIVER_H

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <google/protobuf/stubs/logging.h>

#include "FuzzCommands.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace dspace::testing {

class FuzzDriver {
public:
  std::string failure; // the file's name
  long runs = 2000;    // with DSPACE_LONG without end
  std::function<std::vector<std::string>(Mutator&)> corpus;
  std::function<std::string(Mutator&, long run)> next;

  int Main(int argc, char** argv) {
    double seconds = 20;
    unsigned seed = 1;
    const char* given = std::getenv("DSPACE_LONG");
    if (given && *given) {
      this->runs = 1000000000;
      seconds = 300;
    }
    bool files = false;
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      const char* value = i + 1 < argc ? argv[i + 1] : "";
      if (word == "--runs") {
        this->runs = std::atol(value);
      } else if (word == "--seconds") {
        seconds = std::atof(value);
      } else if (word == "--seed") {
        seed = unsigned(std::atol(value));
      } else if (word == "--corpus") {
        Mutator mutator(seed);
        int n = 0;
        for (const std::string& bytes : this->corpus(mutator)) {
          std::ofstream(std::string(value) + "/" + std::to_string(n++), std::ios::binary) << bytes;
        }
        return 0;
      } else {
        std::ifstream in(word, std::ios::binary);
        std::ostringstream bytes;
        bytes << in.rdbuf();
        Run(bytes.str());
        files = true;
        continue;
      }
      ++i;
    }
    return files ? 0 : this->Fuzz(seconds, seed);
  }

private:
  static void Run(const std::string& bytes) {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }

  int Fuzz(double seconds, unsigned seed) {
    // libprotobuf tells of every text that is no UTF-8.
    const google::protobuf::LogSilencer quiet;
    Mutator mutator(seed);
    const auto began = std::chrono::steady_clock::now();
    long run = 0;
    for (; run < this->runs; ++run) {
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - began;
      if (spent.count() > seconds) {
        break;
      }
      const std::string bytes = this->next(mutator, run);
      std::ofstream(this->failure, std::ios::binary) << bytes;
      Run(bytes);
    }
    std::filesystem::remove(this->failure);
    std::printf("%ld inputs from seed %u, of %d kinds of commands; none failed\n", run, seed,
                v1::Command::descriptor()->field_count() - 1);
    return 0;
  }
};

} // namespace dspace::testing

#endif
