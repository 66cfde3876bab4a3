// Recordings whose structure is not one of Dspace's, as somebody might make them who means harm.
#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include <google/protobuf/stubs/logging.h>
#include <sqlite3.h>

#include <dspace/recording/Playback.h>
#include <dspace/recording/RecordingCheck.h>
#include <dspace/recording/RecordingFile.h>
#include <dspace/recording/RecordingSalvage.h>
#include <dspace/recording/RecordingWriter.h>

#include "CommandTestSupport.h"
#include "RecordingRows.h"

namespace dspace::testing {
namespace {

using session::Interpreter;
using session::RecordingReader;

class RecordingDefences : public CommandTest {
protected:
  // A scene, two frames and three steps, with a state after each command.
  void Record(const char* name = "rover") {
    std::remove(this->Path_.c_str());
    Interpreter interpreter;
    session::Ledger ledger(&interpreter.GetState());
    session::RecordingOptions options;
    options.snapshotCommands = 1;
    options.snapshotBytes = 1;
    session::RecordingWriter writer(this->Path_, ledger, 0.0, options);
    interpreter.AddListener([&](const v1::Command& command, const v1::Reply& reply) {
      ledger.Add(command, reply);
      EXPECT_EQ(writer.Add(command, reply, ledger), "");
    });
    v1::Command create, frame, time;
    create.mutable_create_scene();
    interpreter.Execute(create);
    frame.mutable_create_frame()->set_name(name);
    interpreter.Execute(frame);
    for (const double time_s : {1.0, 2.0, 3.0}) {
      time.mutable_set_time()->set_time_s(time_s);
      interpreter.Execute(time);
    }
  }
  void Change(const std::string& sql) const {
    const Database file(this->Path_);
    EXPECT_EQ(sqlite3_exec(file.Handle, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sql << ": " << sqlite3_errmsg(file.Handle);
  }
  template<class Work>
  void Rejected(Work work, Error::Kind kind, const std::vector<std::string>& words) {
    try {
      work();
      ADD_FAILURE() << words[0];
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), kind) << error.what();
      for (const std::string& word : words) {
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
      }
    }
  }
  std::string Bytes() const {
    std::ifstream in(this->Path_, std::ios::binary);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
  }
  void Write(const std::string& bytes) const {
    std::ofstream(this->Path_, std::ios::binary | std::ios::trunc) << bytes;
  }

