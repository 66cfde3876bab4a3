// Whether the libraries under test are built with the address sanitizer. The test programs are the
// same in both cases: `./dspace test` runs them with the release libraries, and those without
// graphics also with libraries from build/sanitize.
#pragma once

#include <dlfcn.h>

namespace dspace::testing {

inline bool Sanitized() {
  return dlsym(RTLD_DEFAULT, "__asan_init") != nullptr;
}

} // namespace dspace::testing
