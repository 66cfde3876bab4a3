#include <dspace/AtomicFile.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <dspace/Error.h>

namespace dspace {
namespace {

constexpr const char* Ending = ".part";
constexpr std::size_t EndingLength = 5;
constexpr std::size_t RandomLength = 16; // hexadecimal digits: of the process id, then random
constexpr std::size_t NameLength = 64; // bytes of the target's name, so that long ones fit as well
constexpr mode_t Permissions = 0777;

std::string Label(const std::string& path) {
  return "file '" + path + "'";
}

[[noreturn]] void FailWith(const std::string& object, int reason, const std::string& more = "") {
  throw Error(Error::Kind::Io, object,
              std::string("cannot be written: ") + std::strerror(reason) + more);
}

// A path that may be written: its links are resolved, and its folder exists.
struct Target {
  std::string path;
  std::string folder; // with a slash at its end; "" is the working folder
  std::string name;
  bool exists = false;
  mode_t mode = 0; // where it exists
};

Target TargetOf(const std::string& path, const std::string& object) {
  if (path.find('\0') != std::string::npos) {
    // In a message the rest of the path would be lost, and the reason with it.
    throw Error(Error::Kind::InvalidArgument, Label(path.c_str()), "its path contains a zero byte");
  }
  Target target;
  target.path = path;
  struct stat state = {};
  target.exists = ::lstat(path.c_str(), &state) == 0;
  if (!target.exists && errno != ENOENT) {
    FailWith(object, errno);
  }
  if (target.exists && S_ISLNK(state.st_mode)) {
    const std::unique_ptr<char, void (*)(void*)> real(::realpath(path.c_str(), nullptr), std::free);
    if (!real || ::lstat(real.get(), &state) != 0) {
      FailWith(object, errno, "; it is a symbolic link; accepted: a link to a file that exists");
    }
    target.path = real.get();
  }
  const std::size_t slash = target.path.rfind('/');
  const std::size_t begin = slash == std::string::npos ? 0 : slash + 1;
  target.folder = target.path.substr(0, begin);
  target.name = target.path.substr(begin);
  if (target.exists) {
    if (S_ISDIR(state.st_mode)) {
      throw Error(Error::Kind::Io, object, "it is a folder");
    }
    if (!S_ISREG(state.st_mode)) {
      throw Error(Error::Kind::Io, object,
                  "it is a device, a pipe or a socket; accepted: a regular file");
    }
    if (::faccessat(AT_FDCWD, target.path.c_str(), W_OK, AT_EACCESS) != 0) {
      FailWith(object, errno);
    }
    target.mode = state.st_mode & Permissions;
    return target;
  }
  const std::string folder = target.folder.empty() ? "." : target.folder;
  if (::stat(folder.c_str(), &state) != 0 || !S_ISDIR(state.st_mode)) {
    throw Error(Error::Kind::Io, object,
                "there is no folder '" + (begin > 1 ? target.folder.substr(0, begin - 1) : folder) +
                    "'");
  }
  if (target.name.empty()) {
    FailWith(object, ENOENT);
  }
  return target;
}

bool IsContinuation(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) == 0x80; // of a character in UTF-8
}

std::string TemporaryOf(const Target& target) {
  std::size_t length = std::min(target.name.size(), NameLength);
  while (length > 0 && length < target.name.size() && IsContinuation(target.name[length])) {
    --length;
  }
  std::random_device random;
  char digits[RandomLength + 1];
  std::snprintf(digits, sizeof(digits), "%08x%08x", unsigned(::getpid()), random());
  return target.folder + "." + target.name.substr(0, length) + "." + digits + Ending;
}

} // namespace

AtomicFile::AtomicFile(const std::string& path, const std::string& object)
    : Object_(object.empty() ? Label(path) : object) {
  const Target target = TargetOf(path, this->Object_);
  this->Target_ = target.path;
  do { // until the name is new
    this->Temporary_ = TemporaryOf(target);
    this->File_ =
        ::open(this->Temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
               target.exists ? 0600 : 0666);
  } while (this->File_ < 0 && errno == EEXIST);
  if (this->File_ < 0) {
    FailWith(this->Object_, errno);
  }
  // What throws below runs no destructor.
  struct stat state = {};
  const bool good = ::fstat(this->File_, &state) == 0 &&
                    (!target.exists || ::fchmod(this->File_, target.mode) == 0);
  if (!good) {
    const int reason = errno;
    this->CloseFile();
    ::unlink(this->Temporary_.c_str());
    FailWith(this->Object_, reason);
  }
  this->Mode_ = target.exists ? target.mode : state.st_mode & Permissions;
}

AtomicFile::~AtomicFile() {
  this->CloseFile();
  if (!this->Committed_) {
    ::unlink(this->Temporary_.c_str());
  }
}

void AtomicFile::CloseFile() {
  if (this->File_ >= 0) {
    ::close(this->File_);
    this->File_ = -1;
  }
}

void AtomicFile::Fail(int reason) const {
  const bool full = reason == ENOSPC || reason == EFBIG || reason == EDQUOT;
  FailWith(this->Object_, reason, full ? "; accepted: a folder with free space" : "");
}

void AtomicFile::Write(const void* data, std::size_t bytes) {
  this->WriteAt(this->Bytes_, data, bytes);
  this->Bytes_ += bytes;
}

void AtomicFile::WriteAt(std::uint64_t offset, const void* data, std::size_t bytes) {
  const char* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t wrote = ::pwrite(this->File_, from, bytes, off_t(offset));
    if (wrote < 0 && errno == EINTR) {
      continue;
    }
    if (wrote <= 0) {
      this->Fail(wrote == 0 ? ENOSPC : errno);
    }
    from += wrote;
    offset += std::uint64_t(wrote);
    bytes -= std::size_t(wrote);
  }
}

void AtomicFile::Commit() {
  struct stat own = {};
  struct stat named = {};
  if (::fstat(this->File_, &own) != 0 || ::lstat(this->Temporary_.c_str(), &named) != 0) {
    this->Fail(errno);
  }
  if (own.st_ino != named.st_ino || own.st_dev != named.st_dev) { // a library replaced it
    this->CloseFile();
    this->File_ = ::open(this->Temporary_.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (this->File_ < 0 || ::fchmod(this->File_, this->Mode_) != 0) {
      this->Fail(errno);
    }
  }
  if (::fsync(this->File_) != 0) {
    this->Fail(errno);
  }
  const int closed = ::close(this->File_);
  this->File_ = -1;
  if (closed != 0) {
    this->Fail(errno);
  }
  if (::rename(this->Temporary_.c_str(), this->Target_.c_str()) != 0) {
    this->Fail(errno);
  }
  this->Committed_ = true;
}

void AtomicFile::Save(const std::string& path, const void* data, std::size_t bytes) {
  AtomicFile file(path);
  file.Write(data, bytes);
  file.Commit();
}

void AtomicFile::Check(const std::string& path) {
  TargetOf(path, Label(path));
}

std::string AtomicFile::TargetName(const std::string& temporary) {
  const std::size_t rest = 1 + RandomLength + EndingLength; // what follows the target's name
  if (temporary.size() <= 1 + rest || temporary[0] != '.') {
    return "";
  }
  const std::size_t end = temporary.size() - rest;
  const std::string random = temporary.substr(end + 1, RandomLength);
  const bool ours = temporary[end] == '.' &&
                    random.find_first_not_of("0123456789abcdef") == std::string::npos &&
                    temporary.compare(end + 1 + RandomLength, EndingLength, Ending) == 0;
  return ours ? temporary.substr(1, end - 1) : "";
}

} // namespace dspace
