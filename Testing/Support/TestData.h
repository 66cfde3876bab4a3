// Where tests find real data and shipped data.
#ifndef DSPACE_TEST_DATA_H
#define DSPACE_TEST_DATA_H

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace dspace::testing {

// Folder of the real reference data ($DSPACE_DATA), or empty where it is absent.
inline std::string RealDataFolder() {
  const char* folder = std::getenv("DSPACE_DATA");
  return folder && std::filesystem::is_directory(folder) ? folder : "";
}

// Folder of the data that ships with Dspace.
inline std::string ShippedDataFolder() {
  const char* folder = std::getenv("DSPACE_SHIPPED_DATA");
  return folder ? folder : "Data";
}

} // namespace dspace::testing

// Names `variable` as the path of a real data file; skips the test, saying so, where it is absent.
#define DSPACE_REAL_DATA(variable, relative)                                                       \
  const std::string variable = dspace::testing::RealDataFolder() + "/" + (relative);               \
  if (!std::filesystem::exists(variable))                                                          \
  GTEST_SKIP() << "real data absent: set DSPACE_DATA to the folder that has " << (relative)

#endif
