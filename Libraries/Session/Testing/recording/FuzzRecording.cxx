// What playback and salvage do with recordings from anywhere: every row is read, files are
// unpacked, steps are gone to, and what survives is put into a new recording, which must be sound.
// A fuzz target: input is a .dspace file's bytes. Nothing in it may crash, hang, throw anything but
// Error, or end in an error of Dspace's own (INTERNAL); and no command and no file of a row is
// accepted whose checksum, worked out here from Documentation/Recording.md, does not hold.
//
// With clang and -DDSPACE_LIBFUZZER=ON it is libFuzzer's program; else it has a driver of its own
// (FuzzDriver.h). That changes bytes of a recording, values of its rows, to which it gives the
// right checksum in half of the runs, and its tables, as somebody might who means harm.
#include <algorithm>
#include <limits>
#include <set>

#include <sqlite3.h>

#include <dspace/Error.h>
#include <dspace/FilesRead.h>
#include <dspace/messages/Confinement.h>
#include <dspace/recording/Playback.h>
#include <dspace/recording/RecordingCheck.h>
#include <dspace/recording/RecordingSalvage.h>
#include <dspace/recording/RecordingWriter.h>

#include "FuzzDriver.h"
#include "RecordingRows.h"

namespace {

using namespace dspace;
using namespace dspace::testing;

[[noreturn]] void Fail(const std::string& what) {
  std::fprintf(stderr, "%s\n", what.c_str());
  std::abort();
}

// The recording that is looked at, in the folder that goes with the process.
const std::string& PathOfInput() {
  static const std::string path = TheRoot().Path + "/input.dspace";
  return path;
}

void Put(const std::string& bytes) {
  for (const char* end : {"-wal", "-shm", "-journal"}) {
    std::filesystem::remove(PathOfInput() + end);
  }
  std::ofstream(PathOfInput(), std::ios::binary | std::ios::trunc) << bytes;
}

// The rows whose checksum holds, found as the reader finds them: in a damaged file another question
// may lead to other rows.
std::set<std::uint64_t> Sound(const Database& file, const char* table, char letter,
                              const std::string& which, const std::vector<std::int64_t>& numbers) {
  std::set<std::uint64_t> sound;
  file.Ask(std::string("SELECT seq, time, wall, kind, payload, checksum FROM ") + table + which,
           numbers, [&](sqlite3_stmt* row) {
             if (SumOfRow(row, letter) == Blob(row, 5)) {
               sound.insert(std::uint64_t(sqlite3_column_int64(row, 0)));
             }
           });
  return sound;
}

void Require(bool sound, const std::string& what) {
  if (!sound) {
    Fail(what + " was accepted without its checksum");
  }
}

// Its errors are the input's, but for those of Dspace's own.
template<class Work> bool Try(Work work) {
  try {
    work();
    return true;
  } catch (const Error& error) {
    if (error.GetKind() == Error::Kind::Internal) {
      Fail(error.what());
    }
    return false;
  }
}

void ReadAll(session::RecordingReader& reader, const Database& file) {
  Try([&] {
    const std::uint64_t first = reader.First();
    const std::uint64_t last = reader.Last();
    const auto sound = Sound(file, "command", 'C', " WHERE seq BETWEEN ? AND ? ORDER BY seq",
                             {std::int64_t(first), std::int64_t(last)});
    reader.Read(first, last, [&](session::RecordedCommand&& row) {
      Require(sound.count(row.seq) > 0, "command " + std::to_string(row.seq));
      return true;
    });
  });
  Try([&] {
    for (const std::uint64_t asked : reader.Snapshots()) {
      Try([&] {
        const std::uint64_t seq = reader.SnapshotAt(asked).seq;
        // A negative number of a damaged row is read as one beyond all rows.
        const std::uint64_t most = std::numeric_limits<std::int64_t>::max();
        Require(Sound(file, "snapshot", 'S', " WHERE seq <= ? ORDER BY seq DESC LIMIT 1",
                      {std::int64_t(std::min(asked, most))})
                        .count(seq) > 0,
                "snapshot " + std::to_string(seq));
      });
    }
  });
  Try([&] {
    const auto parts = reader.Parts();
    const std::vector<session::RecordingAsset> assets = reader.Assets();
    std::set<std::int64_t> sound;
    file.Ask("SELECT id, path, state, size, sha256, packed, checksum FROM asset "
             "WHERE id > 0 ORDER BY id",
             {}, [&](sqlite3_stmt* row) {
               if (SumOfAsset(row) == Blob(row, 6)) {
                 sound.insert(sqlite3_column_int64(row, 0));
               }
             });
    for (const session::RecordingAsset& asset : assets) {
      Require(sound.count(asset.id) > 0, "file '" + asset.path + "'");
      const auto found = parts.find(asset.id);
      if (found != parts.end()) {
        Try([&] { reader.ReadContent(asset, found->second, [](const std::string&) {}); });
      }
    }
  });
}

void Play(session::RecordingReader& reader) {
  // Whatever files its commands name, these only are read.
  static const session::Confinement confinement({TheRoot().Path});
  const FilesGuard guard([](const std::string& path) { confinement.RequireWithin(path); });
  session::Interpreter interpreter;
  session::Playback playback(reader, interpreter);
  const auto steps = std::int64_t(playback.Steps().size());
  for (const std::int64_t n : {std::int64_t(1), steps / 2, std::int64_t(-1), steps, -steps}) {
    Try([&] { playback.Step(n); });
  }
  for (std::size_t i = 0; i < playback.Steps().size() && i < 8; ++i) {
    Try([&] { playback.Seek(playback.Steps()[i].time_s); });
  }
}

// What comes back is sound, whatever the input was.
void Salvage() {
  const std::string out = TheRoot().Path + "/salvaged.dspace";
  std::filesystem::remove(out);
  if (!Try([&] { session::SalvageRecording(PathOfInput(), out, [] {}); })) {
    if (std::filesystem::exists(out)) {
      Fail("a salvage that failed left a file");
    }
    return;
  }
  const Database file(out, SQLITE_OPEN_READONLY);
  for (const auto& [table, letter] : {std::pair("command", 'C'), std::pair("snapshot", 'S')}) {
    std::size_t count = 0;
    file.Ask(std::string("SELECT count(*) FROM ") + table, {},
             [&](sqlite3_stmt* row) { count = std::size_t(sqlite3_column_int64(row, 0)); });
    if (Sound(file, table, letter, "", {}).size() != count) {
      Fail(std::string("a ") + table + " was salvaged without its checksum");
    }
  }
  try {
    session::RecordingReader reader(out);
    session::CheckRecording(reader, [] {});
  } catch (const Error& error) {
    Fail(std::string("what was salvaged is not sound: ") + error.what());
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  setenv("TMPDIR", TheRoot().Path.c_str(), 1); // where packed files are unpacked
  Put(std::string(reinterpret_cast<const char*>(data), size));
  const Database file(PathOfInput(), SQLITE_OPEN_READONLY);
  Try([&] {
    session::RecordingReader reader(PathOfInput());
    Try([&] { reader.Lost(); });
    ReadAll(reader, file);
    Try([&] { Play(reader); });
  });
  Salvage();
  return 0;
}

#ifndef DSPACE_LIBFUZZER
namespace {

// A recording of these commands, in small pages, so that one has few bytes and many pages.
std::string Record(const Commands& commands, bool pack) {
  const std::string path = TheRoot().Path + "/new.dspace";
  std::filesystem::remove(path);
  {
    session::Interpreter interpreter;
    session::Ledger ledger(&interpreter.GetState());
    session::RecordingOptions options;
    options.pack = pack;
    options.snapshotCommands = 3;
    options.snapshotBytes = 1;
    session::RecordingWriter writer(path, ledger, 0.0, options, &interpreter.GetState().files);
    interpreter.AddListener([&](const v1::Command& command, const v1::Reply& reply) {
      ledger.Add(command, reply);
      writer.Add(command, reply, ledger);
    });
    const session::Confinement confinement({TheRoot().Path});
    const FilesGuard guard([&](const std::string& at) { confinement.RequireWithin(at); });
    double time_s = 0;
    for (const v1::Command& each : commands.command()) {
      v1::Command command = each;
      interpreter.Execute(command);
      v1::Command time;
      time.mutable_set_time()->set_time_s(time_s += 0.5);
      interpreter.Execute(time);
    }
  }
  {
    const Database file(path);
    sqlite3_exec(file.Handle, "PRAGMA journal_mode=DELETE; PRAGMA page_size=512; VACUUM", nullptr,
                 nullptr, nullptr);
  }
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

// A scene with frames, a model and a terrain, and others of all kinds.
std::vector<std::string> Recordings(Mutator& mutator) {
  std::vector<Commands> all = Corpus(mutator);
  std::vector<std::string> recordings;
  for (int i = 0; i < 12; ++i) {
    Commands commands;
    for (int k = 0; k < 4; ++k) {
      commands.MergeFrom(all[mutator.Below(unsigned(all.size()))]);
    }
    commands.add_command()->mutable_import_object()->add_level()->set_path(TheRoot().Path +
                                                                           "/part.obj");
    commands.add_command()->mutable_open_terrain()->set_path(TheRoot().Path + "/grid.asc");
    recordings.push_back(Record(commands, i % 2 == 0));
  }
  return recordings;
}

struct Column {
  const char* table;
  const char* key;
  const char* name;
};
constexpr Column Columns[] = {
    {"command", "seq", "seq"},      {"command", "seq", "time"},    {"command", "seq", "wall"},
    {"command", "seq", "kind"},     {"command", "seq", "payload"}, {"command", "seq", "checksum"},
    {"snapshot", "seq", "seq"},     {"snapshot", "seq", "time"},   {"snapshot", "seq", "kind"},
    {"snapshot", "seq", "payload"}, {"asset", "id", "path"},       {"asset", "id", "state"},
    {"asset", "id", "size"},        {"asset", "id", "sha256"},     {"asset", "id", "packed"},
    {"content", "id", "asset"},     {"content", "id", "place"},    {"content", "id", "size"},
    {"content", "id", "data"},      {"meta", "key", "value"}};

// Gives all rows of commands, states and files the checksum that they should have.
void Sign(const Database& file) {
  const auto put = [&](const char* table, const char* key, const std::string& columns,
                       const auto& sum) {
    std::vector<std::pair<std::int64_t, std::string>> sums;
    file.Ask("SELECT " + columns + " FROM " + table, {},
             [&](sqlite3_stmt* row) { sums.emplace_back(sqlite3_column_int64(row, 0), sum(row)); });
    for (const auto& [id, bytes] : sums) {
      sqlite3_stmt* change = nullptr;
      const std::string sql =
          std::string("UPDATE ") + table + " SET checksum = ? WHERE " + key + " = ?";
      sqlite3_prepare_v2(file.Handle, sql.c_str(), -1, &change, nullptr);
      sqlite3_bind_blob(change, 1, bytes.data(), int(bytes.size()), SQLITE_STATIC);
      sqlite3_bind_int64(change, 2, id);
      sqlite3_step(change);
      sqlite3_finalize(change);
    }
  };
  const std::string row = "seq, time, wall, kind, payload";
  put("command", "seq", row, [](sqlite3_stmt* each) { return SumOfRow(each, 'C'); });
  put("snapshot", "seq", row, [](sqlite3_stmt* each) { return SumOfRow(each, 'S'); });
  put("asset", "id", "id, path, state, size, sha256, packed", SumOfAsset);
  put("content", "id", "id, asset, place, size, data", [](sqlite3_stmt* each) {
    std::string text = "P";
    for (int i = 0; i < 4; ++i) {
      text += Bytes(sqlite3_column_int64(each, i));
    }
    return Sum(text + Blob(each, 4));
  });
}

// What may stand in the place of a recording's tables, or beside them.
void ChangeSchema(const Database& file, Mutator& mutator) {
  const char* const tables[] = {"meta", "command", "snapshot", "asset", "content"};
  const std::string table = tables[mutator.Below(5)];
  const std::string endless =
      " AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i AS id, i AS "
      "seq, "
      "1 AS asset, i AS place, 1 AS size, 0.0 AS time, 0.0 AS wall, 13 AS kind, x'' AS payload, "
      "x'' "
      "AS data, x'' AS checksum, '/a' AS path, 'read' AS state, x'' AS sha256, 1 AS packed, "
      "'format' AS key, 1 AS value FROM n";
  const std::string changes[] = {
      "DROP TABLE " + table + "; CREATE VIEW " + table + endless,
      "ALTER TABLE " + table + " RENAME TO kept; CREATE VIEW " + table + " AS SELECT * FROM kept",
      "DROP TABLE " + table + "; CREATE VIRTUAL TABLE " + table + " USING dbstat",
      "ALTER TABLE " + table + " ADD COLUMN more AS (hex(zeroblob(1000000)))",
      "CREATE TRIGGER t AFTER INSERT ON " + table + " BEGIN DELETE FROM command; END",
      "CREATE INDEX more ON " + table + "(1)",
      "DROP TABLE " + table,
      "DROP INDEX step",
      "PRAGMA writable_schema=1; UPDATE sqlite_master SET rootpage = " +
          std::to_string(1 + mutator.Below(9)) + " WHERE name = '" + table + "'",
      "PRAGMA writable_schema=1; UPDATE sqlite_master SET sql = replace(sql, 'NOT NULL', '') "
      "WHERE name = '" +
          table + "'"};
  sqlite3_exec(file.Handle, changes[mutator.Below(10)].c_str(), nullptr, nullptr, nullptr);
}

// Values of some rows become others.
std::string ChangeRows(const std::string& recording, Mutator& mutator) {
  Put(recording);
  {
    const Database file(PathOfInput());
    sqlite3_exec(file.Handle, "PRAGMA synchronous=OFF; PRAGMA journal_mode=OFF", nullptr, nullptr,
                 nullptr);
    for (unsigned n = 1 + mutator.Below(3); n > 0; --n) {
      const Column& column = Columns[mutator.Below(sizeof Columns / sizeof *Columns)];
      const std::string key = column.key;
      const std::string of = std::string(" FROM ") + column.table + " ORDER BY " + key +
                             " LIMIT 1 OFFSET " + std::to_string(mutator.Below(8));
      std::string before;
      file.Ask(std::string("SELECT ") + column.name + of, {},
               [&](sqlite3_stmt* row) { before = Blob(row, 0); });
      const char* const numbers[] = {"-1", "0", "1", "2", "1e300", "-1e300", "9223372036854775807"};
      const unsigned way = mutator.Below(4);
      const std::string value = way == 0   ? numbers[mutator.Below(7)]
                                : way == 1 ? "'1-3 5-9'"
                                : way == 2 ? std::string(column.name) + " + 1"
                                           : "?";
      const std::string sql = std::string("UPDATE OR REPLACE ") + column.table + " SET " +
                              column.name + " = " + value + " WHERE " + key + " = (SELECT " + key +
                              of + ")";
      const std::string damaged = mutator.Damage(before);
      sqlite3_stmt* change = nullptr;
      sqlite3_prepare_v2(file.Handle, sql.c_str(), -1, &change, nullptr);
      if (way == 3) {
        sqlite3_bind_blob(change, 1, damaged.data(), int(damaged.size()), SQLITE_STATIC);
      }
      sqlite3_step(change);
      sqlite3_finalize(change);
    }
    if (mutator.Below(2) == 0) {
      Sign(file);
    }
    if (mutator.Below(10) == 0) {
      ChangeSchema(file, mutator);
    }
  }
  std::ifstream in(PathOfInput(), std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

} // namespace

int main(int argc, char** argv) {
  std::vector<std::string> recordings;
  FuzzDriver driver;
  driver.failure = "fuzz-recording-failure";
  driver.corpus = Recordings;
  driver.next = [&recordings](Mutator& mutator, long run) {
    if (recordings.empty()) {
      recordings = Recordings(mutator);
    }
    const std::string& one = recordings[mutator.Below(unsigned(recordings.size()))];
    return run % 2 ? ChangeRows(one, mutator) : mutator.Damage(one);
  };
  return driver.Main(argc, argv);
}
#endif
