#include <dspace/import/files/ImportFile.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <dspace/Error.h>
#include <dspace/FileText.h>
#include <dspace/FilesRead.h>

namespace dspace {
namespace {

int (*Opener)(const std::string& path) = nullptr;

[[noreturn]] void CannotRead(const std::string& path) {
  throw Error(Error::Kind::Io, FileObject(path),
              "cannot be read: " + std::generic_category().message(errno));
}

void RequireRegular(const std::string& path, const struct stat& state) {
  // A pipe or device would block or never end.
  if (!S_ISREG(state.st_mode)) {
    throw Error(Error::Kind::Io, FileObject(path), "is not a regular file");
  }
}

class OpenFile {
public:
  explicit OpenFile(const std::string& path)
      : Path_(path), Descriptor_(Opener ? Opener(path) : OpenImportFile(path)) {
    struct stat state = {};
    if (::fstat(this->Descriptor_, &state) != 0) {
      ::close(this->Descriptor_);
      CannotRead(path);
    }
    this->Size_ = static_cast<std::size_t>(state.st_size);
  }
  ~OpenFile() { ::close(this->Descriptor_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  std::size_t Size() const { return this->Size_; }

  std::string Read(std::size_t count) const {
    std::string bytes(count, '\0');
    for (std::size_t done = 0; done < count;) {
      const ssize_t got = ::read(this->Descriptor_, bytes.data() + done, count - done);
      if (got < 0 && errno == EINTR) {
        continue;
      }
      if (got < 0) {
        CannotRead(this->Path_);
      }
      if (got == 0) {
        throw Error(Error::Kind::Io, FileObject(this->Path_),
                    "cannot be read: it became shorter meanwhile");
      }
      done += static_cast<std::size_t>(got);
    }
    return bytes;
  }

private:
  const std::string& Path_;
  int Descriptor_;
  std::size_t Size_ = 0;
};

} // namespace

std::string FileObject(const std::string& path) {
  return "file '" + path + "'";
}

void SetImportFileOpener(int (*open)(const std::string& path)) {
  Opener = open;
}

int OpenImportFile(const std::string& path) {
  NoteFileRead(path); // before reading, so that a concurrent change is detected
  struct stat state = {};
  if (::stat(path.c_str(), &state) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) {
      throw Error(Error::Kind::NotFound, FileObject(path), "does not exist");
    }
    CannotRead(path);
  }
  RequireRegular(path, state);
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    CannotRead(path);
  }
  if (::fstat(descriptor, &state) != 0 || !S_ISREG(state.st_mode)) { // replaced meanwhile
    ::close(descriptor);
    RequireRegular(path, state);
    CannotRead(path);
  }
  return descriptor;
}

std::string ReadFileBytes(const std::string& path, std::size_t maximum) {
  const OpenFile file(path);
  if (file.Size() == 0) {
    throw Error(Error::Kind::Corrupt, FileObject(path), "is empty");
  }
  if (file.Size() > maximum) {
    throw Error(Error::Kind::Resource, FileObject(path),
                "has " + std::to_string(file.Size()) + " bytes; at most " +
                    std::to_string(maximum) + " are read");
  }
  return file.Read(file.Size());
}

std::string ReadFileStart(const std::string& path, std::size_t count) {
  const OpenFile file(path);
  if (file.Size() == 0) {
    throw Error(Error::Kind::Corrupt, FileObject(path), "is empty");
  }
  return file.Read(std::min(count, file.Size()));
}

std::string ReadFileText(const std::string& path, std::size_t maximum) {
  return ToFileText(ReadFileBytes(path, maximum), FileObject(path));
}

} // namespace dspace
