#include <dspace/import/worker/ImportWorker.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <dspace/Budgets.h>
#include <dspace/Error.h>
#include <dspace/FileText.h>
#include <dspace/import/files/ImportFile.h>
#include <dspace/import/worker/ModelBytes.h>
#include <dspace/import/worker/UrdfBytes.h>
#include <dspace/import/worker/WorkerMessage.h>

extern char** environ;

namespace dspace {
namespace {

constexpr int WorkerDescriptor = 3;
constexpr int Grace_s = 10; // for the worker to say that a document took too long

class SpawnSettings {
public:
  SpawnSettings() {
    posix_spawn_file_actions_init(&this->Actions);
    posix_spawnattr_init(&this->Attributes);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&this->Actions);
    posix_spawnattr_destroy(&this->Attributes);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;
  posix_spawn_file_actions_t Actions;
  posix_spawnattr_t Attributes;
};

// With large pages for the heap: each child begins without memory, and large models spend much of
// their time on its first use.
std::vector<char*> Environment() {
  static char pages[] = "GLIBC_TUNABLES=glibc.malloc.hugetlb=1";
  std::vector<char*> variables;
  bool given = false;
  for (char** variable = environ; variable && *variable; ++variable) {
    variables.push_back(*variable);
    given = given || std::strncmp(*variable, "GLIBC_TUNABLES=", 15) == 0;
  }
  if (!given) {
    variables.push_back(pages);
  }
  variables.push_back(nullptr);
  return variables;
}

pid_t Spawn(const std::string& program, int socket) {
  SpawnSettings settings;
  posix_spawn_file_actions_addopen(&settings.Actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  if (::fcntl(STDERR_FILENO, F_GETFD) >= 0) {
    posix_spawn_file_actions_adddup2(&settings.Actions, STDERR_FILENO, STDOUT_FILENO);
  }
  posix_spawn_file_actions_adddup2(&settings.Actions, socket, WorkerDescriptor);
  // Without the signals of the terminal: it ends when the session's process does.
  posix_spawnattr_setpgroup(&settings.Attributes, 0);
  sigset_t none;
  sigset_t all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&settings.Attributes, &none);
  posix_spawnattr_setsigdefault(&settings.Attributes, &all);
  posix_spawnattr_setflags(&settings.Attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::string name = program;
  char* arguments[] = {name.data(), nullptr};
  pid_t process = -1;
  std::vector<char*> environment = Environment();
  const int failure = posix_spawn(&process, program.c_str(), &settings.Actions,
                                  &settings.Attributes, arguments, environment.data());
  if (failure != 0) {
    throw Error(Error::Kind::Internal, "program '" + program + "'",
                "cannot be started: " + std::generic_category().message(failure) +
                    "; accepted: the program that is installed with Dspace's libraries");
  }
  return process;
}

// The file of a result, which nobody can change any more.
class ResultBytes {
public:
  ResultBytes(const Descriptor& file, const std::string& object) {
    struct stat state = {};
    const int seals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL;
    if (file.Get() < 0 || ::fcntl(file.Get(), F_ADD_SEALS, seals) != 0 ||
        ::fstat(file.Get(), &state) != 0 || state.st_size < 1) {
      throw Error(Error::Kind::Corrupt, object,
                  "the process that reads it gave no valid result: it has no file in memory");
    }
    this->Size_ = static_cast<std::size_t>(state.st_size);
    // Kernels before 6.7 reject a shared mapping of a file that is sealed against writing.
    void* data = ::mmap(nullptr, this->Size_, PROT_READ, MAP_PRIVATE | MAP_POPULATE, file.Get(), 0);
    if (data == MAP_FAILED) {
      throw Error(Error::Kind::Resource, object, "not enough memory to read it");
    }
    this->Data_ = data;
  }
  ~ResultBytes() { ::munmap(this->Data_, this->Size_); }
  ResultBytes(const ResultBytes&) = delete;
  ResultBytes& operator=(const ResultBytes&) = delete;

  ByteReader Reader(const std::string& object) const {
    return ByteReader(this->Data_, this->Size_, object);
  }

private:
  void* Data_ = nullptr;
  std::size_t Size_ = 0;
};

[[noreturn]] void ThrowDeath(const std::string& payload, const std::string& object) {
  ByteReader from(payload.data(), payload.size(), object);
  const auto death = from.Enumerator(WorkerDeath::Timeout);
  const auto number = from.Number<std::int32_t>();
  const bool late = death == WorkerDeath::Timeout;
  const bool killed = death == WorkerDeath::Signal;
  if (late || (killed && number == SIGXCPU)) {
    throw Error(Error::Kind::Resource, object,
                "it took too long to read; " + BudgetText(Budget::ImportSeconds));
  }
  if ((!killed && number == WorkerExitForMemory) || (killed && number == SIGXFSZ)) {
    throw Error(Error::Kind::Resource, object,
                "reading it needs too much memory; " + BudgetText(Budget::ImportMemory));
  }
  const std::string how =
      killed ? "by signal " + std::to_string(number) + " (" + std::string(strsignal(number)) + ")"
             : "with status " + std::to_string(number);
  throw Error(
      Error::Kind::Corrupt, object,
      "the process that reads it ended " + how +
          ": the file is damaged in a way that its reader does not detect, or it needs more "
          "memory than there is");
}

// Opens a file for the child, after the checks of this thread.
void AnswerOpen(int socket, const std::string& payload, const std::string& object) {
  ByteReader from(payload.data(), payload.size(), object);
  const std::string path = from.Text();
  from.End();
  try {
    const Descriptor file(OpenImportFile(path));
    SendWorkerMessage(socket, WorkerMessage::Kind::Opened, {}, file.Get());
  } catch (const Error& error) {
    SendWorkerMessage(socket, WorkerMessage::Kind::Denied, ErrorText(error));
  }
}

} // namespace

struct ImportWorker::Link {
  Descriptor control;
  pid_t process = -1; // of the worker
  pid_t owner = ::getpid();
  std::mutex sending; // of messages, by several threads

