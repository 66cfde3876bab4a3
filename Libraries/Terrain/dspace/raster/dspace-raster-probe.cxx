// Started by ProbeOpening (OpeningProbe.h), never by people: opens a dataset with little memory.
//   dspace-raster-probe PATH FLAGS BYTES
// Exit code: 0: it is open; 1: not, and the standard output says why.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include <cpl_error.h>
#include <dlfcn.h>
#include <gdal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace {

constexpr unsigned Seconds = 60;

void Limit(int resource, rlim_t value) {
  const rlimit limit = {value, value};
  setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

// More than this process has now.
void LimitMemory(rlim_t bytes) {
  if (dlsym(RTLD_DEFAULT, "__asan_init")) { // its shadow memory needs the address space
    return;
  }
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  Limit(RLIMIT_AS, bytes + pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)));
}

} // namespace

int main(int count, char** words) {
  if (count != 4) {
    return 1;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  Limit(RLIMIT_CORE, 0);
  Limit(RLIMIT_FSIZE, 0);
  Limit(RLIMIT_CPU, Seconds);
  alarm(Seconds);
  GDALAllRegister();
  CPLSetErrorHandler(CPLQuietErrorHandler);
  LimitMemory(std::strtoull(words[3], nullptr, 10));
  const auto flags = static_cast<unsigned>(std::strtoul(words[2], nullptr, 10));
  if (GDALOpenEx(words[1], flags, nullptr, nullptr, nullptr)) {
    return 0;
  }
  std::fputs(CPLGetLastErrorMsg(), stdout);
  return 1;
}
