// Files of a recording where it is played: packed ones are unpacked, others must be what they were.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include <openssl/sha.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <zlib.h>

#include <dspace/session/Playback.h>
#include <dspace/session/RecordedNames.h>
#include <dspace/session/RecordingFile.h>
#include <dspace/session/RecordingWriter.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

namespace fs = std::filesystem;
using session::Interpreter;
using session::RecordedFiles;
using session::RecordingReader;

std::string Content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

void Write(const fs::path& path, const std::string& content) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << content;
}

// The paths apart, which are the folder's.
std::string Without(std::string text, const std::string& what) {
  for (std::size_t at = 0; (at = text.find(what)) != std::string::npos;) {
    text.erase(at, what.size());
  }
  return text;
}

class PlaybackPacked : public CommandTest {
protected:
  PlaybackPacked()
      : Root_(::testing::TempDir() + "packed_" + std::to_string(getpid())),
        Path_(Root_ / "run.dspace"), Here_(Root_ / "here") {
    fs::remove_all(this->Root_);
    fs::create_directories(this->Root_ / "scratch");
    const char* before = std::getenv("TMPDIR");
    this->Before_ = before ? before : "";
    setenv("TMPDIR", (this->Root_ / "scratch").c_str(), 1);
  }
  ~PlaybackPacked() override {
    this->Before_.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", this->Before_.c_str(), 1);
    fs::remove_all(this->Root_);
  }

  // A model with its material, a picture that this names, and a height grid that a mosaic names by
  // its absolute name, with a letter that XML writes otherwise.
  void MakeFiles() const {
    Write(this->Here_ / "part.obj", "mtllib part.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                    "f 1 2 3\n");
    Write(this->Here_ / "part.mtl", "newmtl m\nKd 1 0.5 0\n");
    Write(this->Here_ / "a&b.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n"
                                   "1 2 3\n4 5 6\n7 8 9\n");
    Write(this->Here_ / "ground.vrt",
          "<VRTDataset rasterXSize=\"3\" rasterYSize=\"3\">"
          "<GeoTransform>0, 1, 0, 3, 0, -1</GeoTransform>"
          "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource>"
          "<SourceFilename relativeToVRT=\"0\">" +
              (this->Here_ / "a&amp;b.asc").string() +
              "</SourceFilename><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"3\" ySize=\"3\"/>"
              "<DstRect xOff=\"0\" yOff=\"0\" xSize=\"3\" ySize=\"3\"/>"
              "</SimpleSource></VRTRasterBand></VRTDataset>");
  }

  // What there is to see: everything about the scene, colours and triangles, heights of the ground.
  std::string Seen(Interpreter& interpreter, const std::string& folder) const {
    std::ostringstream text;
    text << PictureOf(interpreter);
    for (const auto& object : interpreter.FindScene("scene")->Objects()) {
      for (const Part& part : object.second.levels.at(0).parts) {
        text << " colour " << part.material->color[0] << " " << part.material->color[1] << " "
             << part.material->color[2] << " triangles " << part.mesh->indices.size() / 3;
      }
    }
    v1::Command query;
    query.mutable_query_terrain()->set_terrain("ground");
    query.mutable_query_terrain()->set_height(true);
    for (const double value : {0.5, -0.25, -1.0, 1.0}) {
      query.mutable_query_terrain()->add_point(value);
    }
    const v1::Reply heights = interpreter.Execute(query);
    text << heights.DebugString();
    EXPECT_EQ(heights.terrain_values().height_size(), 2) << heights.DebugString();
    return folder.empty() ? text.str() : Without(text.str(), folder);
  }

  std::string Record(bool pack) {
    this->MakeFiles();
    Interpreter interpreter;
    session::Ledger ledger(&interpreter.GetState());
    session::RecordingOptions options;
    options.pack = pack;
    session::RecordingWriter writer(this->Path_, ledger, 0.0, options,
                                    &interpreter.GetState().files);
    interpreter.AddListener([&](const v1::Command& command, const v1::Reply& reply) {
      ledger.Add(command, reply);
      EXPECT_EQ(writer.Add(command, reply, ledger), "");
    });
    const auto run = [&](const auto& fill) {
      v1::Command command;
      fill(command);
      const v1::Reply reply = interpreter.Execute(command);
      EXPECT_FALSE(reply.has_error()) << reply.error().message();
    };
    run([](v1::Command& c) { c.mutable_create_scene(); });
    run([&](v1::Command& c) {
      c.mutable_import_object()->add_level()->set_path(this->Here_ / "part.obj");
    });
    run([&](v1::Command& c) {
      c.mutable_open_terrain()->set_name("ground");
      c.mutable_open_terrain()->set_path(this->Here_ / "ground.vrt");
      c.mutable_open_terrain()->set_crs("LOCAL_CS[\"flat\",UNIT[\"metre\",1]]");
    });
    run([](v1::Command& c) { c.mutable_set_time()->set_time_s(1.0); });
    return this->Seen(interpreter, {});
  }

  void Change(const std::string& sql) {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(this->Path_.c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
  }

  // Playing it is refused, with all of these words.
  void Refuses(Error::Kind kind, const std::vector<std::string>& words) {
    try {
      RecordingReader reader(this->Path_);
      Interpreter shown;
      const session::Playback playback(reader, shown);
      ADD_FAILURE() << words[0];
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), kind) << error.what();
      for (const std::string& word : words) {
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
      }
    }
    EXPECT_TRUE(fs::is_empty(this->Root_ / "scratch"));
  }

