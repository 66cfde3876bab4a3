#include <dspace/confine/TemporaryFolder.h>

#include <cerrno>
#include <csignal>
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
[[noreturn]] void RemoveAfter(pid_t process, int descriptor, const std::string& folder) {
  setsid();
  const int none = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    dup2(none, stream);
  }
  if (descriptor >= 0) {
    dup2(descriptor, STDERR_FILENO + 1);
  }
  closefrom(STDERR_FILENO + 1 + (descriptor >= 0));
  std::error_code ignored;
  std::filesystem::current_path("/", ignored);
  pollfd end = {STDERR_FILENO + 1, POLLIN, 0};
  while (descriptor >= 0 && poll(&end, 1, -1) < 0 && errno == EINTR) {
  }
  while (descriptor < 0 && kill(process, 0) == 0) {
    sleep(1); // where a container rejects pidfd_open
  }
  std::filesystem::remove_all(folder, ignored);
  _exit(0);
}

} // namespace

std::string MakeTemporaryFolder(const std::string& above) {
  const pid_t process = getpid();
  const int self = int(syscall(SYS_pidfd_open, process, 0));
  std::string folder = above + "/dspace-confined-XXXXXX";
  if (!mkdtemp(folder.data())) {
    throw std::system_error(errno, std::generic_category(), "temporary folder in '" + above + "'");
  }
  // The child of a child: the program, which this process becomes, has none that it does not know.
  const pid_t child = fork();
  if (child == 0) {
    if (fork() == 0) {
      RemoveAfter(process, self, folder);
    }
    _exit(0);
  }
  waitpid(child, nullptr, 0);
  if (self >= 0) {
    close(self);
  }
  return folder;
}

} // namespace dspace::confine
