// Benchmarks of windows: without a display the program starts itself again on one of its own.
#ifndef DSPACE_BENCH_WITH_DISPLAY_H
#define DSPACE_BENCH_WITH_DISPLAY_H

#include <cstdio>
#include <cstdlib>

#include <unistd.h>

namespace dspace::bench {

// Returns if there is a display; otherwise the program runs anew, or ends with a message.
inline void NeedDisplay(const char* program) {
  if (std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY") || std::getenv("QT_QPA_PLATFORM")) {
    return;
  }
  execl(DSPACE_WITH_DISPLAY, DSPACE_WITH_DISPLAY, program, static_cast<char*>(nullptr));
  std::printf("%s cannot be started\n", DSPACE_WITH_DISPLAY);
  std::exit(1);
}

} // namespace dspace::bench

#endif