  const TemporaryFolder Folder_;
  const std::string Path_ = this->Folder_ / "a.dspace";
};

TEST_F(RecordingDefences, TheTablesAreThoseOfARecording) {
  const std::string endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) ";
  const std::string content =
      "id INTEGER PRIMARY KEY, asset INTEGER NOT NULL, place INTEGER NOT NULL, "
      "size INTEGER NOT NULL, data BLOB NOT NULL, checksum BLOB NOT NULL";
  const std::string drop = "DROP TABLE content; ";
  const std::vector<std::pair<std::string, std::string>> changes = {
      {drop + "CREATE VIEW content AS " + endless +
           "SELECT i AS id, 1 AS asset, i AS place, 1 AS size, x'00' AS data, x'' AS checksum "
           "FROM n",
       "its view 'content'"},
      {"DROP TABLE snapshot; CREATE VIEW snapshot AS " + endless +
           "SELECT i AS seq, 0.0 AS time, 0.0 AS wall, 1 AS kind, x'' AS payload, x'' AS checksum "
           "FROM n",
       "its view 'snapshot'"},
      {"DROP TABLE meta; CREATE VIEW meta AS SELECT 'format' AS key, 1 AS value",
       "its view 'meta'"},
      {drop + "CREATE VIRTUAL TABLE content USING dbstat", "its table 'content'"},
      {drop + "CREATE TABLE content(id INTEGER PRIMARY KEY, asset INTEGER NOT NULL, "
              "place INTEGER NOT NULL, size INTEGER NOT NULL, "
              "data BLOB AS (zeroblob(900000000)), checksum BLOB NOT NULL)",
       "its table 'content'"},
      {drop + "CREATE TABLE content(" + content + ", CHECK(hex(zeroblob(400000000)) <> ''))",
       "its table 'content'"},
      {drop, "it lacks 'content'"},
      {"DROP INDEX step; CREATE INDEX step ON command(time)", "its index 'step'"},
      {"CREATE INDEX more ON command(hex(payload))", "its index 'more'"},
      {"CREATE TABLE other(a)", "its table 'other'"},
      {"CREATE TRIGGER t AFTER INSERT ON asset BEGIN DELETE FROM command; END", "its trigger 't'"}};
  for (const auto& [change, words] : changes) {
    this->Record();
    this->Change(change);
    this->Rejected([&] { RecordingReader reader(this->Path_); }, Error::Kind::Corrupt,
                   {words, this->Path_, "dspace log salvage"});
    const std::string out = this->Folder_ / "out.dspace";
    std::remove(out.c_str());
    EXPECT_EQ(session::SalvageRecording(this->Path_, out, [] {}).commands, 5u) << change;
  }
  this->Record();
  this->Change("PRAGMA page_size=4096; VACUUM"); // which changes no statement
  RecordingReader reader(this->Path_);
  EXPECT_EQ(reader.Last(), 5u);
}

// A tree whose inner pages all lead to the same page, six deep: more rows than could ever be read.
TEST_F(RecordingDefences, ATreeWithoutEndIsNotWalked) {
  constexpr std::size_t Size = 4096;
  constexpr int Cells = 300;
  for (const char* table : {"snapshot", "command", "content"}) {
    this->Record();
    this->Change("INSERT INTO content VALUES(1, 1, 0, 1, x'00', x'00')"); // a page of its own
    this->Change("PRAGMA journal_mode=DELETE; PRAGMA page_size=4096; VACUUM");
    std::size_t root = 0;
    {
      const Database file(this->Path_);
      file.Ask(std::string("SELECT rootpage FROM sqlite_master WHERE name = '") + table + "'", {},
               [&](sqlite3_stmt* row) { root = std::size_t(sqlite3_column_int64(row, 0)); });
    }
    std::string bytes = this->Bytes();
    ASSERT_EQ(bytes.size() % Size, 0u);
    const auto put = [](std::string& page, std::size_t at, std::uint64_t value, int count) {
      for (int i = count - 1; i >= 0; --i, value >>= 8) {
        page[at + std::size_t(i)] = char(value & 255);
      }
    };
    // The root's own content moves to a new page at the end.
    std::size_t below = bytes.size() / Size + 1;
    bytes += bytes.substr((root - 1) * Size, Size);
    for (int level = 0; level < 6; ++level) {
      std::string page(Size, '\0');
      page[0] = 5; // an inner page of a table: its cells are a child and a key
      put(page, 3, Cells, 2);
      put(page, 5, Size - 5 * Cells, 2);
      put(page, 8, below, 4);
      for (int cell = 0; cell < Cells; ++cell) {
        const std::size_t at = Size - 5 * std::size_t(cell + 1);
        put(page, 12 + 2 * std::size_t(cell), at, 2);
        put(page, at, below, 4);
        page[at + 4] = 1;
      }
      if (level == 5) {
        bytes.replace((root - 1) * Size, Size, page);
      } else {
        bytes += page;
        below = bytes.size() / Size;
      }
    }
    put(bytes, 28, bytes.size() / Size, 4); // the file's pages, as its head states
    this->Write(bytes);
    this->Rejected(
        [&] {
          RecordingReader reader(this->Path_);
          reader.Snapshots();
          reader.Count();
          reader.Parts();
        },
        Error::Kind::Corrupt, {this->Path_, "more steps than a file of its size"});
    this->Rejected(
        [&] {
          RecordingReader reader(this->Path_);
          session::CheckRecording(reader, [] {});
        },
        Error::Kind::Corrupt, {this->Path_});
  }
}

TEST_F(RecordingDefences, TheListOfLostCommandsIsChecked) {
  const auto lost = [this](const std::string& text) {
    this->Record();
    const Database file(this->Path_);
    sqlite3_stmt* put = nullptr;
    sqlite3_prepare_v2(file.Handle, "INSERT INTO meta VALUES('lost', ?)", -1, &put, nullptr);
    sqlite3_bind_text(put, 1, text.data(), int(text.size()), SQLITE_STATIC);
    EXPECT_EQ(sqlite3_step(put), SQLITE_DONE);
    sqlite3_finalize(put);
  };
  std::string many; // 20 MB
  for (int i = 1; many.size() < 20000000; i += 2) {
    many += std::to_string(i) + "-" + std::to_string(i) + " ";
  }
  for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
           {many, "more ranges than there are commands and snapshots"},
           {"5-7 6-9", "do not ascend"},
           {"8-9 2-3", "do not ascend"},
           {"3", "'3' is no range"},
           {"0-2", "'0-2' is no range"},
           {"5-4", "'5-4' is no range"},
           {"1-2x", "'1-2x' is no range"},
           {"harm", "'harm' is no range"},
           {std::string(1000, '9'), "is no range"}}) {
    lost(text);
    RecordingReader reader(this->Path_);
    this->Rejected([&] { reader.Lost(); }, Error::Kind::Corrupt, {"lost commands", words});
    this->Rejected([&] { session::StepsOf(reader); }, Error::Kind::Corrupt, {words});
  }
  lost(" 2-2  7-9 ");
  RecordingReader reader(this->Path_);
  using Ranges = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
  EXPECT_EQ(reader.Lost(), (Ranges{{2, 2}, {7, 9}}));
}

