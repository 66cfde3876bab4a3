// Bytes of files and numbers, for tests that make binary files.
#ifndef DSPACE_BINARY_BYTES_H
#define DSPACE_BINARY_BYTES_H

#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

namespace dspace::testing {

inline std::string ReadBytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

// Appends a number's bytes, least significant first, or last with `big`.
template<typename T> void AppendBinary(std::string& bytes, T value, bool big = false) {
  std::string raw(sizeof value, '\0');
  std::memcpy(raw.data(), &value, sizeof value); // the tests run on little-endian machines
  bytes += big ? std::string(raw.rbegin(), raw.rend()) : raw;
}

} // namespace dspace::testing

#endif
