// Packed recordings as somebody might make them who means harm.
#include <algorithm>
#include <chrono>
#include <limits>
#include <set>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <openssl/sha.h>
#include <zlib.h>

#include <dspace/recording/RecordedNames.h>
#include <dspace/recording/RecordingCheck.h>
#include <dspace/recording/RecordingFile.h>
#include <dspace/recording/RecordingSalvage.h>

#include "PackedTestSupport.h"

namespace dspace::testing {
namespace {

// Every checksum holds.
class ForgedPacked : public PlaybackPacked {
protected:
  struct File {
    std::string path;
    std::string data;
    std::int64_t size = -1; // of the part; absent: that of the data
  };

  void Forge(const std::vector<File>& files) {
    fs::remove(this->Path_);
    session::RecordingWriter(this->Path_, session::Ledger(), 0.0).Flush();
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(this->Path_.c_str(), &database), SQLITE_OK);
    std::int64_t id = 0;
    for (const File& file : files) {
      session::RecordingAsset asset;
      asset.id = ++id;
      asset.path = file.path;
      asset.state = "read";
      asset.size = file.size < 0 ? std::int64_t(file.data.size()) : file.size;
      unsigned char sum[SHA256_DIGEST_LENGTH];
      SHA256(reinterpret_cast<const unsigned char*>(file.data.data()), file.data.size(), sum);
      asset.sha256.assign(reinterpret_cast<const char*>(sum), sizeof sum);
      asset.packed = true;
      session::RecordingContent part;
      part.id = part.asset = id;
      part.size = asset.size;
      part.data = file.data;
      Insert(database, "INSERT INTO asset VALUES(?,CAST(? AS TEXT),CAST(? AS TEXT),?,?,1,?)",
             {std::to_string(asset.id), asset.path, asset.state, std::to_string(asset.size),
              asset.sha256, session::RecordingChecksum(asset)},
             {0, 3});
      Insert(database, "INSERT INTO content VALUES(?,?,0,?,?,?)",
             {std::to_string(part.id), std::to_string(part.asset), std::to_string(part.size),
              part.data, session::RecordingChecksum(part)},
             {0, 1, 2});
    }
    sqlite3_close(database);
  }

