// Rows of a recording and their checksums, worked out from Documentation/Recording.md and not from
// what Dspace reads them with.
#ifndef DSPACE_RECORDING_ROWS_H
#define DSPACE_RECORDING_ROWS_H

#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include <openssl/sha.h>
#include <sqlite3.h>

namespace dspace::testing {

class Database {
public:
  explicit Database(const std::string& path, int flags = SQLITE_OPEN_READWRITE) {
    sqlite3_open_v2(path.c_str(), &this->Handle, flags, nullptr);
  }
  ~Database() { sqlite3_close(this->Handle); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void Ask(const std::string& sql, const std::vector<std::int64_t>& numbers,
           const std::function<void(sqlite3_stmt*)>& take) const {
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(this->Handle, sql.c_str(), -1, &statement, nullptr);
    for (int i = 0; i < int(numbers.size()); ++i) {
      sqlite3_bind_int64(statement, i + 1, numbers[std::size_t(i)]);
    }
    while (statement && sqlite3_step(statement) == SQLITE_ROW) {
      take(statement);
    }
    sqlite3_finalize(statement);
  }
  sqlite3* Handle = nullptr;
};

inline std::string Blob(sqlite3_stmt* row, int column) {
  const void* data = sqlite3_column_blob(row, column);
  const auto size = std::size_t(sqlite3_column_bytes(row, column));
  return data ? std::string(static_cast<const char*>(data), size) : std::string();
}

template<class T> std::string Bytes(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

inline std::string Sum(const std::string& of) {
  std::array<unsigned char, 32> sum;
  SHA256(reinterpret_cast<const unsigned char*>(of.data()), of.size(), sum.data());
  return {reinterpret_cast<const char*>(sum.data()), 16};
}

// Columns seq, time, wall, kind, payload.
inline std::string SumOfRow(sqlite3_stmt* row, char letter) {
  return Sum(letter + Bytes(sqlite3_column_int64(row, 0)) + Bytes(sqlite3_column_double(row, 1)) +
             Bytes(sqlite3_column_double(row, 2)) +
             Bytes(std::int32_t(sqlite3_column_int64(row, 3))) + Blob(row, 4));
}

// Columns id, path, state, size, sha256, packed.
inline std::string SumOfAsset(sqlite3_stmt* row) {
  std::string text = 'A' + Bytes(sqlite3_column_int64(row, 0)) +
                     Bytes(sqlite3_column_int64(row, 3)) +
                     Bytes(char(sqlite3_column_int64(row, 5) != 0));
  for (const int column : {2, 1, 4}) {
    text += Bytes(std::uint64_t(Blob(row, column).size()));
  }
  return Sum(text + Blob(row, 2) + Blob(row, 1) + Blob(row, 4));
}

} // namespace dspace::testing

#endif
