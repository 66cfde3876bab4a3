// Packed recordings as somebody might make them who means harm.
#include <algorithm>
#include <set>

#include <openssl/sha.h>
#include <zlib.h>

#include <dspace/recording/RecordedNames.h>
#include <dspace/recording/RecordingFile.h>

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

TEST_F(ForgedPacked, RefusesNamesThatAreNone) {
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
    this->Refuses(Error::Kind::Corrupt, {"'" + last.substr(0, 2)});
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
  this->Refuses(Error::Kind::Corrupt, {"/bomb", "is damaged at byte 0"});
}

// Every part of SQLite's that is no table could run without end.
TEST_F(ForgedPacked, RefusesViews) {
  this->Forge({});
  this->Change("DROP TABLE asset; CREATE VIEW asset AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL "
               "SELECT id + 1 FROM n) SELECT id, '/a' AS path, 'read' AS state, 0 AS size, x'' AS "
               "sha256, 0 AS packed, x'' AS checksum FROM n");
  this->Refuses(Error::Kind::Corrupt, {this->Path_});
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
