// Files of netCDF whose head asks for gigabytes: the limit holds, and this process stays small.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <dspace/Budgets.h>
#include <dspace/Error.h>
#include <dspace/raster/ElevationSource.h>

#include "Sanitized.h"
#include "TemporaryFolder.h"

namespace {

using namespace dspace;
using dspace::testing::TemporaryFolder;

std::string BigEndian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes.push_back(char(value >> shift));
  }
  return bytes;
}

// The head of a classic netCDF file with one attribute of so many characters, of which few are
// there (netCDF classic format specification, "Unidata", 1.0): 20 kB.
std::string WriteAttribute(const std::string& path, std::uint32_t characters) {
  const std::string none = BigEndian(0) + BigEndian(0);
  std::ofstream(path, std::ios::binary)
      << "CDF\x01" << BigEndian(0) << none << BigEndian(0x0C) << BigEndian(1) << BigEndian(1)
      << std::string("a\0\0\0", 4) << BigEndian(2) << BigEndian(characters)
      << std::string(20000, '\0');
  return path;
}

// A raster of netCDF that is whole, with an attribute of so many characters.
std::string WriteWhole(const std::string& path, std::size_t characters = 1) {
  GDALAllRegister();
  GDALDriverManager& manager = *GetGDALDriverManager();
  GDALDriver* const netcdf = manager.GetDriverByName("netCDF");
  if (!netcdf) {
    return "";
  }
  GDALDataset* const memory =
      manager.GetDriverByName("MEM")->Create("", 8, 8, 1, GDT_Float32, nullptr);
  double place[] = {0, 1, 0, 8, 0, -1};
  memory->SetGeoTransform(place);
  memory->GetRasterBand(1)->Fill(5.0);
  memory->SetMetadataItem("NC_GLOBAL#text", std::string(characters, 'a').c_str());
  GDALClose(netcdf->CreateCopy(path.c_str(), memory, FALSE, nullptr, nullptr, nullptr));
  GDALClose(memory);
  return path;
}

std::string MessageOf(const std::string& path) {
  try {
    const ElevationSource source(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

long LargestMemory_kB() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST(OpeningProbe, KeepsTheMemoryOfASmallFileToTheLimit) {
  const TemporaryFolder folder;
  if (WriteWhole(folder / "whole.nc").empty()) {
    GTEST_SKIP() << "GDAL is without netCDF";
  }
  const std::string path = WriteAttribute(folder / "huge.nc", 0x7FFFFFFF);
  EXPECT_LT(std::filesystem::file_size(path), 30000u);
  const long before_kB = LargestMemory_kB();
  const std::string message = MessageOf(path);
  EXPECT_NE(message.find(path), std::string::npos) << message;
  EXPECT_NE(message.find("the limit open_memory is 536870912"), std::string::npos) << message;
  EXPECT_LT(LargestMemory_kB() - before_kB, 200000); // 4.2 GB without the trial
  rusage children = {};
  getrusage(RUSAGE_CHILDREN, &children);
  if (!dspace::testing::Sanitized()) { // whose memory cannot be limited
    EXPECT_GT(children.ru_maxrss, 0);
    EXPECT_LT(children.ru_maxrss, 1000000);
  }
}

TEST(OpeningProbe, LetsWholeFilesPassUnderTheLimit) {
  const TemporaryFolder folder;
  constexpr std::size_t Characters = std::size_t(32) << 20;
  const std::string path = WriteWhole(folder / "whole.nc", Characters);
  if (path.empty()) {
    GTEST_SKIP() << "GDAL is without netCDF";
  }
  EXPECT_EQ(MessageOf(path).find("open_memory"), std::string::npos) << MessageOf(path);
  if (dspace::testing::Sanitized()) {
    return;
  }
  ASSERT_GT(std::filesystem::file_size(path), Characters);
  SetBudget("open_memory", std::uint64_t(1) << 20);
  const std::string message = MessageOf(path);
  SetBudget("open_memory", Budgets()[static_cast<std::size_t>(Budget::OpenMemory)].standard);
  EXPECT_NE(message.find("the limit open_memory is 1048576"), std::string::npos) << message;
}

} // namespace
