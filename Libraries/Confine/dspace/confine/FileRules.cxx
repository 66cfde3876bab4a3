#include <dspace/confine/FileRules.h>

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <linux/landlock.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace dspace::confine {
namespace {

// Of later kernels than the header of Debian 12.
constexpr std::uint64_t Truncate = 1ULL << 14;
constexpr std::uint64_t DeviceCalls = 1ULL << 15;
constexpr std::uint64_t BindTcp = 1ULL << 0;
constexpr std::uint64_t ConnectTcp = 1ULL << 1;
constexpr std::uint64_t OtherAbstractSockets = 1ULL << 0;
constexpr std::uint64_t OtherSignals = 1ULL << 1;

struct RulesetAttributes { // landlock_ruleset_attr, as of version 6
  std::uint64_t files;
  std::uint64_t ports;  // since version 4
  std::uint64_t scopes; // since version 6
};

constexpr std::uint64_t Reading = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t Writing = LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
                                  LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_DIR |
                                  LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_REFER | Truncate;
constexpr std::uint64_t OfFiles = LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_WRITE_FILE |
                                  LANDLOCK_ACCESS_FS_READ_FILE | Truncate | DeviceCalls;

std::uint64_t AllOf(int abi) {
  std::uint64_t all = 0;
  if (abi >= 1) {
    all = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1;
  }
  if (abi >= 2) {
    all |= LANDLOCK_ACCESS_FS_REFER;
  }
  if (abi >= 3) {
    all |= Truncate;
  }
  if (abi >= 5) {
    all |= DeviceCalls;
  }
  return all;
}

std::uint64_t RightsOf(FileAccess access) {
  switch (access) {
  case FileAccess::Read:
    return Reading;
  case FileAccess::Program:
    return Reading | LANDLOCK_ACCESS_FS_EXECUTE;
  case FileAccess::Write:
    return Reading | Writing;
  case FileAccess::Socket:
    return LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_REMOVE_FILE;
  case FileAccess::Device:
    return Reading | LANDLOCK_ACCESS_FS_WRITE_FILE | Truncate | DeviceCalls;
  }
  return 0;
}

[[noreturn]] void Fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

} // namespace

int FileRules::KernelAbi() {
  const long abi =
      syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  return abi > 0 ? int(abi) : 0;
}

FileRules::FileRules(int abi, bool listen, bool connect) : Handled_(AllOf(abi)) {
  if (abi < 1) {
    return;
  }
  RulesetAttributes attributes = {this->Handled_, 0, 0};
  std::size_t size = sizeof(attributes.files);
  if (abi >= 4) {
    attributes.ports = (listen ? 0 : BindTcp) | (connect ? 0 : ConnectTcp);
    size += sizeof(attributes.ports);
  }
  if (abi >= 6) {
    attributes.scopes = OtherAbstractSockets | OtherSignals;
    size += sizeof(attributes.scopes);
  }
  this->Ruleset_ = int(syscall(SYS_landlock_create_ruleset, &attributes, size, 0));
  if (this->Ruleset_ < 0) {
    Fail("Landlock");
  }
}

FileRules::~FileRules() {
  if (this->Ruleset_ >= 0) {
    close(this->Ruleset_);
  }
}

void FileRules::Allow(const std::string& path, FileAccess access) {
  const int file = open(path.c_str(), O_PATH | O_CLOEXEC);
  struct stat info = {};
  if (file < 0 || fstat(file, &info) != 0) {
    Fail("'" + path + "'");
  }
  if (this->Ruleset_ >= 0) {
    const bool folder = S_ISDIR(info.st_mode);
    landlock_path_beneath_attr rule = {};
    rule.allowed_access = RightsOf(access) & this->Handled_ & (folder ? ~0ULL : OfFiles);
    rule.parent_fd = file;
    if (rule.allowed_access != 0 &&
        syscall(SYS_landlock_add_rule, this->Ruleset_, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) != 0) {
      Fail("'" + path + "'");
    }
  }
  close(file);
}

void FileRules::Enforce() const {
  if (this->Ruleset_ >= 0 && syscall(SYS_landlock_restrict_self, this->Ruleset_, 0) != 0) {
    Fail("Landlock");
  }
}

} // namespace dspace::confine