  bool Send(WorkerMessage::Kind kind, const std::string& payload = {}, int descriptor = -1) {
    const std::lock_guard<std::mutex> lock(this->sending);
    return SendWorkerMessage(this->control.Get(), kind, payload, descriptor);
  }

  // Whether the worker has ended. It closes its socket first, but a child may hold that longer.
  bool Ended() const {
    pollfd socket = {this->control.Get(), 0, 0};
    siginfo_t info = {};
    return ::poll(&socket, 1, 0) > 0 ||
           ::waitid(P_PID, static_cast<id_t>(this->process), &info, WEXITED | WNOWAIT | WNOHANG) ||
           info.si_pid == this->process;
  }

  ~Link() {
    this->control.Close(); // it ends, with its children
    if (this->process > 0 && this->owner == ::getpid()) {
      int status = 0;
      while (::waitpid(this->process, &status, 0) < 0 && errno == EINTR) {
      }
    }
  }
};

namespace {

// Notes what the child says of the files that it has read, and returns whether it has loaded the
// library of images.
bool TakeNotes(const std::string& payload, const std::string& object) {
  ByteReader from(payload.data(), payload.size(), object);
  const bool codec = from.Flag();
  for (std::size_t i = from.Count(sizeof(std::uint64_t)); i > 0; --i) {
    NoteForeignText(from.Text());
  }
  from.End();
  return codec;
}

// Serves the child until there is a result; nothing: its socket was closed before.
std::optional<Descriptor> ResultOf(int child, const WorkerRequest& request, bool& codec) {
  const std::string object = FileObject(request.path);
  const auto until = WorkerClock::now() + std::chrono::seconds(request.seconds + Grace_s);
  WorkerMessage message;
  for (;;) {
    if (!ReceiveWorkerMessage(child, message, until)) {
      if (WorkerClock::now() >= until) {
        throw Error(Error::Kind::Resource, object,
                    "it took too long to read; " + BudgetText(Budget::ImportSeconds));
      }
      return std::nullopt;
    }
    switch (message.kind) {
    case WorkerMessage::Kind::Open:
      AnswerOpen(child, message.payload, object);
      break;
    case WorkerMessage::Kind::Done:
      codec = TakeNotes(message.payload, object);
      return std::move(message.descriptor);
    case WorkerMessage::Kind::Failed:
      throw ErrorOf(message.payload, object);
    case WorkerMessage::Kind::Died:
      ThrowDeath(message.payload, object);
    default:
      throw Error(Error::Kind::Corrupt, object,
                  "the process that reads it gave no valid result: an unknown message");
    }
  }
}

WorkerRequest RequestFor(WorkerRequest::What what, const std::string& path,
                         const ImportOptions& options) {
  WorkerRequest request;
  request.what = what;
  request.path = path;
  request.strict = options.strict;
  request.pointCloud = options.pointCloud;
  request.maximumTriangles = options.maximumTriangles;
  request.memory = BudgetOf(Budget::ImportMemory);
  request.seconds = BudgetOf(Budget::ImportSeconds);
  request.imagePixels = BudgetOf(Budget::ImagePixels);
  request.textureBytes = BudgetOf(Budget::TextureBytes);
  return request;
}

} // namespace

ImportWorker& ImportWorker::OfProcess() {
  static ImportWorker worker([] {
    Dl_info info{};
    const bool found =
        dladdr(reinterpret_cast<const void*>(&ImportWorker::OfProcess), &info) != 0 &&
        info.dli_fname;
    const std::filesystem::path library = found ? info.dli_fname : "";
    return (library.parent_path() / "dspace" / "dspace-import-worker").string();
  }());
  return worker;
}

ImportWorker::ImportWorker(std::string program) : Program_(std::move(program)) {}

ImportWorker::~ImportWorker() = default;

std::shared_ptr<ImportWorker::Link> ImportWorker::Started() {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  if (this->Link_ && this->Link_->owner != ::getpid()) {
    this->Link_.reset(); // that of the process from which this one was forked
  }
  if (!this->Link_) {
    auto [mine, theirs] = WorkerSockets();
    auto link = std::make_shared<Link>();
    link->process = Spawn(this->Program_, theirs.Get());
    link->control = std::move(mine);
    this->Link_ = std::move(link);
  }
  return this->Link_;
}

void ImportWorker::Drop(const std::shared_ptr<Link>& link) {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  if (this->Link_ == link) {
    this->Link_.reset();
  }
}

void ImportWorker::Start() {
  this->Started();
}

int ImportWorker::Process() const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  return this->Link_ ? this->Link_->process : -1;
}

Descriptor ImportWorker::Ask(const WorkerRequest& request) {
  ++this->Documents_;
  // Twice: the worker may have ended since the last document, even with this one unread.
  for (int i = 0; i < 2; ++i) {
    const std::shared_ptr<Link> link = this->Started();
    auto [mine, theirs] = WorkerSockets();
    if (link->Send(WorkerMessage::Kind::Document, RequestText(request), theirs.Get())) {
      theirs.Close();
      bool codec = false;
      std::optional<Descriptor> file = ResultOf(mine.Get(), request, codec);
      if (codec) {
        link->Send(WorkerMessage::Kind::WarmCodec);
      }
      if (file) {
        return std::move(*file);
      }
      if (!link->Ended() || i > 0) {
        throw Error(Error::Kind::Internal, FileObject(request.path),
                    "the process that reads it gave no valid result: it was ended from outside, or "
                    "sent what is no message");
      }
    }
    this->Drop(link);
  }
  throw Error(Error::Kind::Internal, FileObject(request.path),
              "the process that reads models ends when it is started; accepted: a complete "
              "installation");
}

Model ImportWorker::ReadModel(const std::string& path, const ImportOptions& options) {
  const WorkerRequest request = RequestFor(WorkerRequest::What::Model, path, options);
  const Descriptor file = this->Ask(request);
  const ResultBytes bytes(file, FileObject(path));
  ByteReader from = bytes.Reader(FileObject(path));
  Model model = ReadModelBytes(from, path);
  from.End();
  if (model.TriangleCount() > options.maximumTriangles) {
    from.Fail("it has more triangles than were asked for");
  }
  return model;
}

std::shared_ptr<const Image> ImportWorker::ReadImage(const std::string& path) {
  const Descriptor file = this->Ask(RequestFor(WorkerRequest::What::Image, path, {}));
  const ResultBytes bytes(file, FileObject(path));
  ByteReader from = bytes.Reader(FileObject(path));
  std::shared_ptr<const Image> image = ReadImageBytes(from);
  from.End();
  return image;
}

Urdf ImportWorker::ReadUrdf(const std::string& path, const ImportOptions& options) {
  const Descriptor file = this->Ask(RequestFor(WorkerRequest::What::Urdf, path, options));
  const ResultBytes bytes(file, FileObject(path));
  ByteReader from = bytes.Reader(FileObject(path));
  Urdf urdf = ReadUrdfBytes(from, path);
  from.End();
  return urdf;
}

} // namespace dspace
