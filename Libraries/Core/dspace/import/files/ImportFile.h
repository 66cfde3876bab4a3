// Whole files in memory for the importers: internal, not installed.
#ifndef DSPACE_IMPORT_IMPORT_FILE_H
#define DSPACE_IMPORT_IMPORT_FILE_H

#include <cstddef>
#include <string>

namespace dspace {

// "file 'a/b.stl'": how an error names a file.
std::string FileObject(const std::string& path);

// A descriptor of a regular file, open for reading, which the caller closes. Throws Error:
// NotFound, Io (no regular file, not readable). Notes the file (FilesRead.h).
int OpenImportFile(const std::string& path);

// A process that may open no files sets the function that gets it descriptors (import/worker);
// it replaces OpenImportFile. Null: none. Set it while one thread runs.
void SetImportFileOpener(int (*open)(const std::string& path));

// Bytes of a regular file. Throws Error: NotFound, Io (no regular file, not readable), Corrupt
// (empty), Resource (more than `maximum` bytes). Notes the file (FilesRead.h).
std::string ReadFileBytes(const std::string& path, std::size_t maximum = std::size_t(1) << 32);

// Its first bytes, at most `count` of them. Throws as ReadFileBytes does.
std::string ReadFileStart(const std::string& path, std::size_t count);

// The same as text: bytes of another encoding become UTF-8 (FileText.h).
std::string ReadFileText(const std::string& path, std::size_t maximum = std::size_t(1) << 32);

} // namespace dspace

#endif
