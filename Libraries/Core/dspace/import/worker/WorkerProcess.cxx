#include <dspace/import/worker/WorkerProcess.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <new>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <dspace/Budgets.h>
#include <dspace/Error.h>
#include <dspace/FileText.h>
#include <dspace/confine/ReaderRules.h>
#include <dspace/import/files/ImageCodec.h>
#include <dspace/import/files/ImportFile.h>
#include <dspace/import/worker/ModelBytes.h>
#include <dspace/import/worker/UrdfBytes.h>
#include <dspace/import/worker/WorkerMessage.h>
#include <dspace/letters/FontFiles.h>

namespace dspace {
namespace {

constexpr int Control = 3;
constexpr std::size_t MostForeignFiles = 8; // that are told of
using Clock = std::chrono::steady_clock;

int Session = -1; // a child's socket to the session

// The child may open nothing: the session checks the name and opens the file.
int AskForFile(const std::string& path) {
  ByteWriter text;
  text.Text(path);
  WorkerMessage answer;
  if (!SendWorkerMessage(Session, WorkerMessage::Kind::Open, text.Text()) ||
      !ReceiveWorkerMessage(Session, answer)) {
    _exit(EXIT_FAILURE); // nobody waits for the result
  }
  if (answer.kind == WorkerMessage::Kind::Opened && answer.descriptor.Get() >= 0) {
    return answer.descriptor.Release();
  }
  throw ErrorOf(answer.payload, FileObject(path));
}

void Limit(int resource, std::uint64_t value) {
  const rlimit limit = {value, value};
  setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

void LimitMemory(std::uint64_t memory) {
  // The shadow memory of the address sanitizer needs the address space.
  if (dlsym(RTLD_DEFAULT, "__asan_init")) {
    return;
  }
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  Limit(RLIMIT_AS, memory + pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)));
}

void LimitChild(const WorkerRequest& request) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  Limit(RLIMIT_CORE, 0);
  Limit(RLIMIT_FSIZE, request.memory); // of the result, which is a file in memory
  const rlimit processor = {request.seconds, request.seconds + 1};
  setrlimit(RLIMIT_CPU, &processor);
  LimitMemory(request.memory);
  std::set_new_handler([] { _exit(WorkerExitForMemory); });
}

std::string FolderOf(const void* function) {
  Dl_info info{};
  const bool found = dladdr(function, &info) != 0 && info.dli_fname;
  return found ? std::filesystem::path(info.dli_fname).parent_path().string() : std::string();
}

// A child loads the library of images, and draws letters; all else comes from the session.
std::vector<std::string> FoldersOfChildren() {
  std::vector<std::string> folders = {FolderOf(reinterpret_cast<const void*>(&LoadImageCodec))};
  for (const Font font : {Font::Sans, Font::Mono}) {
    folders.push_back(std::filesystem::path(FontFile(font)).parent_path().string());
  }
  const char* libraries = std::getenv("LD_LIBRARY_PATH");
  std::istringstream words(libraries ? libraries : "");
  for (std::string word; std::getline(words, word, ':');) {
    if (!word.empty() && word.front() == '/') {
      folders.push_back(word);
    }
  }
  return folders;
}

