// A worker whose readers fail in every way, by the name of the file: for TestImportWorker.
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <dspace/Error.h>
#include <dspace/import/files/ImageReader.h>
#include <dspace/import/files/ImportFile.h>
#include <dspace/import/files/ModelReader.h>
#include <dspace/import/worker/WorkerProcess.h>

namespace {

struct Attempt {
  const char* name;
  std::function<bool()> succeeds;
};

// Everything that a document must not be able to do. `folder` is the document's.
std::vector<Attempt> Attempts(const std::string& folder) {
  const std::string beside = folder + "/beside";
  const std::string made = folder + "/made";
  const auto opens = [](const std::string& path, int flags) {
    const int file = open(path.c_str(), flags, 0600);
    return file >= 0 && close(file) == 0;
  };
  return {
      {"read", [=] { return opens(beside, O_RDONLY); }},
      {"list", [=] { return opens(folder, O_RDONLY | O_DIRECTORY); }},
      {"process", [=] { return opens("/proc/self/maps", O_RDONLY); }},
      {"write", [=] { return opens(beside, O_WRONLY); }},
      {"create", [=] { return opens(made, O_RDWR | O_CREAT); }},
      {"creat", [=] { return close(creat(made.c_str(), 0600)) == 0; }},
      {"folder", [=] { return mkdir((made + "-folder").c_str(), 0700) == 0; }},
      {"link", [=] { return symlink("/", (made + "-link").c_str()) == 0; }},
      {"rename", [=] { return rename(beside.c_str(), (beside + "2").c_str()) == 0; }},
      {"truncate", [=] { return truncate((beside + "2").c_str(), 0) == 0; }},
      {"rights", [=] { return chmod(folder.c_str(), 0755) == 0; }},
      {"rights of a descriptor",
       [] { return fchmod(memfd_create("test", MFD_CLOEXEC), 0600) == 0; }},
      {"remove", [=] { return unlink((beside + "2").c_str()) == 0; }},
      {"socket of the network", [] { return close(socket(AF_INET, SOCK_STREAM, 0)) == 0; }},
      {"socket of messages", [] { return close(socket(AF_INET, SOCK_DGRAM, 0)) == 0; }},
      {"socket of a path", [] { return close(socket(AF_UNIX, SOCK_STREAM, 0)) == 0; }},
      {"pair of sockets",
       [] {
         int both[2];
         return socketpair(AF_UNIX, SOCK_STREAM, 0, both) == 0;
       }},
      {"start a program",
       [] {
         char name[] = "/bin/true";
         char* words[] = {name, nullptr};
         pid_t process = -1;
         return posix_spawn(&process, name, nullptr, nullptr, words, nullptr) == 0;
       }},
      {"become a program",
       [] {
         char name[] = "/nowhere";
         char* words[] = {name, nullptr};
         return execv(name, words) != 0 && errno == ENOENT;
       }},
      {"fork",
       [] {
         const pid_t process = fork();
         if (process == 0) {
           _exit(0);
         }
         return process > 0;
       }},
      {"trace",
       [] { return ptrace(PTRACE_PEEKUSER, getpid(), nullptr, nullptr) == -1 && errno == ESRCH; }},
      {"signal", [] { return kill(getppid(), 0) == 0; }},
      {"signal to a thread", [] { return syscall(SYS_tgkill, getppid(), getppid(), 0) == 0; }},
      {"limits",
       [] {
         rlimit limit = {};
         getrlimit(RLIMIT_NOFILE, &limit);
         return setrlimit(RLIMIT_NOFILE, &limit) == 0;
       }},
      {"outlive", [] { return prctl(PR_SET_PDEATHSIG, 0) == 0; }},
  };
}

std::string Succeeding(const std::string& folder) {
  std::string names;
  for (const Attempt& each : Attempts(folder)) {
    names += each.succeeds() ? std::string(each.name) + ", " : "";
  }
  std::thread([&] { names += "thread"; }).join();
  return names;
}

dspace::Model Read(const std::string& path, const dspace::ImportOptions& options) {
  const std::string fault = std::filesystem::path(path).stem().string();
  if (fault == "abort") {
    std::abort();
  }
  if (fault == "memory") {
    std::vector<char*> blocks;
    for (;;) {
      constexpr std::size_t Block = std::size_t(1) << 22;
      blocks.push_back(new char[Block]);
      std::memset(blocks.back(), 1, Block);
    }
  }
  if (fault == "sleep") {
    std::this_thread::sleep_for(std::chrono::hours(1));
  }
  if (fault == "spin") {
    volatile std::uint64_t count = 0;
    for (;;) {
      count = count + 1;
    }
  }
  if (fault == "exit") {
    _exit(3);
  }
  if (fault == "liar") {              // a message of its own instead of a result
    const char bytes[] = "\6nothing"; // a kind, and a size that no message has
    for (int socket = 3; socket < 20; ++socket) {
      send(socket, bytes, sizeof bytes, MSG_NOSIGNAL);
    }
  }
  if (fault == "indices") {
    dspace::Model model = dspace::ReadModel(path, options);
    model.meshes[0].indices[0] = 1000000;
    return model;
  }
  if (fault == "outside") {
    dspace::ReadFileBytes("/etc/hostname");
  }
  if (fault == "hostile") {
    throw dspace::Error(dspace::Error::Kind::Corrupt, "attempts",
                        Succeeding(std::filesystem::path(path).parent_path().string()));
  }
  return dspace::ReadModel(path, options);
}

} // namespace

// With a folder: prints the attempts that succeed in this process, which nothing restricts.
int main(int count, char** words) {
  if (count == 2) {
    std::puts(Succeeding(words[1]).c_str());
    return 0;
  }
  const char* landlock = std::getenv("FAULTY_LANDLOCK");
  return dspace::RunImportWorker({Read, dspace::ReadImage, dspace::ReadUrdf}, nullptr,
                                 landlock ? std::atoi(landlock)
                                          : dspace::confine::FileRules::KernelAbi());
}
