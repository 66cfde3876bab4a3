// The tiles of a map on several threads: interruptions, errors and what the file holds then.
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/maps/MapWork.h>

#include "MapTestSupport.h"

namespace dspace::testing {
namespace {

class MapWork : public ::testing::Test {
protected:
  static constexpr int Columns = 150; // 3 x 2 tiles
  static constexpr int Rows = 100;
  static constexpr int Bands = 2;

  MapWork() {
    this->Layout_.columns = Columns;
    this->Layout_.rows = Rows;
    this->Layout_.bands = {"first", "second"};
    this->Layout_.hash = 7;
  }
  std::string Path(const std::string& name) const { return (this->Folder_.Path() / name).string(); }
  static float ValueAt(int band, int column, int row) {
    return float(100000 * band + 256 * row + column);
  }
  static void Make(int column, int row, std::vector<float>& cells) {
    std::size_t at = 0;
    for (int b = 0; b < Bands; ++b) {
      for (int r = 0; r < TileFile::Side; ++r) {
        for (int c = 0; c < TileFile::Side; ++c) {
          cells[at++] = ValueAt(b, column * TileFile::Side + c, row * TileFile::Side + r);
        }
      }
    }
  }
  static void Wait(const std::atomic<bool>& stop) {
    while (!stop) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  TemporaryFolder Folder_;
  TileFileLayout Layout_;
};

TEST_F(MapWork, AnInterruptedFileGetsTheTilesThatItLacks) {
  const std::string path = this->Path("map.tif");
  {
    TileFile file(path, this->Layout_);
    std::atomic<int> begun = 0;
    MapControl control;
    control.threads = 1; // the third tile begins when two are written
    control.progress = [&](const MapProgress&) { return begun < 3; };
    EXPECT_FALSE(FillTiles(
        file, Bands, control,
        [&](int column, int row, std::vector<float>& cells, const std::atomic<bool>& stop) {
          if (++begun == 3) {
            Wait(stop);
            return;
          }
          Make(column, row, cells);
        }));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  ASSERT_TRUE(std::filesystem::exists(path + ".part"));
  // A kill may leave a part of an entry.
  std::ofstream(path + ".part.done", std::ios::binary | std::ios::app) << "torn";
  TileFileLayout other = this->Layout_;
  other.hash = 8;
  EXPECT_THROW(TileFile(path, other), Error);
  const auto fill = [](TileFile& file, int threads, std::atomic<int>& made) {
    MapControl control;
    control.threads = threads;
    return FillTiles(file, Bands, control,
                     [&](int column, int row, std::vector<float>& cells, const std::atomic<bool>&) {
                       Make(column, row, cells);
                       ++made;
                     });
  };
  {
    TileFile file(path, this->Layout_);
    int has = 0;
    for (int row = 0; row < file.TileRows(); ++row) {
      for (int column = 0; column < file.TileColumns(); ++column) {
        has += file.Has(column, row) ? 1 : 0;
      }
    }
    EXPECT_EQ(has, 2);
    std::atomic<int> made = 0;
    EXPECT_TRUE(fill(file, 3, made));
    EXPECT_EQ(made, 4);
  }
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  EXPECT_FALSE(std::filesystem::exists(path + ".part.done"));
  const auto bands = BandsOf(path);
  ASSERT_EQ(bands.size(), std::size_t(Bands));
  for (int b = 0; b < Bands; ++b) {
    for (int r = 0; r < Rows; ++r) {
      for (int c = 0; c < Columns; ++c) {
        ASSERT_EQ(bands[std::size_t(b)][std::size_t(r * Columns + c)], ValueAt(b, c, r));
      }
    }
  }
  const std::string whole = this->Path("whole.tif");
  {
    TileFile file(whole, this->Layout_);
    std::atomic<int> made = 0;
    EXPECT_TRUE(fill(file, 1, made));
    EXPECT_EQ(made, 6);
  }
  EXPECT_TRUE(BytesOf(path) == BytesOf(whole));
  EXPECT_THROW(TileFile(path, this->Layout_), Error); // it exists

  // The file to be replaced stays until the new one is whole.
  const auto before = BytesOf(path);
  { const TileFile broken(path, this->Layout_, true); }
  EXPECT_TRUE(BytesOf(path) == before);
  TileFile file(path, this->Layout_, true);
  std::atomic<int> made = 0;
  EXPECT_TRUE(fill(file, 1, made));
  EXPECT_TRUE(BytesOf(path) == BytesOf(whole));
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

TEST_F(MapWork, AnErrorOfOneTileEndsTheWork) {
  const std::string path = this->Path("map.tif");
  TileFile file(path, this->Layout_);
  for (const bool replace : {false, true}) { // one at a time writes to it
    EXPECT_THROW(TileFile(path, this->Layout_, replace), Error);
  }
  MapControl control;
  control.threads = 2;
  const MakeTile make = [](int column, int row, std::vector<float>&,
                           const std::atomic<bool>& stop) {
    if (column == 1 && row == 0) {
      throw Error(Error::Kind::Io, "tile", "it is damaged");
    }
    Wait(stop);
  };
  EXPECT_THROW(FillTiles(file, Bands, control, make), Error);
  EXPECT_FALSE(std::filesystem::exists(path));
  control.progress = [](const MapProgress&) -> bool {
    throw Error(Error::Kind::Io, "progress", "it ends the work");
  };
  control.threads = 1; // at the first tile
  EXPECT_THROW(FillTiles(file, Bands, control, make), Error);
  for (const int threads : {-1, 257}) {
    control.threads = threads;
    EXPECT_THROW(FillTiles(file, Bands, control, make), Error);
  }
}

} // namespace
} // namespace dspace::testing