  static void Insert(sqlite3* database, const char* sql, const std::vector<std::string>& values,
                     const std::set<int>& numbers) {
    sqlite3_stmt* row = nullptr;
    ASSERT_EQ(sqlite3_prepare_v2(database, sql, -1, &row, nullptr), SQLITE_OK);
    for (int i = 0; i < int(values.size()); ++i) {
      const std::string& value = values[std::size_t(i)];
      numbers.count(i)
          ? sqlite3_bind_int64(row, i + 1, std::stoll(value))
          : sqlite3_bind_blob(row, i + 1, value.data(), int(value.size()), SQLITE_TRANSIENT);
    }
    EXPECT_EQ(sqlite3_step(row), SQLITE_DONE) << sqlite3_errmsg(database);
    sqlite3_finalize(row);
  }
};

TEST_F(ForgedPacked, NothingIsWrittenOutsideOfItsFolder) {
  const fs::path victim = this->Root_ / "victim";
  Write(victim / "file", "untouched");
  fs::create_directory_symlink(victim, this->Root_ / "link");
  std::string up = "/x/";
  for (int i = 0; i < 40; ++i) {
    up += "../";
  }
  this->Forge({{victim / "file", "harm"},
               {"/../../../.." + victim.string() + "/2", "harm"},
               {this->Root_ / "link/3", "harm"},
               {"/a/./b/../../../../../4", "harm"},
               {up + victim.string().substr(1) + "/5", "harm"},
               {"//etc/passwd", "harm"}});
  {
    RecordingReader reader(this->Path_);
    const RecordedFiles files(reader);
    int inside = 0;
    for (const auto& each : fs::recursive_directory_iterator(this->Root_ / "scratch")) {
      EXPECT_FALSE(each.is_symlink());
      if (each.is_regular_file()) {
        ++inside;
        EXPECT_EQ(Content(each.path()), "harm");
      }
    }
    EXPECT_EQ(inside, 6);
  }
  EXPECT_TRUE(fs::is_empty(this->Root_ / "scratch"));
  EXPECT_EQ(Content(victim / "file"), "untouched");
  EXPECT_EQ(std::distance(fs::directory_iterator(victim), fs::directory_iterator()), 1);
}

TEST_F(ForgedPacked, RejectsNamesThatAreNone) {
  for (const std::vector<std::string>& names : {std::vector<std::string>{"relative"},
                                                {"../up"},
                                                {""},
                                                {std::string("/a\0b", 4)},
                                                {"/twice", "/./twice"},
                                                {"/a", "/a/b"},
                                                {"/a/b", "/a"},
                                                {"/"}}) {
    std::vector<File> files;
    for (const std::string& name : names) {
      files.push_back({name, "harm"});
    }
    this->Forge(files);
    const std::string last = *std::max_element(names.begin(), names.end());
    this->Rejects(Error::Kind::Corrupt, {"'" + last.substr(0, 2)});
  }
}

// Ten million zeros in a part that says it has a hundred.
TEST_F(ForgedPacked, APartGrowsToNoMoreThanItSays) {
  const std::string zeros(10000000, '\0');
  std::string small(100000, '\0');
  uLongf size = small.size();
  ASSERT_EQ(compress(reinterpret_cast<Bytef*>(small.data()), &size,
                     reinterpret_cast<const Bytef*>(zeros.data()), zeros.size()),
            Z_OK);
  small.resize(size);
  this->Forge({{"/bomb", small, 100}});
  this->Rejects(Error::Kind::Corrupt, {"/bomb", "is damaged at byte 0"});
}

// A hundred million zeros, of a file of a hundred kilobytes.
TEST_F(ForgedPacked, UnpacksNoMoreThanTheLimit) {
  std::vector<File> files;
  std::string zeros(std::size_t(session::RecordingPartBytes), '\0');
  std::string part(100000, '\0');
  uLongf size = part.size();
  ASSERT_EQ(compress(reinterpret_cast<Bytef*>(part.data()), &size,
                     reinterpret_cast<const Bytef*>(zeros.data()), zeros.size()),
            Z_OK);
  part.resize(size);
  const auto rejected = [this](std::uint64_t limit, Error::Kind kind, const std::string& words) {
    try {
      RecordingReader reader(this->Path_);
      reader.SetUnpackLimit(limit);
      Interpreter shown;
      const session::Playback playback(reader, shown);
      ADD_FAILURE() << words;
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), kind) << error.what();
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
    EXPECT_TRUE(fs::is_empty(this->Root_ / "scratch"));
  };
  this->Forge({{"/a", part, session::RecordingPartBytes}, {"/b", "content"}});
  const std::string total = std::to_string(session::RecordingPartBytes + 7);
  rejected(session::RecordingPartBytes + 6, Error::Kind::Resource,
           "has " + total + " bytes unpacked; accepted: up to " +
               std::to_string(session::RecordingPartBytes + 6) + ", the unpack limit");
  rejected(session::RecordingPartBytes + 7, Error::Kind::Corrupt, "'/a' has changed"); // its sum
  const std::int64_t large = std::int64_t(4) << 30;
  this->Forge({{"/bomb", part, large}});
  rejected(0, Error::Kind::Resource, "4294967296 bytes unpacked; accepted: up to 1");
  rejected(0, Error::Kind::Resource, "1 GiB and 20 times the recording's size");
  RecordingReader reader(this->Path_);
  for (int way = 0; way < 2; ++way) {
    try {
      way == 0 ? (void)session::CheckRecording(reader, [] {})
               : (void)session::SalvageRecording(this->Path_, this->Root_ / "out.dspace", [] {});
      ADD_FAILURE() << way;
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::Resource) << error.what();
    }
  }
  reader.SetUnpackLimit(std::uint64_t(8) << 30);
  try {
    session::CheckRecording(reader, [] {});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("'/bomb' is damaged"), std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(fs::exists(this->Root_ / "out.dspace"));
  std::vector<File> most(3, {"/", "x", std::numeric_limits<std::int64_t>::max()});
  for (std::size_t i = 0; i < most.size(); ++i) {
    most[i].path += std::to_string(i);
  }
  this->Forge(most); // their sum is beyond any number
  rejected(std::uint64_t(1) << 62, Error::Kind::Resource, "18446744073709551615 bytes unpacked");
}

