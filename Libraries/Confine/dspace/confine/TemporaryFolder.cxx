#include <dspace/confine/TemporaryFolder.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dspace::confine {
namespace {

// Never returns. No stream, folder or terminal of the caller stays in use.
[[noreturn]] void RemoveAfter(int process, const std::string& folder) {
  setsid();
  const int none = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    dup2(none, stream);
  }
  dup2(process, STDERR_FILENO + 1);
  closefrom(STDERR_FILENO + 2);
  std::error_code ignored;
  std::filesystem::current_path("/", ignored);
  pollfd end = {STDERR_FILENO + 1, POLLIN, 0};
  while (poll(&end, 1, -1) < 0 && errno == EINTR) {
  }
  std::filesystem::remove_all(folder, ignored);
  _exit(0);
}

} // namespace

std::string MakeTemporaryFolder(const std::string& above) {
  const int self = int(syscall(SYS_pidfd_open, getpid(), 0));
  std::string folder = above + "/dspace-confined-XXXXXX";
  if (self < 0 || !mkdtemp(folder.data())) {
    throw std::system_error(errno, std::generic_category(), "temporary folder in '" + above + "'");
  }
  // The child of a child: the program, which this process becomes, has none that it does not know.
  const pid_t child = fork();
  if (child == 0) {
    if (fork() == 0) {
      RemoveAfter(self, folder);
    }
    _exit(0);
  }
  waitpid(child, nullptr, 0);
  close(self);
  return folder;
}

} // namespace dspace::confine
