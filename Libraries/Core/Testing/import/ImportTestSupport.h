// What the importers' tests share: a folder of their own, files made by hand, errors expected.
#ifndef DSPACE_IMPORT_TEST_SUPPORT_H
#define DSPACE_IMPORT_TEST_SUPPORT_H

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <dspace/Error.h>
#include <dspace/import/files/ModelReader.h>
#include <dspace/import/model/Model.h>

namespace dspace::testing {

// A folder that is removed with its files when the object goes.
class TempFolder {
public:
  TempFolder() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "dspace-import-XXXXXX").string();
    if (!mkdtemp(pattern.data())) {
      throw std::runtime_error("no temporary folder");
    }
    this->Path_ = pattern;
  }
  ~TempFolder() {
    std::error_code error;
    std::filesystem::remove_all(this->Path_, error);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  std::string operator/(const std::string& name) const { return this->Path_ + "/" + name; }

  // Writes a file, with the folders above it, and returns its path.
  std::string Write(const std::string& name, const std::string& bytes) const {
    const std::string path = *this / name;
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

private:
  std::string Path_;
};

// Expects `action` to throw an Error of `kind` whose message has `part`.
template<typename Action>
void ExpectError(Error::Kind kind, const std::string& part, Action&& action) {
  try {
    action();
    ADD_FAILURE() << "no error, expected one with: " << part;
  } catch (const Error& e) {
    EXPECT_EQ(static_cast<int>(e.GetKind()), static_cast<int>(kind)) << e.what();
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos)
        << "'" << e.what() << "' lacks '" << part << "'";
  }
}

inline void ExpectReadError(Error::Kind kind, const std::string& part, const std::string& path,
                            const ImportOptions& options = {}) {
  ExpectError(kind, part, [&] { ReadModel(path, options); });
}

// Whether a warning of `model` has `part`.
inline bool HasWarning(const std::vector<std::string>& warnings, const std::string& part) {
  for (const std::string& warning : warnings) {
    if (warning.find(part) != std::string::npos) {
      return true;
    }
  }
  return false;
}

// Values as little-endian bytes, which is how this machine has them.
template<typename T> std::string Bytes(const std::vector<T>& values) {
  return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

inline std::string DecodeBase64(const std::string& text) {
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::size_t value = alphabet.find(c);
    if (value == std::string::npos) {
      break;
    }
    bits = (bits << 6) | static_cast<unsigned>(value);
    if ((count += 6) >= 8) {
      count -= 8;
      out += static_cast<char>((bits >> count) & 0xff);
    }
  }
  return out;
}

// PNG of 2 x 2: red, green; blue, white. Encoded by hand with zlib.
inline const char* const FourColorsPng =
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAIAAAD91JpzAAAAEklEQVR42mP4z8DAAMIM/4EAAB/uBfvxq7p3AAAAAElF"
    "TkSuQmCC";
// PNG of 2 x 1 with alpha: (200, 100, 50, 64), (10, 20, 30, 255).
inline const char* const AlphaPng =
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR42mM4kWLkwCUi9x8ADRAC2iAa9/oAAAAASUVO"
    "RK5CYII=";
// PNG whose header says 100000 x 100000.
inline const char* const HugePng =
    "iVBORw0KGgoAAAANSUhEUgABhqAAAYagCAIAAAAnMJyfAAAADElEQVR4nGNgoD0AAABkAAGGZDw1AAAAAElFTkSuQmCC";

} // namespace dspace::testing

#endif
