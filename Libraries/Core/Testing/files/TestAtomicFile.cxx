#include <dspace/AtomicFile.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <dspace/Error.h>

#include "FullDisk.h"

namespace {

namespace fs = std::filesystem;
using dspace::AtomicFile;
using dspace::Error;
using dspace::testing::FullDisk;

std::string Content(const fs::path& path) {
  std::ostringstream all;
  all << std::ifstream(path, std::ios::binary).rdbuf();
  return all.str();
}

void Put(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

void Save(const fs::path& path, const std::string& text) {
  AtomicFile::Save(path.string(), text.data(), text.size());
}

mode_t ModeOf(const fs::path& path) {
  struct stat state = {};
  EXPECT_EQ(::stat(path.c_str(), &state), 0);
  return state.st_mode & 07777;
}

class TestAtomicFile : public ::testing::Test {
protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "dspace-atomic-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    this->Folder = fs::canonical(name);
  }
  void TearDown() override { fs::remove_all(this->Folder); }

  int Count() const {
    return int(std::distance(fs::directory_iterator(this->Folder), fs::directory_iterator()));
  }
  // `run` throws Error of the kind that names `path` and says `text`.
  template<class Run>
  static void Rejected(const Run& run, const fs::path& path, const std::string& text,
                       Error::Kind kind = Error::Kind::Io) {
    try {
      run();
      ADD_FAILURE() << path << " was written";
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(error.GetKind(), kind) << message;
      EXPECT_NE(message.find("file '" + path.string() + "'"), std::string::npos) << message;
      EXPECT_NE(message.find(text), std::string::npos) << message;
    }
  }
  static void Rejected(const fs::path& path, const std::string& text) {
    Rejected([&] { Save(path, "new"); }, path, text);
    Rejected([&] { AtomicFile::Check(path.string()); }, path, text);
  }

  fs::path Folder;
};

TEST_F(TestAtomicFile, AFileAppearsWhenItIsComplete) {
  const fs::path path = this->Folder / "a.bin";
  {
    AtomicFile file(path.string());
    file.Write("0123", 4);
    file.Write("4567", 4);
    file.WriteAt(2, "ab", 2);
    EXPECT_EQ(file.Bytes(), 8u);
    EXPECT_FALSE(fs::exists(path));
    EXPECT_EQ(fs::path(file.TemporaryPath()).parent_path(), this->Folder);
    file.Commit();
    EXPECT_EQ(Content(path), "01ab4567");
  }
  EXPECT_EQ(this->Count(), 1);
  Save(path, "");
  EXPECT_EQ(Content(path), "");
}

TEST_F(TestAtomicFile, AFileThatIsNotCommittedLeavesNothing) {
  const fs::path path = this->Folder / "a";
  Put(path, "before");
  {
    AtomicFile file(path.string());
    file.Write("new", 3);
    EXPECT_EQ(this->Count(), 2);
  }
  EXPECT_EQ(Content(path), "before");
  EXPECT_EQ(this->Count(), 1);
}

TEST_F(TestAtomicFile, AFullDiskLeavesTheFileAsItWas) {
  const fs::path path = this->Folder / "a";
  Put(path, "before");
  {
    const FullDisk full(1000);
    Rejected([&] { Save(path, std::string(2000, 'x')); }, path,
             "File too large; accepted: a folder with free space");
    Rejected(
        [&] {
          AtomicFile file(path.string());
          file.Write(std::string(900, 'x').data(), 900);
          file.Write(std::string(900, 'y').data(), 900);
        },
        path, "File too large");
    Save(this->Folder / "small", std::string(1000, 'z'));
  }
  EXPECT_EQ(Content(path), "before");
  EXPECT_EQ(this->Count(), 2);
  Save(path, std::string(2000, 'x'));
  EXPECT_EQ(Content(path), std::string(2000, 'x'));
}

TEST_F(TestAtomicFile, PathsThatCannotBeWrittenAreRejected) {
  Rejected(this->Folder / "none" / "a",
           "there is no folder '" + (this->Folder / "none").string() + "'");
  fs::create_directory(this->Folder / "folder");
  Rejected(this->Folder / "folder", "it is a folder");
  Put(this->Folder / "file", "before");
  Rejected(this->Folder / "file" / "a", "Not a directory");
  ASSERT_EQ(::mkfifo((this->Folder / "pipe").c_str(), 0600), 0);
  Rejected(this->Folder / "pipe", "a pipe");
  Rejected("/dev/full", "it is a device");
  Rejected("", "No such file");
  Rejected(this->Folder / std::string(256, 'x'), "File name too long");
  Rejected([&] { Save(this->Folder / std::string("a\0b", 3), "new"); }, this->Folder / "a",
           "zero byte", Error::Kind::InvalidArgument);
  EXPECT_EQ(this->Count(), 3);
  EXPECT_EQ(Content(this->Folder / "file"), "before");
  EXPECT_EQ(Content(this->Folder / "folder"), "");
}

// In another process, because the superuser may write everywhere.
TEST_F(TestAtomicFile, FoldersAndFilesWithoutPermissionAreRejected) {
  const fs::path locked = this->Folder / "locked";
  fs::create_directory(locked);
  Put(locked / "a", "before");
  Put(this->Folder / "b", "before");
  fs::permissions(locked / "a", fs::perms(0666));
  fs::permissions(this->Folder / "b", fs::perms(0444));
  fs::permissions(locked, fs::perms(0555));
  fs::permissions(this->Folder, fs::perms(0777));
  EXPECT_EXIT(
      {
        const bool given = ::geteuid() != 0 || ::seteuid(65534) == 0;
        Rejected([&] { Save(locked / "a", "new"); }, locked / "a", "Permission denied");
        Rejected([&] { Save(locked / "c", "new"); }, locked / "c", "Permission denied");
        Rejected(this->Folder / "b", "Permission denied");
        Save(this->Folder / "d", "new");
        std::_Exit(given && !::testing::Test::HasFailure() ? 7 : 1);
      },
      ::testing::ExitedWithCode(7), "");
  fs::permissions(locked, fs::perms(0755));
  EXPECT_EQ(Content(locked / "a"), "before");
  EXPECT_EQ(Content(this->Folder / "b"), "before");
  EXPECT_EQ(Content(this->Folder / "d"), "new");
  EXPECT_EQ(this->Count(), 3);
}

TEST_F(TestAtomicFile, TheLinkStaysAndItsFileIsReplaced) {
  const fs::path there = this->Folder / "there";
  fs::create_directory(there);
  Put(there / "file", "before");
  fs::create_symlink("there/file", this->Folder / "link");
  fs::create_symlink("link", this->Folder / "again");
  {
    AtomicFile file((this->Folder / "again").string());
    EXPECT_EQ(fs::path(file.TemporaryPath()).parent_path(), there); // where it is renamed
    file.Write("new", 3);
    file.Commit();
  }
  EXPECT_EQ(Content(there / "file"), "new");
  EXPECT_TRUE(fs::is_symlink(this->Folder / "link"));
  EXPECT_TRUE(fs::is_symlink(this->Folder / "again"));
  fs::create_symlink("there/none", this->Folder / "dangling");
  Rejected(this->Folder / "dangling", "accepted: a link to a file that exists");
  fs::create_symlink("loop", this->Folder / "loop");
  Rejected(this->Folder / "loop", "Too many levels");
  EXPECT_FALSE(fs::exists(there / "none"));
}

TEST_F(TestAtomicFile, LongNamesAreWritten) {
  for (const std::string& name : {std::string(255, 'x'), "." + std::string(254, 'x'),
                                  std::string(63, 'x') + "\u00e4\u00e4"}) {
    const fs::path path = this->Folder / name;
    {
      AtomicFile file(path.string());
      const std::string temporary = fs::path(file.TemporaryPath()).filename().string();
      const std::string target = AtomicFile::TargetName(temporary);
      EXPECT_EQ(target, name.substr(0, target.size()));
      EXPECT_EQ(target.size(), name[63] == '\xc3' ? 63u : 64u);
      file.Write("new", 3);
      file.Commit();
    }
    EXPECT_EQ(Content(path), "new");
  }
  EXPECT_EQ(this->Count(), 3);
}

TEST_F(TestAtomicFile, TheModeIsThatOfACreationOrOfTheFileBefore) {
  const mode_t before = ::umask(027);
  Save(this->Folder / "new", "new");
  ::umask(before);
  EXPECT_EQ(ModeOf(this->Folder / "new"), 0640u);
  fs::permissions(this->Folder / "new", fs::perms(0604));
  {
    AtomicFile file((this->Folder / "new").string());
    EXPECT_EQ(ModeOf(file.TemporaryPath()), 0604u);
    fs::remove(file.TemporaryPath()); // as a library that creates its files again
    Put(file.TemporaryPath(), "newer");
    file.Commit();
  }
  EXPECT_EQ(Content(this->Folder / "new"), "newer");
  EXPECT_EQ(ModeOf(this->Folder / "new"), 0604u);
}

TEST_F(TestAtomicFile, ALibraryMayWriteTheTemporaryFile) {
  const fs::path path = this->Folder / "a";
  Put(path, "before");
  {
    AtomicFile file(path.string());
    Put(file.TemporaryPath(), "by a library");
    file.Commit();
  }
  EXPECT_EQ(Content(path), "by a library");
  Rejected(
      [&] {
        AtomicFile file(path.string());
        fs::remove(file.TemporaryPath());
        file.Commit();
      },
      path, "No such file");
  EXPECT_EQ(Content(path), "by a library");
  EXPECT_EQ(this->Count(), 1);
}

TEST_F(TestAtomicFile, ATargetThatBecomesAFolderIsAnError) {
  const fs::path path = this->Folder / "a";
  Rejected(
      [&] {
        AtomicFile file(path.string());
        fs::create_directory(path);
        file.Commit();
      },
      path, "Is a directory");
  EXPECT_EQ(this->Count(), 1);
}

TEST_F(TestAtomicFile, OnlyItsOwnNamesAreOfTemporaryFiles) {
  EXPECT_EQ(AtomicFile::TargetName(".a.png.0123456789abcdef.part"), "a.png");
  for (const char* name : {"", ".part", "a.png", "a.png.part", ".a.png.0123456789abcde.part",
                           "a.png.0123456789abcdef.part", ".a.png.0123456789abcdeg.part",
                           ".a.png-0123456789abcdef.part", ".0123456789abcdef.part"}) {
    EXPECT_EQ(AtomicFile::TargetName(name), "") << name;
  }
}

} // namespace
