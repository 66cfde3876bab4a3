// Cached overviews that are damaged, stale, of another raster or half-made; full disks; several
// builders.
#include <chrono>
#include <csignal>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <dspace/Error.h>

#include "CachedRaster.h"

namespace {

using namespace dspace;
using namespace dspace::testing;
using DamagedCache = CachedRaster;

TEST_F(DamagedCache, AFlippedByteIsFoundAndTheFileIsBuiltAnew) {
  const std::string path = this->File().Write(this->Folder / "flipped.tif");
  const std::string file = *this->Builder.Build(path);
  const auto size = std::streamoff(fs::file_size(file));
  std::mt19937 random(5);
  int atOpening = 0;
  int atReading = 0;
  for (int i = 0; i < 60; ++i) {
    const std::streamoff at = i < 20   ? std::streamoff(random() % 32)
                              : i < 40 ? size - 1 - std::streamoff(random() % 140)
                                       : std::streamoff(random() % std::uint64_t(size));
    {
      std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
      const int byte = bytes.seekg(at).get();
      bytes.seekp(at).put(char(byte ^ (1 << random() % 8)));
    }
    const ElevationSource source(path, this->Cached());
    if (source.Info().overviewsAreCached) {
      int errors = 0;
      for (const int factor : {2, 4, 8}) {
        try {
          const bool whole = errors == 0;
          const int wrong = WrongCells(source, {0, 0, Width, Height}, factor);
          EXPECT_EQ(wrong > 0, !whole) << at;
        } catch (const Error& error) {
          EXPECT_EQ(int(error.GetKind()), int(Error::Kind::Corrupt));
          EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
          ++errors; // once; what follows is read without it
        }
      }
      EXPECT_EQ(errors, 1) << at;
      EXPECT_FALSE(fs::exists(file));
      ++atReading;
    } else {
      EXPECT_NE(source.Info().warnings.back().find(file), std::string::npos);
      ++atOpening;
    }
    EXPECT_FALSE(this->Builder.Find(path));
    ASSERT_EQ(this->Builder.Build(path), file);
    ASSERT_EQ(WrongCells(ElevationSource(path, this->Cached())), 0);
  }
  EXPECT_GE(atOpening, 40);
  EXPECT_GT(atReading, 5);
}

TEST_F(DamagedCache, ADamagedTileIsFoundByBuildAndByVerify) {
  const std::string path = this->File().Write(this->Folder / "tile.tif");
  const std::string file = *this->Builder.Build(path);
  EXPECT_NO_THROW(ElevationCache::Verify(this->Builder.Entries().at(0)));
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(5000)
      .put('\x55')
      .put('\x55');
  EXPECT_THROW(ElevationCache::Verify(this->Builder.Entries().at(0)), Error);
  this->Builder.Build(path);
  EXPECT_NO_THROW(ElevationCache::Verify(this->Builder.Entries().at(0)));
}

TEST_F(DamagedCache, CutEmptyAndForeignFilesAreBuiltAnew) {
  const std::string path = this->File().Write(this->Folder / "cut.tif");
  RasterFile flat = this->File();
  flat.value = [](int, int, int) { return 1.0; };
  const std::string other = flat.Write(this->Folder / "other.tif");
  const std::string file = *this->Builder.Build(path);
  const std::string others = *this->Builder.Build(other);
  ASSERT_NE(file, others);
  const auto size = fs::file_size(file);
  const std::function<void()> harms[] = {
      [&] { fs::resize_file(file, size - 1); },
      [&] { fs::resize_file(file, size / 2); },
      [&] { fs::resize_file(file, 0); },
      [&] { std::ofstream(file, std::ios::app) << "more"; },
      [&] { std::ofstream(file) << std::string(5000, 'x'); },
      [&] { fs::copy_file(others, file, fs::copy_options::overwrite_existing); },
  };
  for (const auto& harm : harms) {
    harm();
    EXPECT_FALSE(this->Builder.Find(path));
    EXPECT_FALSE(ElevationSource(path, this->Cached()).Info().overviewsAreCached);
    ASSERT_EQ(this->Builder.Build(path), file);
    EXPECT_EQ(this->Builder.Find(path), file);
    ASSERT_EQ(WrongCells(ElevationSource(path, this->Cached())), 0);
  }
  // Cut while open.
  const ElevationSource source(path, this->Cached());
  fs::resize_file(file, 100);
  EXPECT_THROW(source.ReadReduced({0, 0, Width, Height}, 8), Error);
}

TEST_F(DamagedCache, AChangedRasterIsNotShownByItsOldOverviews) {
  const std::string path = this->File().Write(this->Folder / "changes.tif");
  const std::string file = *this->Builder.Build(path);
  RasterFile changed = this->File();
  changed.value = [](int c, int r, int) { return Value(c, r) == NoData ? NoData : 7.0; };
  changed.Write(path); // as large as before
  fs::last_write_time(path, fs::last_write_time(path) + std::chrono::seconds(3));
  EXPECT_FALSE(this->Builder.Find(path));
  const ElevationSource source(path, this->Cached());
  EXPECT_FALSE(source.Info().overviewsAreCached);
  EXPECT_EQ(this->Builder.Build(path), file); // in the old one's place
  EXPECT_EQ(this->Files(this->Overviews), 1);
  const ElevationSource fresh(path, this->Cached());
  const auto value = [](int c, int r) { return Value(c, r) == NoData ? NoData : 7.0; };
  EXPECT_EQ(WrongCells(fresh, {0, 0, Width, Height}, 4, value), 0);
}

TEST_F(DamagedCache, ACancelledBuildLeavesNothing) {
  const std::string path = this->File().Write(this->Folder / "cancelled.tif");
  EXPECT_FALSE(this->Builder.Build(path, {}, [](double part) { return part < 0.5; }));
  EXPECT_EQ(this->Files(this->Overviews), 0);
  EXPECT_EQ(this->Builder.SizeBytes(), 0u);
}

TEST_F(DamagedCache, AFullDiskIsToldAndLeavesNothing) {
  const std::string path = this->File().Write(this->Folder / "full.tif");
  const auto rejected = [&] {
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{60000, before.rlim_max};
    auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &small);
    std::string message = "was built";
    try {
      this->Builder.Build(path);
    } catch (const Error& error) {
      message = error.what();
      EXPECT_EQ(int(error.GetKind()), int(Error::Kind::Io)) << message;
    }
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_NE(message.find(this->Overviews), std::string::npos) << message;
    EXPECT_NE(message.find("File too large"), std::string::npos) << message;
  };
  rejected();
  EXPECT_EQ(this->Files(this->Overviews), 0);
  // What was there stays.
  const std::string file = *this->Builder.Build(path);
  fs::last_write_time(path, fs::last_write_time(path) + std::chrono::seconds(3));
  const auto size = fs::file_size(file);
  rejected();
  EXPECT_EQ(this->Files(this->Overviews), 1);
  EXPECT_EQ(fs::file_size(file), size);
}

