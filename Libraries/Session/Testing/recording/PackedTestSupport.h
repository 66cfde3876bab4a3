// A recording with files that name each other, in a folder of its own.
#ifndef DSPACE_PACKED_TEST_SUPPORT_H
#define DSPACE_PACKED_TEST_SUPPORT_H

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <sqlite3.h>

#include <dspace/recording/Playback.h>
#include <dspace/recording/RecordingWriter.h>

#include "CommandTestSupport.h"

namespace dspace::testing {

namespace fs = std::filesystem;
using session::Interpreter;
using session::RecordedFiles;
using session::RecordingReader;

inline std::string Content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

inline void Write(const fs::path& path, const std::string& content) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << content;
}

// The paths apart, which are the folder's.
inline std::string Without(std::string text, const std::string& what) {
  for (std::size_t at = 0; (at = text.find(what)) != std::string::npos;) {
    text.erase(at, what.size());
  }
  return text;
}

class PlaybackPacked : public CommandTest {
protected:
  PlaybackPacked() : Root_(Folder_.Path()), Path_(Root_ / "run.dspace"), Here_(Root_ / "here") {
    fs::create_directories(this->Root_ / "scratch");
    const char* before = std::getenv("TMPDIR");
    this->Before_ = before ? before : "";
    setenv("TMPDIR", (this->Root_ / "scratch").c_str(), 1);
  }
  ~PlaybackPacked() override {
    this->Before_.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", this->Before_.c_str(), 1);
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
  void Rejects(Error::Kind kind, const std::vector<std::string>& words) {
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

  const TemporaryFolder Folder_;
  const fs::path Root_;
  const std::string Path_;
  const fs::path Here_;
  std::string Before_;
};

} // namespace dspace::testing

#endif
