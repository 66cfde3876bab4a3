#include <dspace/recording/RecordingSchema.h>

#include <algorithm>
#include <cctype>
#include <map>

#include <sqlite3.h>

#include <dspace/Utf8.h>
#include <dspace/recording/RecordingDatabase.h>

namespace dspace::session {
namespace {

constexpr int LongestStatement = 100000; // bytes; ours have a few hundred
constexpr int DeepestExpression = 50;
constexpr std::size_t Shown = 60; // bytes of a name in a message

// With one blank where there are some, and without comments.
std::string WithOneBlank(const std::string& sql) {
  std::string out;
  for (std::size_t i = 0; i < sql.size(); ++i) {
    if (sql.compare(i, 2, "--") == 0) {
      i = std::min(sql.find('\n', i), sql.size() - 1);
    }
    const bool blank = std::isspace(static_cast<unsigned char>(sql[i])) != 0;
    if (!blank) {
      out += sql[i];
    } else if (!out.empty() && out.back() != ' ') {
      out += ' ';
    }
  }
  out.resize(out.find_last_not_of(' ') + 1);
  return out;
}

// The statements by the name of what they create.
const std::map<std::string, std::string>& Statements() {
  static const std::map<std::string, std::string> statements = [] {
    std::map<std::string, std::string> found;
    const std::string all = RecordingSchema;
    std::size_t begin = 0;
    for (std::size_t end; (end = all.find(';', begin)) != std::string::npos; begin = end + 1) {
      const std::string one = WithOneBlank(all.substr(begin, end - begin));
      const std::size_t at = std::string("CREATE TABLE ").size(); // or INDEX
      found[one.substr(at, one.find_first_of("( ", at) - at)] = one;
    }
    return found;
  }();
  return statements;
}

} // namespace

const char* const RecordingSchema = R"(
CREATE TABLE meta(key TEXT PRIMARY KEY, value) WITHOUT ROWID;
CREATE TABLE command(seq INTEGER PRIMARY KEY, time REAL NOT NULL, wall REAL NOT NULL,
  kind INTEGER NOT NULL, payload BLOB NOT NULL, checksum BLOB NOT NULL);
CREATE TABLE snapshot(seq INTEGER PRIMARY KEY, time REAL NOT NULL, wall REAL NOT NULL,
  kind INTEGER NOT NULL, payload BLOB NOT NULL, checksum BLOB NOT NULL);
-- The steps of the simulation: SetTime is command 13.
CREATE INDEX step ON command(time) WHERE kind = 13;
CREATE TABLE asset(id INTEGER PRIMARY KEY, path TEXT NOT NULL, state TEXT NOT NULL,
  size INTEGER NOT NULL, sha256 BLOB NOT NULL, packed INTEGER NOT NULL, checksum BLOB NOT NULL);
CREATE TABLE content(id INTEGER PRIMARY KEY, asset INTEGER NOT NULL, place INTEGER NOT NULL,
  size INTEGER NOT NULL, data BLOB NOT NULL, checksum BLOB NOT NULL);
)";

void DefendDatabase(sqlite3* database) {
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_limit(database, SQLITE_LIMIT_SQL_LENGTH, LongestStatement);
  sqlite3_limit(database, SQLITE_LIMIT_EXPR_DEPTH, DeepestExpression);
  sqlite3_limit(database, SQLITE_LIMIT_ATTACHED, 0);
}

void RequireSchema(const RecordingDatabase& database, const std::string& table) {
  std::map<std::string, std::string> missing = Statements();
  RecordingDatabase::Statement found(database, "SELECT type, name, sql FROM sqlite_master");
  while (found.Step()) {
    const std::string name = found.Bytes(1);
    const std::string sql = WithOneBlank(found.Bytes(2).substr(0, LongestStatement));
    const auto ours = missing.find(name);
    if ((!table.empty() && name != table) || (ours != missing.end() && ours->second == sql)) {
      missing.erase(name);
      continue;
    }
    database.Damaged("its " + Utf8Beginning(ToUtf8(found.Bytes(0)), Shown) + " '" +
                     Utf8Beginning(ToUtf8(name), Shown) +
                     "' is not as in a recording; accepted: only the tables of one");
  }
  for (const auto& entry : missing) {
    if (table.empty() || entry.first == table) {
      database.Damaged("it lacks '" + entry.first + "', a part of every recording");
    }
  }
}

} // namespace dspace::session