Descriptor ResultFile() {
  Descriptor file(memfd_create("dspace-import", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (file.Get() < 0) {
    throw Error(Error::Kind::Io, "the result of an import",
                "has no file in memory: " + std::generic_category().message(errno));
  }
  return file;
}

void Serve(const WorkerRequest& request, const WorkerReaders& readers) {
  ImportOptions options;
  options.strict = request.strict;
  options.pointCloud = request.pointCloud;
  options.maximumTriangles = static_cast<std::size_t>(request.maximumTriangles);
  const bool hadCodec = ImageCodecIsLoaded();
  const ForeignTextScope foreign;
  const Descriptor result = ResultFile();
  ByteWriter into(result.Get());
  if (request.what == WorkerRequest::What::Image) {
    WriteImage(*readers.image(request.path), into);
  } else if (request.what == WorkerRequest::What::Urdf) {
    WriteUrdf(readers.urdf(request.path, options), into);
  } else {
    WriteModel(readers.model(request.path, options), into);
  }
  into.Flush();
  ByteWriter done;
  done.Number<std::uint8_t>(!hadCodec && ImageCodecIsLoaded());
  const std::size_t files = std::min(foreign.Objects().size(), MostForeignFiles);
  done.Number<std::uint64_t>(files);
  auto file = foreign.Objects().begin();
  for (std::size_t i = 0; i < files; ++i) {
    done.Text(*file++);
  }
  SendWorkerMessage(Session, WorkerMessage::Kind::Done, done.Text(), result.Get());
}

[[noreturn]] void RunChild(const WorkerRequest& request, const WorkerReaders& readers,
                           const confine::ReaderRules& rules) {
  LimitChild(request);
  SetBudget("image_pixels", request.imagePixels);
  SetBudget("texture_bytes", request.textureBytes);
  SetImportFileOpener(AskForFile);
  try {
    rules.Enforce();
    Serve(request, readers);
  } catch (const Error& error) {
    SendWorkerMessage(Session, WorkerMessage::Kind::Failed, ErrorText(error));
  } catch (const std::bad_alloc&) {
    _exit(WorkerExitForMemory);
  } catch (const std::exception& error) {
    SendWorkerMessage(Session, WorkerMessage::Kind::Failed,
                      ErrorText(Error(Error::Kind::Corrupt, FileObject(request.path),
                                      std::string("cannot be read: ") + error.what())));
  }
  _exit(EXIT_SUCCESS);
}

// The process that forks: it runs no code of importers after its start, and has one thread.
class Worker {
public:
  Worker(const WorkerReaders& readers, int landlock)
      : Readers_(readers), Rules_(FoldersOfChildren(), landlock) {
    sigset_t children;
    sigemptyset(&children);
    sigaddset(&children, SIGCHLD);
    sigprocmask(SIG_BLOCK, &children, nullptr);
    this->Ended_ = Descriptor(signalfd(-1, &children, SFD_CLOEXEC | SFD_NONBLOCK));
  }

  int Run() {
    this->ForkSpare();
    for (;;) {
      std::vector<pollfd> watched = {{Control, POLLIN, 0}, {this->Ended_.Get(), POLLIN, 0}};
      for (const auto& [process, child] : this->Children_) {
        watched.push_back({child.socket.Get(), 0, 0}); // only whether the session has closed it
      }
      if (::poll(watched.data(), watched.size(), this->NextDeadline_ms()) < 0 && errno != EINTR) {
        return EXIT_FAILURE;
      }
      this->EndAbandoned(watched);
      this->EndLate();
      this->Reap();
      if (watched[0].revents != 0 && !this->TakeRequest()) {
        return EXIT_SUCCESS; // PR_SET_PDEATHSIG ends the children
      }
    }
  }

private:
  struct Child {
    Descriptor socket;
    Clock::time_point deadline;
    bool late = false;
  };
  // A child without a document. It ends at the end of its socket.
  struct Spare {
    pid_t process = -1;
    Descriptor socket = Descriptor();
  };

  bool TakeRequest() {
    WorkerMessage message;
    if (!ReceiveWorkerMessage(Control, message)) {
      return false;
    }
    if (message.kind == WorkerMessage::Kind::WarmCodec) {
      try {
        LoadImageCodec();
      } catch (const Error&) {
        // The child that needs it says why it cannot be loaded.
      }
      this->Spare_ = {}; // it is without that library
    } else if (message.kind == WorkerMessage::Kind::Document) {
      this->Give(std::move(message));
    }
    this->ForkSpare();
    return true;
  }

  // Forks the child of the next document, which then does not wait for that. Where it cannot be
  // forked there is none.
  void ForkSpare() {
    int both[2] = {-1, -1};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, both) != 0) {
      return;
    }
    Descriptor mine(both[0]);
    Descriptor childs(both[1]);
    const pid_t process = ::fork();
    if (process == 0) {
      ::close(Control);
      this->Ended_.Close();
      this->Children_.clear(); // the sockets of other documents
      mine.Close();
      sigset_t none;
      sigemptyset(&none);
      sigprocmask(SIG_SETMASK, &none, nullptr);
      WorkerMessage message;
      if (!ReceiveWorkerMessage(childs.Get(), message)) {
        _exit(EXIT_SUCCESS); // no document comes any more
      }
      childs.Close();
      Session = message.descriptor.Release();
      RunChild(RequestOf(message.payload), this->Readers_, this->Rules_);
    }
    if (process > 0) {
      this->Spare_ = {process, std::move(mine)};
    }
  }

  void Give(WorkerMessage message) {
    const WorkerRequest request = RequestOf(message.payload);
    // Twice: the spare child may have ended.
    for (int i = 0; i < 2; ++i) {
      if (this->Spare_.process <= 0) {
        this->ForkSpare();
      }
      const Spare child = std::exchange(this->Spare_, {});
      if (child.process > 0 && SendWorkerMessage(child.socket.Get(), message.kind, message.payload,
                                                 message.descriptor.Get())) {
        const auto wait = std::chrono::seconds(std::min<std::uint64_t>(request.seconds, 1000000));
        this->Children_.emplace(child.process,
                                Child{std::move(message.descriptor), Clock::now() + wait});
        return;
      }
    }
    SendWorkerMessage(message.descriptor.Get(), WorkerMessage::Kind::Failed,
                      ErrorText(Error(Error::Kind::Resource, FileObject(request.path),
                                      "no process can be made to read it: " +
                                          std::generic_category().message(errno))));
  }

  int NextDeadline_ms() const {
    auto next = Clock::time_point::max();
    for (const auto& [process, child] : this->Children_) {
      next = child.late ? next : std::min(next, child.deadline);
    }
    if (next == Clock::time_point::max()) {
      return -1;
    }
    const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(next - Clock::now());
    return static_cast<int>(
        std::clamp<std::int64_t>(wait.count() + 1, 0, std::numeric_limits<int>::max()));
  }

  void EndAbandoned(const std::vector<pollfd>& watched) {
    std::size_t at = 2;
    for (auto& [process, child] : this->Children_) {
      if (watched[at++].revents != 0) {
        ::kill(process, SIGKILL);
        child.socket.Close(); // poll() leaves out what is negative
      }
    }
  }

  void EndLate() {
    const auto now = Clock::now();
    for (auto& [process, child] : this->Children_) {
      if (!child.late && now >= child.deadline) {
        child.late = true;
        ::kill(process, SIGKILL);
      }
    }
  }

  void Reap() {
    signalfd_siginfo ignored;
    while (::read(this->Ended_.Get(), &ignored, sizeof ignored) > 0) {
    }
    int status = 0;
    for (pid_t process = 0; (process = ::waitpid(-1, &status, WNOHANG)) > 0;) {
      const auto found = this->Children_.find(process);
      if (found == this->Children_.end()) {
        continue;
      }
      const bool signaled = WIFSIGNALED(status);
      const WorkerDeath death = found->second.late ? WorkerDeath::Timeout
                                : signaled         ? WorkerDeath::Signal
                                                   : WorkerDeath::Exit;
      ByteWriter text;
      text.Number(static_cast<std::uint8_t>(death));
      text.Number<std::int32_t>(signaled ? WTERMSIG(status) : WEXITSTATUS(status));
      if (found->second.socket.Get() >= 0) {
        SendWorkerMessage(found->second.socket.Get(), WorkerMessage::Kind::Died, text.Text());
      }
      this->Children_.erase(found);
    }
  }

  WorkerReaders Readers_;
  confine::ReaderRules Rules_;
  Descriptor Ended_;
  std::map<pid_t, Child> Children_;
  Spare Spare_;
};

} // namespace

int RunImportWorker(const WorkerReaders& readers, void (*warm)(), int landlock) {
  std::signal(SIGPIPE, SIG_IGN);
  ::close_range(Control + 1, ~0U, 0);
  Worker worker(readers, landlock);
  if (warm) {
    warm();
  }
  return worker.Run();
}

} // namespace dspace
