#include <dspace/import/files/ImportFile.h>

#include <dspace/Error.h>
#include <dspace/FileText.h>
#include <dspace/FilesRead.h>

#include <filesystem>
#include <fstream>

namespace dspace {

std::string FileObject(const std::string& path) {
  return "file '" + path + "'";
}

std::string ReadFileBytes(const std::string& path, std::size_t maximum) {
  namespace fs = std::filesystem;
  NoteFileRead(path); // before reading, so that a concurrent change is detected
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    throw Error(Error::Kind::NotFound, FileObject(path), "does not exist");
  }
  // A pipe or device would block or never end.
  if (!fs::is_regular_file(status)) {
    throw Error(Error::Kind::Io, FileObject(path), "is not a regular file");
  }
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) {
    throw Error(Error::Kind::Io, FileObject(path), "cannot be read: " + error.message());
  }
  if (size == 0) {
    throw Error(Error::Kind::Corrupt, FileObject(path), "is empty");
  }
  if (size > maximum) {
    throw Error(Error::Kind::Resource, FileObject(path),
                "has " + std::to_string(size) + " bytes; at most " + std::to_string(maximum) +
                    " are read");
  }
  std::ifstream in(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!in || !in.read(bytes.data(), static_cast<std::streamsize>(size))) {
    throw Error(Error::Kind::Io, FileObject(path), "cannot be read");
  }
  return bytes;
}

std::string ReadFileText(const std::string& path, std::size_t maximum) {
  return ToFileText(ReadFileBytes(path, maximum), FileObject(path));
}

} // namespace dspace
