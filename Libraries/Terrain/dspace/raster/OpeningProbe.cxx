#include <dspace/raster/OpeningProbe.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <system_error>

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <dspace/Budgets.h>
#include <dspace/Error.h>

extern char** environ;

namespace dspace {
namespace {

bool IsProbed(GDALOpenInfo& info) {
  for (const char* name : {"netCDF", "HDF5", "HDF5Image", "BAG", "KEA", "HDF4", "HDF4Image"}) {
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(name);
    if (driver && driver->pfnIdentify && driver->pfnIdentify(&info) == TRUE) {
      return true;
    }
  }
  return false;
}

std::string ProbeProgram() {
  Dl_info info{};
  const bool found =
      dladdr(reinterpret_cast<const void*>(&ProbeOpening), &info) != 0 && info.dli_fname;
  const std::filesystem::path library = found ? info.dli_fname : "";
  return (library.parent_path() / "dspace" / "dspace-raster-probe").string();
}

// Starts the program, whose standard output is `output`.
pid_t Start(std::string path, unsigned flags, int output) {
  std::string program = ProbeProgram();
  std::string kind = std::to_string(flags);
  std::string memory = std::to_string(BudgetOf(Budget::OpenMemory));
  char* words[] = {program.data(), path.data(), kind.data(), memory.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = -1;
  const int failure = posix_spawn(&process, program.c_str(), &actions, nullptr, words, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) {
    throw Error(Error::Kind::Internal, "program '" + program + "'",
                "cannot be started: " + std::generic_category().message(failure) +
                    "; accepted: the program that is installed with Dspace's libraries");
  }
  return process;
}

std::string ReadAll(int descriptor) {
  std::string text;
  char block[4096];
  ssize_t got = 0;
  while ((got = ::read(descriptor, block, sizeof block)) > 0 || (got < 0 && errno == EINTR)) {
    text.append(block, got > 0 ? std::size_t(got) : 0);
  }
  return text;
}

} // namespace

void ProbeOpening(GDALOpenInfo& info) {
  if (!IsProbed(info)) {
    return;
  }
  const std::string path = info.pszFilename;
  const std::string object = "file '" + path.substr(0, 1000) + "'";
  int both[2] = {-1, -1};
  if (::pipe2(both, O_CLOEXEC) != 0) {
    throw Error(Error::Kind::Resource, object,
                "no pipe can be made: " + std::generic_category().message(errno));
  }
  pid_t process = -1;
  try {
    process = Start(path, unsigned(info.nOpenFlags), both[1]);
  } catch (const Error&) {
    ::close(both[0]);
    ::close(both[1]);
    throw;
  }
  ::close(both[1]);
  const std::string said = ReadAll(both[0]);
  ::close(both[0]);
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    throw Error(Error::Kind::Resource, object,
                number == SIGXCPU || number == SIGALRM
                    ? "it takes more than a minute to open"
                    : "the process that tried to open it ended by signal " +
                          std::to_string(number) + "; " + BudgetText(Budget::OpenMemory));
  }
  if (WEXITSTATUS(status) != 0) {
    throw Error(Error::Kind::Corrupt, object,
                (said.empty() ? "it cannot be opened" : said) + "; " +
                    BudgetText(Budget::OpenMemory));
  }
}

} // namespace dspace
