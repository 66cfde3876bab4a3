// Grids of datum shifts: noted where PROJ may use one, and found where a recording has brought
// them.
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/FilesRead.h>
#include <dspace/crs/Crs.h>
#include <dspace/crs/CrsTransform.h>
#include <dspace/crs/ProjFolders.h>

#include "MissingPackage.h"
#include "TemporaryFolder.h"

namespace dspace::testing {
namespace {

namespace fs = std::filesystem;

// Of the German DHDN, whose grid Debian's proj-data has; in degrees.
const Eigen::Vector2d Place(10.0, 50.0);

// The noted path of that grid; empty: it is not installed.
std::string GridOf(const FilesRead& files) {
  for (const auto& [path, stamp] : files) {
    if (path.find("BETA2007") != std::string::npos && stamp.size > 0) {
      return path;
    }
  }
  return {};
}

Eigen::Vector2d Shifted() {
  return CrsTransform(Crs::FromText("EPSG:4314"), Crs::FromText("EPSG:4326")).Apply(Place);
}

TEST(ProjGrids, AreNotedWhereADatumIsShifted) {
  const FilesReadScope scope;
  {
    const FilesGuard guard([](const std::string& path) {
      throw Error(Error::Kind::InvalidArgument, "file '" + path + "'", "is not allowed");
    });
    Shifted(); // a library's own: no command can choose it
  }
  const std::string grid = GridOf(scope.Files());
  if (grid.empty()) {
    DSPACE_MISSING_PACKAGE("proj-data"); // PROJ's grid BETA2007.gsb
  }
  EXPECT_TRUE(IsProjGrid(grid)) << grid;
  EXPECT_EQ(scope.Files().at(grid).size, std::int64_t(fs::file_size(grid)));
  // Once more: known by then, and noted all the same.
  const FilesReadScope again;
  Shifted();
  EXPECT_EQ(GridOf(again.Files()), grid);
}

TEST(ProjGrids, AbsentOnesAreNotedAsSuch) {
  const FilesReadScope scope;
  const CrsTransform american(Crs::FromText("EPSG:4267"), Crs::FromText("EPSG:4326"));
  EXPECT_GT(scope.Files().size(), 10u); // PROJ knows of many
  for (const auto& [path, stamp] : scope.Files()) {
    EXPECT_EQ(stamp.size < 0, !fs::exists(path)) << path;
    EXPECT_TRUE(IsProjGrid(path)) << path;
  }
}

TEST(ProjGrids, NoneIsOfOneDatumOrOfAnotherBody) {
  const FilesReadScope scope;
  const CrsTransform zone(Crs::FromText("EPSG:32633"), Crs::FromText("EPSG:4326"));
  const CrsTransform moon(Crs::FromText("+proj=eqc +R=1737400"),
                          Crs::FromText("+proj=longlat +R=1737400"));
  EXPECT_TRUE(scope.Files().empty()) << scope.Files().begin()->first;
}

// A copy of the grid whose latitudes are shifted by one second more, at every node.
TEST(ProjGrids, ThoseOfARecordingComeFirst) {
  std::string grid;
  Eigen::Vector2d before;
  {
    const FilesReadScope scope;
    before = Shifted();
    grid = GridOf(scope.Files());
  }
  if (grid.empty()) {
    DSPACE_MISSING_PACKAGE("proj-data"); // PROJ's grid BETA2007.gsb
  }
  std::ifstream in(grid, std::ios::binary);
  std::ostringstream read;
  read << in.rdbuf();
  std::string bytes = read.str();
  // NTv2: 11 records of 16 bytes for the file, 11 for its one grid, then four floats a node.
  std::int32_t nodes = 0;
  std::memcpy(&nodes, bytes.data() + 21 * 16 + 8, sizeof nodes);
  ASSERT_EQ(bytes.compare(21 * 16, 8, "GS_COUNT"), 0);
  ASSERT_GE(bytes.size(), std::size_t(22 + nodes) * 16);
  for (std::int32_t i = 0; i < nodes; ++i) {
    float seconds = 0;
    char* const at = bytes.data() + (22 + i) * 16;
    std::memcpy(&seconds, at, sizeof seconds);
    seconds += 1.0f;
    std::memcpy(at, &seconds, sizeof seconds);
  }
  const TemporaryFolder own;
  const fs::path folder = own.Path();
  std::ofstream(folder / fs::path(grid).filename(), std::ios::binary) << bytes;
  {
    const ProjFolders folders({folder.string()});
    const FilesReadScope scope;
    const Eigen::Vector2d shifted = Shifted();
    // Floats of some hundred seconds at most: to 3e-5 seconds.
    EXPECT_NEAR(shifted.y() - before.y(), 1.0 / 3600.0, 1e-8);
    EXPECT_NEAR(shifted.x(), before.x(), 1e-8);
    EXPECT_EQ(fs::path(GridOf(scope.Files())).parent_path(), folder);
  }
  EXPECT_EQ(Shifted(), before);
}

} // namespace
} // namespace dspace::testing