  std::string Played() {
    RecordingReader reader(this->Path_);
    Interpreter shown;
    session::Playback playback(reader, shown);
    playback.Step(100);
    return this->Seen(shown, playback.Files().Folder());
  }

  const fs::path Root_;
  const std::string Path_;
  const fs::path Here_;
  std::string Before_;
};

TEST_F(PlaybackPacked, ReplaysWhereNoneOfItsFilesAre) {
  const std::string live = this->Record(true);
  EXPECT_NE(live.find("colour 1 0.5 0 triangles 1"), std::string::npos) << live;  // of the material
  EXPECT_NE(live.find("height: 6.25\n  height: 1\n"), std::string::npos) << live; // of the mosaic
  EXPECT_EQ(this->Played(), live);
  fs::rename(this->Here_, this->Root_ / "away");
  EXPECT_EQ(this->Played(), live);
  // As they were, below a folder that nobody else may read and that goes with the playback.
  {
    RecordingReader reader(this->Path_);
    RecordedFiles files(reader);
    struct stat state = {};
    ASSERT_EQ(stat(files.Folder().c_str(), &state), 0);
    EXPECT_EQ(state.st_mode & 0777, 0700u);
    for (const char* name : {"part.obj", "part.mtl", "a&b.asc"}) {
      EXPECT_EQ(Content(files.Place(this->Here_ / name)), Content(this->Root_ / "away" / name));
    }
    EXPECT_NE(Content(files.Place(this->Here_ / "ground.vrt")),
              Content(this->Root_ / "away/ground.vrt")); // its absolute name is another
  }
  EXPECT_TRUE(fs::is_empty(this->Root_ / "scratch"));
}

TEST_F(PlaybackPacked, WithoutPackingFilesMustBeWhatTheyWere) {
  const std::string live = this->Record(false);
  EXPECT_EQ(this->Played(), live);
  const fs::path material = this->Here_ / "part.mtl";
  const std::string before = Content(material);
  Write(material, "newmtl m\nKd 1 0.6 0\n"); // as many bytes
  this->Refuses(Error::Kind::Corrupt, {this->Path_, material.string(), "has changed",
                                       "accepted: its " + std::to_string(before.size())});
  {
    RecordingReader reader(this->Path_);
    Interpreter shown;
    session::Playback unchecked(reader, shown, false);
    EXPECT_NE(this->Seen(shown, {}), live);
    EXPECT_EQ(unchecked.Files().Folder(), "");
    EXPECT_EQ(unchecked.Files().Place("/a"), "/a");
  }
  fs::remove(material);
  this->Refuses(Error::Kind::NotFound, {material.string(), "is not there"});
  Write(material, before);
  EXPECT_EQ(this->Played(), live);
  // A source that only the mosaic names.
  Write(this->Here_ / "a&b.asc", Content(this->Here_ / "a&b.asc") + "\n");
  this->Refuses(Error::Kind::Corrupt, {"a&b.asc", "has changed"});
}

TEST_F(PlaybackPacked, WhatWasNotThereMayNotBeThereNow) {
  this->MakeFiles();
  fs::remove(this->Here_ / "part.mtl");
  {
    Interpreter interpreter;
    session::Ledger ledger(&interpreter.GetState());
    v1::Command scene;
    scene.mutable_create_scene();
    ledger.Add(scene, interpreter.Execute(scene));
    v1::Command load;
    load.mutable_import_object()->add_level()->set_path(this->Here_ / "part.obj");
    ledger.Add(load, interpreter.Execute(load));
    const session::RecordingWriter writer(this->Path_, ledger, 0.0, {},
                                          &interpreter.GetState().files);
  }
  RecordingReader reader(this->Path_);
  { const RecordedFiles whole(reader); }
  Write(this->Here_ / "part.mtl", "newmtl m\nKd 1 1 1\n");
  this->Refuses(Error::Kind::Corrupt, {"part.mtl", "was not there"});
}

TEST_F(PlaybackPacked, DamagedContentIsRefusedByName) {
  this->Record(true);
  const std::string whole = Content(this->Path_);
  const std::string material = (this->Here_ / "part.mtl").string();
  const std::string of = " WHERE asset = (SELECT id FROM asset WHERE path = '" + material + "')";
  for (const char* change : {"SET data = CAST(replace(data, 'Kd', 'Ks') AS BLOB)",
                             "SET size = size + 1", "SET place = 1", "SET checksum = x'00'"}) {
    this->Change("UPDATE content " + std::string(change) + of);
    this->Refuses(Error::Kind::Corrupt, {this->Path_, material, "is damaged at byte 0"});
    Write(this->Path_, whole);
  }
  this->Change("DELETE FROM content" + of);
  this->Refuses(Error::Kind::Corrupt, {material, "ends at byte 0 of"});
  Write(this->Path_, whole);
  this->Change("UPDATE asset SET size = 1 WHERE path = '" + material + "'");
  this->Refuses(Error::Kind::Corrupt, {"asset", "is damaged"});
  Write(this->Path_, whole);
  this->Played();
}

// Recordings that somebody made who means harm: every checksum holds.
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
    EXPECT_EQ(names.Mended(text), mended);
  }
}

} // namespace
} // namespace dspace::testing
