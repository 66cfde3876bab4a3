// What a test says when a Debian package that it needs is not installed.
#ifndef DSPACE_TEST_MISSING_PACKAGE_H
#define DSPACE_TEST_MISSING_PACKAGE_H

#include <cstdlib>
#include <string_view>

#include <gtest/gtest.h>

namespace dspace::testing {

// Whether a missing package is a failure (DSPACE_REQUIRE_ALL=1, which continuous integration sets).
inline bool RequiresAllPackages() {
  const char* value = std::getenv("DSPACE_REQUIRE_ALL");
  return value && std::string_view(value) == "1";
}

} // namespace dspace::testing

// Ends the test: it skips, or fails where all packages are required.
#define DSPACE_MISSING_PACKAGE(package)                                                            \
  if (dspace::testing::RequiresAllPackages()) {                                                    \
    FAIL() << package " is not installed, and DSPACE_REQUIRE_ALL=1 accepts no skip for that";      \
  }                                                                                                \
  GTEST_SKIP() << package " is not installed"

#endif
