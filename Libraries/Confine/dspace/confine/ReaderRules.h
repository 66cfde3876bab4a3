// What a process may do that reads one document which nobody trusts.
#ifndef DSPACE_CONFINE_READERRULES_H
#define DSPACE_CONFINE_READERRULES_H

#include <string>
#include <vector>

#include <dspace/confine/CallFilter.h>
#include <dspace/confine/FileRules.h>

namespace dspace::confine {

// Such a process has the descriptors that it needs, asks another process for more, and can load
// libraries. It cannot open any other file, write one, make a socket, start a program or reach
// another process. Memory and time are not restricted here.
class ReaderRules {
public:
  // Prepares the rules, so that a forked child does none of that work. It may read the folders of
  // the system's libraries and fonts and `folders`, with all below; those that are not there are
  // left out. abi: the version of Landlock to use (FileRules.h); 0: files to be read are not
  // restricted, all else is. Throws std::exception.
  explicit ReaderRules(const std::vector<std::string>& folders = {},
                       int abi = FileRules::KernelAbi());

  // From now on, for good, in this process. It has one thread. Throws std::exception.
  void Enforce() const;

private:
  FileRules Files_;
  std::vector<sock_filter> Calls_;
};

} // namespace dspace::confine

#endif