// What a process leaves that is killed when it has begun to record.
TEST_F(RecordingDefences, ARecordingThatWasJustBegunIsNotDamaged) {
  { session::RecordingFile file(this->Path_, 0, 64); } // its tables
  RecordingReader reader(this->Path_);
  session::CheckRecording(reader, [] {});
  EXPECT_EQ(reader.Last(), 0u);
  Interpreter shown;
  this->Rejected([&] { session::Playback playback(reader, shown); }, Error::Kind::NotFound,
                 {this->Path_, "it holds no steps yet"});
  this->Write("");
  this->Rejected([&] { RecordingReader none(this->Path_); }, Error::Kind::Unsupported,
                 {"it is empty", "killed in the first moments"});
  this->Change("PRAGMA page_size=65536; PRAGMA journal_mode=WAL");
  this->Rejected([&] { RecordingReader none(this->Path_); }, Error::Kind::Unsupported,
                 {"without a recording's tables", "killed in the first moments"});
  // Commands without any state are another matter.
  this->Record();
  this->Change("DELETE FROM snapshot");
  RecordingReader damaged(this->Path_);
  this->Rejected([&] { session::Playback playback(damaged, shown); }, Error::Kind::Corrupt,
                 {"no complete step"});
}

// --- Text that is not UTF-8
// -----------------------------------------------------------------------

// As earlier versions recorded the names of files in Latin-1: the row's checksum holds.
class ForeignRecording : public RecordingDefences {
protected:
  // Replaces bytes in the payloads of a table; the lengths stay.
  void Replace(const char* table, char letter, const std::string& from, const std::string& to) {
    const Database file(this->Path_);
    std::vector<std::pair<std::int64_t, std::string>> payloads;
    file.Ask(std::string("SELECT seq, payload FROM ") + table, {}, [&](sqlite3_stmt* row) {
      payloads.emplace_back(sqlite3_column_int64(row, 0), Blob(row, 1));
    });
    const auto update = [&](const char* column, std::int64_t seq, const std::string& value) {
      sqlite3_stmt* change = nullptr;
      const std::string sql =
          std::string("UPDATE ") + table + " SET " + column + " = ? WHERE seq = ?";
      sqlite3_prepare_v2(file.Handle, sql.c_str(), -1, &change, nullptr);
      sqlite3_bind_blob(change, 1, value.data(), int(value.size()), SQLITE_STATIC);
      sqlite3_bind_int64(change, 2, seq);
      EXPECT_EQ(sqlite3_step(change), SQLITE_DONE);
      sqlite3_finalize(change);
    };
    for (auto& [seq, payload] : payloads) {
      for (std::size_t at = 0; (at = payload.find(from, at)) != std::string::npos;) {
        payload.replace(at, from.size(), to);
      }
      update("payload", seq, payload);
      file.Ask(
          std::string("SELECT seq, time, wall, kind, payload FROM ") + table + " WHERE seq = ?",
          {seq},
          [&, &id = seq](sqlite3_stmt* row) { update("checksum", id, SumOfRow(row, letter)); });
    }
  }
};

