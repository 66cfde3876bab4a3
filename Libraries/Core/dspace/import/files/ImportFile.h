// Whole files in memory for the importers: internal, not installed.
#ifndef DSPACE_IMPORT_IMPORT_FILE_H
#define DSPACE_IMPORT_IMPORT_FILE_H

#include <cstddef>
#include <string>

namespace dspace {

// "file 'a/b.stl'": how an error names a file.
std::string FileObject(const std::string& path);

// Bytes of a regular file. Throws Error: NotFound, Io (no regular file, not readable), Corrupt
// (empty), Resource (more than `maximum` bytes). Notes the file (FilesRead.h).
std::string ReadFileBytes(const std::string& path, std::size_t maximum = std::size_t(1) << 32);

// The same as text: bytes of another encoding become UTF-8 (FileText.h).
std::string ReadFileText(const std::string& path, std::size_t maximum = std::size_t(1) << 32);

} // namespace dspace

#endif
