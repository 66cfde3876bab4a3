// The tables of a recording. Not a public header.
#ifndef DSPACE_SESSION_RECORDING_SCHEMA_H
#define DSPACE_SESSION_RECORDING_SCHEMA_H

#include <string>

struct sqlite3;

namespace dspace::session {

class RecordingDatabase;

// The statements that create the tables of an empty file.
extern const char* const RecordingSchema;

// Before a file from anywhere is read or written: its schema runs nothing. Views, triggers, and
// functions of the schema that may have effects are off, and the tables of SQLite itself are
// read-only.
void DefendDatabase(sqlite3* database);

// Throws Error(Corrupt) that names the first entry of the file's schema that is not one of
// RecordingSchema's, to the letter but for blanks: a view, a virtual table or a generated column in
// the place of a table could run without end. `table`: only this one is looked at; empty: all, and
// none may be missing.
void RequireSchema(const RecordingDatabase& database, const std::string& table = {});

} // namespace dspace::session

#endif
