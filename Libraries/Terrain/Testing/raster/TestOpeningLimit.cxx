// Reading a raster while it is opened ends in time under a guard, and gives what it gives without.
#include <chrono>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/Budgets.h>
#include <dspace/Error.h>
#include <dspace/FilesRead.h>
#include <dspace/raster/ElevationSource.h>
#include <dspace/raster/OpeningLimit.h>

#include "RasterFile.h"

namespace {

using namespace dspace;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

RasterFile Rough() {
  RasterFile file;
  file.width = 150;
  file.height = 131;
  file.type = GDT_Float32;
  file.geotransform = {0, 1, 0, 0, 0, -1};
  file.value = [](int c, int r, int) { return double((c * 7919 + r * 104729) % 1000); };
  return file;
}

void ExpectSame(const std::vector<double>& a, const std::vector<double>& b, int factor) {
  ASSERT_EQ(a.size(), b.size());
  int other = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    other += a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])) ? 0 : 1;
  }
  EXPECT_EQ(other, 0) << "factor " << factor;
}

TEST(OpeningLimit, ChangesNoValue) {
  const TemporaryFolder folder;
  const std::string path = Rough().Write(folder / "rough.tif");
  for (const bool overviews : {false, true}) {
    if (overviews) {
      auto* file = static_cast<GDALDataset*>(GDALOpen(path.c_str(), GA_Update)); // NOLINT
      std::array<int, 2> levels = {2, 4};
      ASSERT_EQ(file->BuildOverviews("AVERAGE", 2, levels.data(), 0, nullptr, nullptr, nullptr),
                CE_None);
      GDALClose(file);
    }
    const ElevationSource source(path);
    for (const RasterWindow& window :
         {RasterWindow{0, 0, 150, 131}, RasterWindow{3, 5, 101, 97}, RasterWindow{8, 16, 64, 64}}) {
      for (const int factor : {1, 2, 4, 8, 16}) {
        const std::vector<double> free = source.ReadReduced(window, factor);
        const FilesGuard guard([](const std::string&) {});
        const OpeningLimit limit;
        ASSERT_TRUE(OpeningLimit::IsActive());
        ExpectSame(source.ReadReduced(window, factor), free, factor);
      }
    }
  }
}

TEST(OpeningLimit, EndsReadingUnderAGuardAlone) {
  const TemporaryFolder folder;
  const ElevationSource source(Rough().Write(folder / "rough.tif"));
  SetBudget("open_seconds", 1);
  const auto read = [&] {
    const OpeningLimit limit;
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    const OpeningLimit within; // of the outer one's time
    return source.ReadReduced({0, 0, 150, 131}, 2).size();
  };
  EXPECT_EQ(read(), 75u * 66u); // a local session
  {
    const FilesGuard guard([](const std::string&) {});
    try {
      read();
      ADD_FAILURE() << "it was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::Resource);
      EXPECT_NE(std::string(error.what()).find("rough.tif"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("the limit open_seconds is 1"), std::string::npos)
          << error.what();
    }
    EXPECT_FALSE(OpeningLimit::IsActive());
    EXPECT_EQ(source.ReadReduced({0, 0, 150, 131}, 2).size(), 75u * 66u); // opened before
  }
  SetBudget("open_seconds", Budgets()[static_cast<std::size_t>(Budget::OpenSeconds)].standard);
}

} // namespace