TEST_F(DamagedCache, AFolderThatIsNoneIsNamed) {
  const std::string path = this->File().Write(this->Folder / "a.tif");
  std::ofstream(this->Folder / "file") << "no folder";
  try {
    ElevationCache(this->Folder / "file/cache").Build(path);
    FAIL() << "was built";
  } catch (const Error& error) {
    EXPECT_EQ(int(error.GetKind()), int(Error::Kind::Io)) << error.what();
    EXPECT_NE(std::string(error.what()).find(this->Folder / "file"), std::string::npos);
  }
  EXPECT_THROW(ElevationCache(""), Error);
}

TEST_F(DamagedCache, SeveralProcessesBuildAtOnce) {
  const std::string path = this->File().Write(this->Folder / "shared.tif");
  std::vector<pid_t> children;
  for (int i = 0; i < 3; ++i) {
    const pid_t child = ::fork();
    if (child == 0) {
      int wrong = 0;
      for (int k = 0; k < 6; ++k) {
        try {
          const std::string file = *this->Builder.Build(path);
          const ElevationSource source(path, this->Cached());
          // Another may have removed it just now; once open, it stays.
          wrong += source.Info().overviewsAreCached ? WrongCells(source) : 0;
          fs::remove(file); // so that the next round builds while others read
        } catch (const Error& error) {
          std::fprintf(stderr, "%s\n", error.what());
          ++wrong;
        }
      }
      ::_exit(wrong == 0 ? 0 : 1);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  ASSERT_TRUE(this->Builder.Build(path));
  EXPECT_EQ(this->Files(this->Overviews), 1);
  EXPECT_EQ(WrongCells(ElevationSource(path, this->Cached())), 0);
}

} // namespace
