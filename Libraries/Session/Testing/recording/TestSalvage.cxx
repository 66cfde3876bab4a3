// Recordings that are damaged, salvaged, cut, checked: against what was put into them, and against
// SQLite's own account of which row lies on which pages.
#include <map>
#include <random>
#include <set>
#include <sstream>

#include <dspace/Error.h>
#include <dspace/recording/RecordingCheck.h>
#include <dspace/recording/RecordingCut.h>
#include <dspace/recording/RecordingFile.h>
#include <dspace/recording/RecordingSalvage.h>
#include <dspace/recording/RecordingWriter.h>

#include "CommandTestSupport.h"
#include "RecordingRows.h"

namespace dspace::testing {
namespace {

using session::RecordingReader;
using session::RecordingRow;
using session::SalvageReport;

constexpr std::size_t Page = 65536;
const session::CancelCheck On = [] {};

std::string Content(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

void Write(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
}

// Of all sizes, from a few bytes to several pages, whose content follows from its number.
v1::Command Sized(std::uint64_t i) {
  v1::Command command;
  if (i % 5 == 0) {
    command.mutable_set_time()->set_time_s(double(i) / 5.0);
  } else {
    const std::size_t size = i % 17 == 0 ? 30000 + 9001 * i : i % 6 == 0 ? 7000 : i % 90;
    command.mutable_create_frame()->set_name(std::string(size, char('a' + i % 26)));
  }
  return command;
}

class Salvage : public CommandTest {
protected:
  std::string Of(const char* name) const { return this->Folder_ / name; }

  static void Run(const std::string& path, const std::string& sql) {
    const Database file(path);
    EXPECT_EQ(sqlite3_exec(file.Handle, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(file.Handle);
  }

  // A recording of Numbered commands, with a state each 40.
  void Make(const std::string& path, std::uint64_t count = 130) const {
    session::RecordingOptions options;
    options.snapshotCommands = 40;
    options.snapshotBytes = 1u << 30;
    session::RecordingWriter writer(path, session::Ledger(), 0.0, options);
    for (std::uint64_t i = 1; i <= count; ++i) {
      writer.Add(Sized(i), {}, session::Ledger());
    }
    EXPECT_EQ(writer.Flush(), "");
  }

  using Rows = std::map<std::pair<std::string, std::int64_t>, std::string>;
  // Commands and snapshots of a recording, each with all of its columns.
  static Rows In(const std::string& path) {
    Rows rows;
    const Database file(path, SQLITE_OPEN_READONLY);
    for (const std::string table : {"command", "snapshot"}) {
      file.Ask("SELECT seq, time, wall, kind, payload, checksum FROM " + table, {},
               [&](sqlite3_stmt* row) {
                 EXPECT_EQ(SumOfRow(row, table == "command" ? 'C' : 'S'), Blob(row, 5));
                 rows[{table, sqlite3_column_int64(row, 0)}] =
                     Bytes(sqlite3_column_double(row, 1)) + Bytes(sqlite3_column_double(row, 2)) +
                     Bytes(sqlite3_column_int(row, 3)) + Blob(row, 4);
               });
    }
    return rows;
  }

  // The pages that each row lies on, by SQLite's own walk through its trees.
  static std::map<std::pair<std::string, std::int64_t>, std::set<std::int64_t>>
  PagesOf(const std::string& path) {
    std::map<std::pair<std::string, std::int64_t>, std::set<std::int64_t>> found;
    const Database file(path, SQLITE_OPEN_READONLY);
    for (const std::string table : {"command", "snapshot"}) {
      std::vector<std::int64_t> seqs;
      file.Ask("SELECT seq FROM " + table + " ORDER BY seq", {},
               [&](sqlite3_stmt* row) { seqs.push_back(sqlite3_column_int64(row, 0)); });
      std::map<std::string, std::set<std::int64_t>> chains; // by the cell's path
      file.Ask("SELECT path, pageno FROM dbstat WHERE name = '" + table +
                   "' AND pagetype = 'overflow'",
               {}, [&](sqlite3_stmt* row) {
                 const std::string place = Blob(row, 0);
                 chains[place.substr(0, place.find('+'))].insert(sqlite3_column_int64(row, 1));
               });
      std::size_t next = 0;
      file.Ask("SELECT path, pageno, ncell FROM dbstat WHERE name = '" + table +
                   "' AND pagetype = 'leaf' ORDER BY path",
               {}, [&](sqlite3_stmt* row) {
                 for (int cell = 0; cell < sqlite3_column_int(row, 2); ++cell) {
                   char name[16];
                   std::snprintf(name, sizeof name, "%03x", unsigned(cell));
                   auto& pages = found[{table, seqs.at(next++)}];
                   pages = chains[Blob(row, 0) + name];
                   pages.insert(sqlite3_column_int64(row, 1));
                 }
               });
      EXPECT_EQ(next, seqs.size());
    }
    return found;
  }

  SalvageReport Salvaged() const {
    std::filesystem::remove(this->Of("new"));
    const SalvageReport report = session::SalvageRecording(this->Of("bad"), this->Of("new"), On);
    RecordingReader reader(this->Of("new"));
    session::CheckRecording(reader, On); // what comes back is sound
    return report;
  }

  void Rejects(Error::Kind kind, const std::string& words) const {
    try {
      session::SalvageRecording(this->Of("bad"), this->Of("new"), On);
      ADD_FAILURE() << words;
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), kind) << error.what();
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }

  const TemporaryFolder Folder_;
};

TEST_F(Salvage, AnyOnePageMayBeLost) {
  this->Make(this->Of("whole"));
  const std::string whole = Content(this->Of("whole"));
  const Rows rows = In(this->Of("whole"));
  const auto pages = PagesOf(this->Of("whole"));
  ASSERT_EQ(pages.size(), rows.size());
  ASSERT_GT(whole.size() / Page, 10u);
  Write(this->Of("bad"), whole);
  EXPECT_TRUE(this->Salvaged().IsComplete());
  EXPECT_EQ(In(this->Of("new")), rows);
  std::mt19937 random(1);
  for (std::size_t number = 1; number <= whole.size() / Page; ++number) {
    for (const bool flip : {false, true}) {
      std::string bad = whole;
      if (flip) {
        bad[(number - 1) * Page + random() % Page] ^= char(1u << random() % 8);
      } else {
        bad.replace((number - 1) * Page, Page, Page, '\0');
      }
      Write(this->Of("bad"), bad);
      const SalvageReport report = this->Salvaged();
      const Rows found = In(this->Of("new"));
      for (const auto& [key, row] : found) {
        ASSERT_EQ(rows.at(key), row) << key.first << " " << key.second;
      }
      for (const auto& [key, on] : pages) {
        if (on.count(std::int64_t(number)) == 0) {
          ASSERT_EQ(found.count(key), 1u) << key.first << " " << key.second;
        }
      }
      std::set<std::int64_t> lost;
      for (const auto& [first, last] : report.lost) {
        for (std::uint64_t seq = first; seq <= last; ++seq) {
          lost.insert(std::int64_t(seq));
        }
      }
      for (std::int64_t seq = 1; seq <= std::int64_t(report.lastCommand); ++seq) {
        ASSERT_NE(found.count({"command", seq}), lost.count(seq)) << seq;
      }
    }
  }
}

// As a killed process leaves it: what is in the log counts, also where the log's own head is
// damaged.
TEST_F(Salvage, TheLogBesideItCounts) {
  session::RecordingWriter writer(this->Of("whole"), session::Ledger(), 0.0);
  for (std::uint64_t i = 1; i <= 60; ++i) {
    writer.Add(Sized(i), {}, session::Ledger());
  }
  ASSERT_EQ(writer.Flush(), "");
  std::filesystem::copy_file(this->Of("whole"), this->Of("bad"));
  const std::string log = Content(this->Of("whole-wal"));
  ASSERT_GT(log.size(), 2 * Page);
  for (const int byte : {-1, 0, 9, 18, 31}) {
    std::string damaged = log;
    if (byte >= 0) {
      damaged[std::size_t(byte)] ^= 4;
    }
    for (const char* end : {"-wal", "-shm"}) {
      std::filesystem::remove(this->Of("bad") + end);
    }
    Write(this->Of("bad-wal"), damaged);
    const SalvageReport report = this->Salvaged();
    EXPECT_EQ(report.commands, 60u) << byte;
    EXPECT_EQ(report.snapshots, 1u);
    EXPECT_TRUE(report.IsComplete());
  }
}

// Packing changes a file's row, whose page from before is in the log or in the file.
TEST_F(Salvage, OfTwoVersionsOfAFileThePackedOneComesBack) {
  this->Make(this->Of("whole"), 1);
  session::RecordingAsset asset;
  asset.id = 1;
  asset.path = "/f";
  asset.state = "read";
  asset.size = 4;
  asset.sha256 = std::string(32, 's');
  session::RecordingContent part;
  part.id = part.asset = 1;
  part.size = 4;
  part.data = "0123";
  const auto hex = [](const std::string& bytes) {
    return "x'" + session::Hexadecimal(bytes) + "'";
  };
  const auto row = [&](bool packed) {
    asset.packed = packed;
    return "INSERT OR REPLACE INTO asset VALUES(1,'/f','read',4," + hex(asset.sha256) +
           (packed ? ",1," : ",0,") + hex(session::RecordingChecksum(asset)) + ");";
  };
  const std::string content = "INSERT INTO content VALUES(1,1,0,4," + hex(part.data) + "," +
                              hex(session::RecordingChecksum(part)) + ");";
  for (const bool newerFirst : {false, true}) {
    const std::string path = this->Of(newerFirst ? "a" : "b");
    std::filesystem::copy_file(this->Of("whole"), path);
    const Database file(path);
    const auto run = [&](const std::string& sql) {
      EXPECT_EQ(sqlite3_exec(file.Handle, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
    };
    run("PRAGMA journal_mode=WAL; PRAGMA wal_autocheckpoint=0; " + content);
    run(row(false));
    if (!newerFirst) {
      run("PRAGMA wal_checkpoint(FULL)"); // the file has the older row, the log the newer one
    }
    run(row(true));
    if (newerFirst) {
      run("PRAGMA wal_checkpoint(FULL)"); // the file has the newer row, the log both
    }
    for (const char* end : {"", "-wal"}) {
      std::filesystem::copy_file(path + end, this->Of("bad") + end,
                                 std::filesystem::copy_options::overwrite_existing);
    }
    std::filesystem::remove(this->Of("new"));
    EXPECT_TRUE(session::SalvageRecording(this->Of("bad"), this->Of("new"), On).IsComplete());
    const auto assets = RecordingReader(this->Of("new")).Assets();
    ASSERT_EQ(assets.size(), 1u);
    EXPECT_TRUE(assets[0].packed) << newerFirst;
    for (const char* end : {"-wal", "-shm"}) {
      std::filesystem::remove(this->Of("bad") + end);
    }
  }
}

TEST_F(Salvage, WhatIsLostIsNamed) {
  this->Make(this->Of("bad"));
  Run(this->Of("bad"), "DELETE FROM command WHERE seq IN (7, 50, 51, 52); "
                       "DELETE FROM snapshot WHERE seq = 0; PRAGMA secure_delete=1; VACUUM");
  const SalvageReport report = this->Salvaged();
  using Range = std::pair<std::uint64_t, std::uint64_t>;
  EXPECT_EQ(report.lost, (std::vector<Range>{{7, 7}, {50, 52}}));
  EXPECT_TRUE(report.beginLost);
  EXPECT_FALSE(report.IsComplete());
  EXPECT_EQ(report.lastCommand, 130u);
  EXPECT_EQ(RecordingReader(this->Of("new")).Lost(), report.lost);
}

TEST_F(Salvage, APartBeginsWithItsState) {
  this->Make(this->Of("whole"), 300);
  {
    RecordingReader reader(this->Of("whole"));
    const std::vector<std::uint64_t> snapshots = reader.Snapshots();
    ASSERT_GE(snapshots.size(), 3u);
    const std::uint64_t begin = snapshots[1];
    EXPECT_EQ(session::CutRecording(reader, this->Of("bad"), begin + 3, begin + 20, On), begin);
    RecordingReader part(this->Of("bad"));
    session::CheckRecording(part, On);
    EXPECT_EQ(part.Begin(), begin);
    EXPECT_EQ(part.First(), begin + 1);
    EXPECT_EQ(part.Last(), begin + 20);
  }
  const SalvageReport report = this->Salvaged();
  EXPECT_TRUE(report.IsComplete()); // what came before it was cut, and is not lost
  EXPECT_GT(report.begin, 0u);
}

TEST_F(Salvage, WhatCannotBeSalvagedLeavesNothingBehind) {
  this->Rejects(Error::Kind::NotFound, "no such file");
  Write(this->Of("bad"), std::string(3 * Page, '\0'));
  this->Rejects(Error::Kind::Corrupt, "nothing in it can be recovered");
  Write(this->Of("bad"), "");
  this->Rejects(Error::Kind::Corrupt, "nothing in it can be recovered");
  this->Make(this->Of("whole"));
  std::filesystem::copy_file(this->Of("whole"), this->Of("bad"),
                             std::filesystem::copy_options::overwrite_existing);
  int calls = 0;
  EXPECT_THROW(session::SalvageRecording(this->Of("bad"), this->Of("new"),
                                         [&] {
                                           if (++calls == 20) {
                                             throw Error(Error::Kind::Io, "test", "ended");
                                           }
                                         }),
               Error);
  EXPECT_EQ(calls, 20);
  Run(this->Of("bad"), "UPDATE meta SET value = 2 WHERE key = 'format'");
  this->Rejects(Error::Kind::Unsupported, "a newer Dspace wrote it");
  EXPECT_FALSE(std::filesystem::exists(this->Of("new")));
  Run(this->Of("bad"), "UPDATE meta SET value = 'damaged' WHERE key = 'format'");
  EXPECT_TRUE(this->Salvaged().IsComplete());
  this->Rejects(Error::Kind::AlreadyExists, "there is such a file");
  EXPECT_TRUE(std::filesystem::exists(this->Of("new"))); // it is another one's
}

} // namespace
} // namespace dspace::testing