TEST_F(ForgedPacked, UnpackingIsCancelled) {
  this->Forge({{"/a", "content"}});
  RecordingReader reader(this->Path_);
  EXPECT_THROW(RecordedFiles(reader, true, [] { throw Error(Error::Kind::Io, "a", "cancelled"); }),
               Error);
  EXPECT_TRUE(fs::is_empty(this->Root_ / "scratch"));
}

TEST_F(ForgedPacked, FoldersOfProcessesThatWereKilledAreRemoved) {
  this->Forge({{"/a", "content"}});
  const fs::path scratch = this->Root_ / "scratch";
  const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (const char* name : {"dspace-unpacked-old", "dspace-unpacked-used", "other"}) {
    Write(scratch / name / "file", "content");
    fs::last_write_time(scratch / name, old);
  }
  Write(scratch / "dspace-unpacked-new" / "file", "content");
  Write(this->Root_ / "away" / "file", "content");
  fs::create_directory_symlink(this->Root_ / "away", scratch / "dspace-unpacked-link");
  const int used = ::open((scratch / "dspace-unpacked-used").c_str(), O_RDONLY | O_DIRECTORY);
  ASSERT_EQ(::flock(used, LOCK_SH), 0);
  {
    RecordingReader reader(this->Path_);
    const RecordedFiles files(reader);
    EXPECT_FALSE(fs::exists(scratch / "dspace-unpacked-old"));
    for (const char* name : {"dspace-unpacked-used", "dspace-unpacked-new", "other"}) {
      EXPECT_TRUE(fs::exists(scratch / name / "file")) << name;
    }
    EXPECT_TRUE(fs::exists(this->Root_ / "away" / "file"));
    RecordingReader second(this->Path_); // which leaves the first one's alone
    fs::last_write_time(files.Folder(), old);
    const RecordedFiles others(second);
    EXPECT_TRUE(fs::exists(files.Folder()));
  }
  ::close(used);
}

// Every part of SQLite's that is no table could run without end.
TEST_F(ForgedPacked, RejectsViews) {
  this->Forge({});
  this->Change("DROP TABLE asset; CREATE VIEW asset AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL "
               "SELECT id + 1 FROM n) SELECT id, '/a' AS path, 'read' AS state, 0 AS size, x'' AS "
               "sha256, 0 AS packed, x'' AS checksum FROM n");
  this->Rejects(Error::Kind::Corrupt, {this->Path_});
}

TEST(RecordedNames, AreWholeValuesOfXmlOnly) {
  const session::RecordedNames names(
      {{"/d/a.tif", "/T/d/a.tif"}, {"/d/a", "/T/d/a"}, {"/d/it's & more", "/T/d/it's & more"}});
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"<S>/d/a.tif</S>", "<S>/T/d/a.tif</S>"},
      {"<S>/d/a</S><S>/d/a.tif</S>", "<S>/T/d/a</S><S>/T/d/a.tif</S>"},
      {"<m f=\"file:///d/a.tif\"/>", "<m f=\"file:///T/d/a.tif\"/>"},
      {"<m f='/d/a'/>", "<m f='/T/d/a'/>"},
      {"<S>/d/it's &amp; more</S>", "<S>/T/d/it's &amp; more</S>"},
      {"<S>/d/a.tiff</S> /d/a.tif <S>x/d/a</S>", "<S>/d/a.tiff</S> /d/a.tif <S>x/d/a</S>"},
      {"\"/d/a\"/d/a\"", "\"/T/d/a\"/T/d/a\""},
      {"", ""},
      {"\"", "\""},
      {"\"/d/a", "\"/d/a"}};
  for (const auto& [text, mended] : cases) {
    EXPECT_EQ(names.Rewritten(text), mended);
  }
}

} // namespace
} // namespace dspace::testing
