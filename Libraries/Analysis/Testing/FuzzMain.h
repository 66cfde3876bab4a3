// The main function of fuzz targets that are not built as libFuzzer's programs.
#ifndef DSPACE_ANALYSIS_TESTING_FUZZ_MAIN_H
#define DSPACE_ANALYSIS_TESTING_FUZZ_MAIN_H

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <dspace/Error.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace dspace::testing {

[[noreturn]] inline void Fail(const char* what) {
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

// Runs `work`, which may throw an Error of any kind but Internal.
template<class Work> void Try(Work work) {
  try {
    work();
  } catch (const Error& error) {
    if (error.GetKind() == Error::Kind::Internal) {
      Fail(error.what());
    }
  }
}

// A number of the environment.
inline double Setting(const char* name, double otherwise) {
  const char* given = std::getenv(name);
  return given && *given ? std::strtod(given, nullptr) : otherwise;
}

// Runs the seeds, then 20,000 inputs of `mutate` with seed DSPACE_FUZZ_SEED (1), or with
// DSPACE_LONG as many as there are in DSPACE_FUZZ_SECONDS (300); or the files that it is given. The
// input at work is in NAME.failure of the working folder, which is removed when none failed.
template<class Mutate>
int FuzzMain(int argc, char** argv, const std::string& name, const std::vector<std::string>& seeds,
             Mutate mutate) {
  const auto run = [](const std::string& bytes) {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  };
  if (argc > 1) {
    for (int i = 1; i < argc; ++i) {
      std::ifstream in(argv[i], std::ios::binary);
      std::ostringstream bytes;
      bytes << in.rdbuf();
      run(bytes.str());
    }
    return 0;
  }
  for (const std::string& seed : seeds) {
    run(seed);
  }
  const char* given = std::getenv("DSPACE_LONG");
  const bool isLong = given && *given;
  const double seconds = isLong ? Setting("DSPACE_FUZZ_SECONDS", 300.0) : 60.0;
  std::mt19937_64 random(std::uint64_t(Setting("DSPACE_FUZZ_SEED", 1.0)));
  const auto began = std::chrono::steady_clock::now();
  long runs = 0;
  for (; isLong || runs < 20000; ++runs) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - began;
    if (spent.count() > seconds) {
      break;
    }
    const std::string bytes = mutate(random);
    std::ofstream(name + ".failure", std::ios::binary) << bytes;
    run(bytes);
  }
  std::filesystem::remove(name + ".failure");
  std::printf("%ld inputs; none failed\n", runs);
  return 0;
}

} // namespace dspace::testing

#endif
