// `./dspace test` runs the same test programs with the release libraries and with sanitized ones.
#include "Sanitized.h"

#include <fstream>
#include <iterator>
#include <string>

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <dspace/Utf8.h>

namespace dspace {

TEST(Sanitized, InstrumentedLibrariesAreLoadedExactlyWithTheSanitizer) {
  Dl_info library;
  ASSERT_NE(dladdr(reinterpret_cast<const void*>(&IsUtf8), &library), 0);
  std::ifstream file(library.dli_fname, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  ASSERT_FALSE(bytes.empty()) << library.dli_fname;
  const bool instrumented = bytes.find("__asan_report_load") != std::string::npos;
  EXPECT_EQ(testing::Sanitized(), instrumented) << library.dli_fname;
}

} // namespace dspace
