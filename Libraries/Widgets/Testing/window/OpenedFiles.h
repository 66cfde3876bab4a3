// The files that one thread of a test program opens, watched at the C library.
#ifndef DSPACE_TEST_OPENED_FILES_H
#define DSPACE_TEST_OPENED_FILES_H

#include <string>
#include <vector>

// While it lives, the calls of open(), openat() and fopen() of the thread that made it are noted,
// by whichever library they are made.
class OpenedFiles {
public:
  OpenedFiles();
  ~OpenedFiles();
  OpenedFiles(const OpenedFiles&) = delete;
  OpenedFiles& operator=(const OpenedFiles&) = delete;
  // The paths below a folder, in the order of their calls.
  std::vector<std::string> Below(const std::string& folder) const;
};

#endif
