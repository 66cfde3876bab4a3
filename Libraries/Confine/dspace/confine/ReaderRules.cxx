#include <dspace/confine/ReaderRules.h>

#include <cerrno>
#include <system_error>

#include <sys/prctl.h>
#include <unistd.h>

namespace dspace::confine {

ReaderRules::ReaderRules(const std::vector<std::string>& folders, int abi)
    : Files_(abi, false, false), Calls_(CallsOfReader()) {
  std::vector<std::string> read = {"/usr", "/lib", "/lib32", "/lib64", "/etc/ld.so.cache"};
  read.insert(read.end(), folders.begin(), folders.end());
  for (const std::string& path : read) {
    if (access(path.c_str(), R_OK) == 0) {
      this->Files_.Allow(path, FileAccess::Read);
    }
  }
}

void ReaderRules::Enforce() const {
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
    throw std::system_error(errno, std::generic_category(), "no-new-privileges");
  }
  this->Files_.Enforce();
  FilterCallsOfReader(this->Calls_);
}

} // namespace dspace::confine
