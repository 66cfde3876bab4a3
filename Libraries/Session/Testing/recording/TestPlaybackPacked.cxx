// Files of a recording where it is played: packed ones are unpacked, others must be what they were.
#include <sys/stat.h>

#include "PackedTestSupport.h"

namespace dspace::testing {
namespace {

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
      EXPECT_EQ(Content(files.Locate(this->Here_ / name)), Content(this->Root_ / "away" / name));
    }
    EXPECT_NE(Content(files.Locate(this->Here_ / "ground.vrt")),
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
  this->Rejects(Error::Kind::Corrupt, {this->Path_, material.string(), "has changed",
                                       "accepted: its " + std::to_string(before.size())});
  {
    RecordingReader reader(this->Path_);
    Interpreter shown;
    session::Playback unchecked(reader, shown, false);
    EXPECT_NE(this->Seen(shown, {}), live);
    EXPECT_EQ(unchecked.Files().Folder(), "");
    EXPECT_EQ(unchecked.Files().Locate("/a"), "/a");
  }
  fs::remove(material);
  this->Rejects(Error::Kind::NotFound, {material.string(), "is missing"});
  Write(material, before);
  EXPECT_EQ(this->Played(), live);
  // A source that only the mosaic names.
  Write(this->Here_ / "a&b.asc", Content(this->Here_ / "a&b.asc") + "\n");
  this->Rejects(Error::Kind::Corrupt, {"a&b.asc", "has changed"});
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
  this->Rejects(Error::Kind::Corrupt, {"part.mtl", "did not exist"});
}

TEST_F(PlaybackPacked, DamagedContentIsRejectedByName) {
  this->Record(true);
  const std::string whole = Content(this->Path_);
  const std::string material = (this->Here_ / "part.mtl").string();
  const std::string of = " WHERE asset = (SELECT id FROM asset WHERE path = '" + material + "')";
  for (const char* change : {"SET data = CAST(replace(data, 'Kd', 'Ks') AS BLOB)",
                             "SET size = size + 1", "SET place = 1", "SET checksum = x'00'"}) {
    this->Change("UPDATE content " + std::string(change) + of);
    this->Rejects(Error::Kind::Corrupt, {this->Path_, material, "is damaged at byte 0"});
    Write(this->Path_, whole);
  }
  this->Change("DELETE FROM content" + of);
  this->Rejects(Error::Kind::Corrupt, {material, "ends at byte 0 of"});
  Write(this->Path_, whole);
  this->Change("UPDATE asset SET size = 1 WHERE path = '" + material + "'");
  this->Rejects(Error::Kind::Corrupt, {"asset", "is damaged"});
  Write(this->Path_, whole);
  this->Played();
}

} // namespace
} // namespace dspace::testing
