#include "OpenedFiles.h"

#include <cstdarg>
#include <cstdio>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/types.h>

// This program's functions stand before those of the C library.

namespace {

thread_local std::vector<std::string>* Watched = nullptr;

void Note(const char* path) {
  if (Watched && path) {
    std::vector<std::string>* const paths = Watched;
    Watched = nullptr; // what is noted may open files itself
    paths->emplace_back(path);
    Watched = paths;
  }
}

template<class Function> Function* Next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

mode_t ModeOf(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? mode_t(va_arg(arguments, int)) : 0;
}

} // namespace

OpenedFiles::OpenedFiles() {
  Watched = new std::vector<std::string>;
}

OpenedFiles::~OpenedFiles() {
  delete Watched;
  Watched = nullptr;
}

std::vector<std::string> OpenedFiles::Below(const std::string& folder) const {
  std::vector<std::string> below;
  for (const std::string& path : *Watched) {
    if (path.compare(0, folder.size(), folder) == 0) {
      below.push_back(path);
    }
  }
  return below;
}

extern "C" {

int open(const char* path, int flags, ...) {
  static auto* const next = Next<int(const char*, int, ...)>("open");
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = ModeOf(flags, arguments);
  va_end(arguments);
  Note(path);
  return next(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  static auto* const next = Next<int(const char*, int, ...)>("open64");
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = ModeOf(flags, arguments);
  va_end(arguments);
  Note(path);
  return next(path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  static auto* const next = Next<int(int, const char*, int, ...)>("openat");
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = ModeOf(flags, arguments);
  va_end(arguments);
  Note(path);
  return next(folder, path, flags, mode);
}

std::FILE* fopen(const char* path, const char* mode) {
  static auto* const next = Next<std::FILE*(const char*, const char*)>("fopen");
  Note(path);
  return next(path, mode);
}

std::FILE* fopen64(const char* path, const char* mode) {
  static auto* const next = Next<std::FILE*(const char*, const char*)>("fopen64");
  Note(path);
  return next(path, mode);
}

} // extern "C"