TEST_F(ForeignRecording, PlaysOnAndSaysSo) {
  this->Record("Maest");
  this->Replace("command", 'C', "Maest", "M\xE4st!");
  this->Replace("snapshot", 'S', "Maest", "M\xE4st!");
  {
    v1::Command plain; // protobuf takes no such text
    const Database file(this->Path_);
    const google::protobuf::LogSilencer quiet;
    file.Ask("SELECT payload FROM command WHERE seq = 2", {},
             [&](sqlite3_stmt* row) { EXPECT_FALSE(plain.ParseFromString(Blob(row, 0))); });
  }
  RecordingReader reader(this->Path_);
  Interpreter shown;
  session::Playback playback(reader, shown);
  std::vector<std::string> notes = playback.TakeNotes();
  const auto there = [&] {
    return shown.FindScene("scene")->Frames().Find("M\xC3\xA4st!") != NoFrame;
  };
  playback.Seek(1.0); // by the command
  EXPECT_TRUE(there());
  playback.Seek(3.0);
  EXPECT_TRUE(there());
  playback.Seek(2.0); // by a state
  EXPECT_TRUE(there());
  EXPECT_EQ(playback.Steps().size(), 4u);
  for (std::string& note : playback.TakeNotes()) {
    notes.push_back(std::move(note));
  }
  const auto noted = [&](const std::string& word) {
    return std::count_if(notes.begin(), notes.end(), [&](const std::string& note) {
      return note.find(this->Path_) != std::string::npos && note.find(word) != std::string::npos &&
             note.find("not UTF-8") != std::string::npos;
    });
  };
  EXPECT_GE(noted("snapshot "), 1); // from which it began
  EXPECT_EQ(noted("snapshot ") + noted("command 2 "), std::ptrdiff_t(notes.size()));

  std::set<std::pair<std::uint64_t, bool>> expected; // by SQLite's own search
  {
    const Database file(this->Path_);
    for (const char* table : {"command", "snapshot"}) {
      file.Ask(std::string("SELECT seq FROM ") + table + " WHERE instr(payload, x'4DE4737421')", {},
               [&](sqlite3_stmt* row) {
                 expected.emplace(std::uint64_t(sqlite3_column_int64(row, 0)),
                                  std::string(table) == "snapshot");
               });
    }
  }
  EXPECT_EQ(expected.count({2, false}), 1u);
  EXPECT_GE(expected.size(), 2u); // and a state at least
  const session::ForeignRows found = session::CheckRecording(reader, [] {});
  EXPECT_EQ(found.rows, expected);
  EXPECT_EQ(found.Names()[0], "command 2");
  const std::string out = this->Folder_ / "out.dspace";
  const session::SalvageReport report = session::SalvageRecording(this->Path_, out, [] {});
  EXPECT_TRUE(report.IsComplete());
  EXPECT_EQ(report.foreign.rows, found.rows);
  RecordingReader salvaged(out);
  Interpreter again;
  session::Playback(salvaged, again).Seek(3.0);
  EXPECT_NE(again.FindScene("scene")->Frames().Find("M\xC3\xA4st!"), NoFrame);
}

// Each command once, however often it is executed.
TEST_F(ForeignRecording, ACommandIsNotedOnce) {
  this->Record("Maest");
  this->Replace("command", 'C', "Maest", "M\xE4st!");
  this->Change("DELETE FROM snapshot WHERE seq > 0");
  RecordingReader reader(this->Path_);
  Interpreter shown;
  session::Playback playback(reader, shown);
  for (const double time_s : {3.0, 1.0, 2.0, 0.0}) {
    playback.Seek(time_s);
    EXPECT_NE(shown.FindScene("scene")->Frames().Find("M\xC3\xA4st!"), NoFrame);
  }
  const std::vector<std::string> notes = playback.TakeNotes();
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("command 2 holds text that is not UTF-8"), std::string::npos) << notes[0];
  EXPECT_TRUE(playback.TakeNotes().empty());
}

TEST_F(ForeignRecording, SoundTextIsNotNoted) {
  this->Record("M\xC3\xA4st");
  RecordingReader reader(this->Path_);
  EXPECT_TRUE(session::CheckRecording(reader, [] {}).rows.empty());
  Interpreter shown;
  session::Playback playback(reader, shown);
  playback.Seek(3.0);
  EXPECT_TRUE(playback.TakeNotes().empty());
}

} // namespace
} // namespace dspace::testing
