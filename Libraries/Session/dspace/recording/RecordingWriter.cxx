#include <dspace/recording/RecordingWriter.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <set>
#include <sstream>
#include <thread>

#include <google/protobuf/util/delimited_message_util.h>
#include <unistd.h>

#include <dspace/Checks.h>
#include <dspace/Error.h>
#include <dspace/messages/MeshMessages.h>
#include <dspace/recording/RecordingAssets.h>
#include <dspace/recording/RecordingChecksums.h>
#include <dspace/recording/RecordingFile.h>

namespace dspace::session {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t TransactionBytes =
    8u << 20; // starts a transaction when this many bytes are queued

// SQLite gives -0 back as 0, which has another checksum.
double WithoutMinus0(double value) {
  return value == 0.0 ? 0.0 : value;
}

double SystemTime() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

void Check(const RecordingOptions& options, const std::string& path) {
  const auto reject = [&](const std::string& what) {
    throw Error(Error::Kind::InvalidArgument, "recording '" + path + "'", what);
  };
  if (!(options.commitEvery_s >= 0.001 && options.commitEvery_s <= 60.0)) {
    reject("the time from commit to commit is " + NumberText(options.commitEvery_s) +
           " s; accepted: 0.001 to 60");
  }
  if (options.queueBytes < (1u << 20)) {
    reject("the queue has " + std::to_string(options.queueBytes) +
           " bytes; accepted: 1 MiB or more");
  }
  if (options.snapshotBytes == 0 || options.snapshotCommands == 0) {
    reject("the distance between snapshots is 0; accepted: 1 byte and 1 command or more");
  }
}

void CheckSize(const std::vector<v1::Command>& commands, const RecordingOptions& options,
               const std::string& path) {
  std::size_t bytes = 0;
  for (const v1::Command& command : commands) {
    bytes +=
        (HoldsMeshes(command) ? 0 : command.ByteSizeLong()) + 8; // arrays are rows of their own
  }
  if (bytes > options.largestSnapshot) {
    throw Error(Error::Kind::Resource, "recording '" + path + "'",
                "the initial state has " + std::to_string(bytes) + " bytes; accepted: up to " +
                    std::to_string(options.largestSnapshot));
  }
}

} // namespace

struct RecordingWriter::Impl {
  Impl(const std::string& filePath, const RecordingOptions& given)
      : path(filePath), options(given), file(filePath, given.maximumPages, given.checkpointPages),
        assets(file, given.pack) {}

  const std::string path;
  const RecordingOptions options;
  RecordingFile file; // the thread's, once it runs
  RecordingAssets assets;

  // The simulation's side.
  std::uint64_t seq = 0;
  double time_s = 0.0;
  double wall_s = 0.0;
  std::size_t bytesSince = 0;
  std::uint64_t commandsSince = 0;
  std::size_t lastSnapshot = 0;
  bool told = false;
  const CommandFiles* files = nullptr;
  FilesRead handed;             // to be noted
  std::set<std::string> arrays; // digests of those that the file has, or that are queued
  std::string lost;             // ranges of commands

  mutable std::mutex mutex;
  std::condition_variable news; // for the thread
  std::condition_variable room; // for the simulation
  std::deque<RecordingRow> queue;
  std::deque<std::pair<std::string, FileStamp>> newFiles;
  std::string newLost;    // empty: as it was
  std::size_t queued = 0; // bytes
  bool idle = true;
  bool stop = false;
  bool flush = false;
  RecordingCounts counts;
  std::thread thread;

  // A child of the process that records has no such thread, and the mutex as it was.
  const pid_t process = getpid();
  bool Forked() const { return getpid() != this->process; }
  std::string ForkedError() const {
    return "recording '" + this->path + "': process " + std::to_string(this->process) +
           " writes it, and this one is its child; accepted: a recording of its own";
  }

  // Stands still while the machine's clock is behind, which was set back.
  double WallTime() {
    const double now = this->options.clock ? this->options.clock() : SystemTime();
    this->wall_s = std::max(this->wall_s, now);
    return this->wall_s;
  }

  void EnqueueFiles(const v1::Command& command) {
    const CommandFiles none;
    for (const auto& [file, stamp] : (this->files ? *this->files : none).Of(command)) {
      const auto known = this->handed.find(file);
      if (known == this->handed.end() || !(known->second == stamp)) {
        this->handed[file] = stamp;
        const std::lock_guard<std::mutex> lock(this->mutex);
        this->newFiles.push_back({file, stamp});
      }
    }
  }

  // Takes the arrays out of the command. The row brings those that the file does not have yet.
  void TakeArraysOf(v1::Command& command, RecordingRow& row) {
    ForEachMesh(command, [&](v1::MeshData& mesh) {
      std::string bytes = TakeArrays(mesh);
      if (this->arrays.insert(mesh.digest()).second) {
        row.arrays.emplace_back(mesh.digest(), std::move(bytes));
      }
    });
  }

  // The row is not written, so that its arrays are not in the file.
  void Forget(const RecordingRow& row) {
    for (const auto& [digest, bytes] : row.arrays) {
      this->arrays.erase(digest);
    }
  }

  // Blocks while the queue is full; nothing after a failure.
  void Enqueue(RecordingRow row) {
    std::unique_lock<std::mutex> lock(this->mutex);
    this->room.wait(lock, [this] {
      return this->queued < this->options.queueBytes || !this->counts.failure.empty();
    });
    if (!this->counts.failure.empty()) {
      return;
    }
    this->queued += row.payload.size() + 64;
    for (const auto& [digest, bytes] : row.arrays) {
      this->queued += bytes.size();
    }
    this->counts.accepted += row.snapshot ? 0 : 1;
    this->queue.push_back(std::move(row));
    lock.unlock();
    this->news.notify_one();
  }

  // Empty, or why there is none; then the one before it leads here too.
  std::string TakeSnapshot(const Ledger& ledger) {
    this->bytesSince = 0;
    this->commandsSince = 0;
    RecordingRow row;
    row.snapshot = true;
    row.seq = this->seq;
    row.time_s = this->time_s;
    row.wall_s = this->WallTime();
    try {
      std::ostringstream out;
      std::vector<v1::Command> commands = ledger.Commands();
      for (v1::Command& command : commands) {
        this->TakeArraysOf(command, row);
        google::protobuf::util::SerializeDelimitedToOstream(command, &out);
      }
      row.kind = std::int32_t(commands.size());
      row.payload = out.str();
    } catch (const std::exception& error) {
      this->Forget(row);
      return error.what();
    }
    this->lastSnapshot = row.payload.size();
    if (this->lastSnapshot > this->options.largestSnapshot) {
      this->Forget(row);
      return "the state has " + std::to_string(this->lastSnapshot) + " bytes; accepted: up to " +
             std::to_string(this->options.largestSnapshot);
    }
    this->Enqueue(std::move(row));
    return {};
  }

  void Put(const v1::Command& accepted, const v1::Reply& reply, const Ledger& ledger) {
    v1::Command made;
    const v1::Command* recorded = &accepted;
    if (accepted.has_viewport_event()) {
      if (!ToRecorded(accepted, reply, made)) {
        return;
      }
      recorded = &made;
    }
    if (recorded->has_set_time()) {
      this->time_s = WithoutMinus0(recorded->set_time().time_s());
    }
    this->EnqueueFiles(*recorded);
    RecordingRow row;
    if (HoldsMeshes(*recorded)) {
      if (recorded != &made) {
        made = *recorded;
        recorded = &made;
      }
      this->TakeArraysOf(made, row);
    }
    row.seq = ++this->seq;
    row.time_s = this->time_s;
    row.wall_s = this->WallTime();
    row.kind = std::int32_t(recorded->command_case());
    row.payload = recorded->SerializeAsString();
    this->bytesSince += row.payload.size();
    ++this->commandsSince;
    this->Enqueue(std::move(row));
    // Not oftener than four times their own size: a large state costs a part of the file at most.
    if (this->bytesSince >= std::max(this->options.snapshotBytes, 4 * this->lastSnapshot) ||
        (this->commandsSince >= this->options.snapshotCommands &&
         this->bytesSince >= this->lastSnapshot)) {
      this->TakeSnapshot(ledger);
    }
  }

  std::string Fail(const std::string& why) {
    const std::lock_guard<std::mutex> lock(this->mutex);
    if (this->counts.failure.empty()) {
      this->counts.failure = "recording '" + this->path + "': " + why;
    }
    return this->counts.failure;
  }

  // Whole transactions only are ever seen: what is in one that fails is rolled back.
  void Write(const std::deque<RecordingRow>& rows,
             const std::deque<std::pair<std::string, FileStamp>>& files,
             const std::string& ranges) {
    RecordingChecksums sums(rows);
    this->file.Begin();
    try {
      for (const auto& [path, stamp] : files) {
        this->assets.Put(path, stamp);
      }
      for (std::size_t i = 0; i < rows.size(); ++i) {
        for (const auto& [digest, bytes] : rows[i].arrays) {
          this->assets.PutArrays(digest, bytes);
        }
        this->file.Put(rows[i], sums.Of(i));
      }
      if (!ranges.empty()) {
        this->file.PutLost(ranges);
      }
      this->file.Commit();
    } catch (...) {
      this->file.Rollback();
      throw;
    }
  }

  void Run() {
    std::unique_lock<std::mutex> lock(this->mutex);
    for (;;) {
      this->news.wait(lock, [this] { return this->stop || !this->queue.empty(); });
      if (this->queue.empty()) {
        return;
      }
      if (!this->stop && !this->flush) { // gathers a transaction
        const auto until =
            Clock::now() + std::chrono::duration_cast<Clock::duration>(
                               std::chrono::duration<double>(this->options.commitEvery_s));
        this->news.wait_until(lock, until, [this] {
          return this->stop || this->flush ||
                 this->queued >= std::min(this->options.queueBytes / 2, TransactionBytes);
        });
      }
      std::deque<RecordingRow> rows;
      std::deque<std::pair<std::string, FileStamp>> files;
      rows.swap(this->queue);
      std::string ranges;
      ranges.swap(this->newLost);
      files.swap(this->newFiles);
      this->queued = 0;
      this->idle = false;
      lock.unlock();
      this->room.notify_all();
      std::string failure;
      try {
        this->Write(rows, files, ranges);
      } catch (const std::exception& error) {
        failure = error.what();
      }
      lock.lock();
      this->idle = true;
      if (failure.empty()) {
        this->counts.missing = this->assets.Missing();
        for (const RecordingRow& row : rows) {
          this->counts.written += row.snapshot ? 0 : 1;
          this->counts.bytes += row.snapshot ? 0 : row.payload.size();
          this->counts.snapshots += row.snapshot ? 1 : 0;
        }
      } else {
        this->counts.failure = failure;
        this->queue.clear();
        this->queued = 0;
      }
      this->room.notify_all();
    }
  }
};

RecordingWriter::RecordingWriter(const std::string& path, const Ledger& initial, double time_s,
                                 const RecordingOptions& options, const CommandFiles* files) {
  Check(options, path);
  const std::vector<v1::Command> commands = initial.Commands();
  CheckSize(commands, options, path);
  this->Impl_ = std::make_unique<Impl>(path, options);
  this->Impl_->time_s = WithoutMinus0(time_s);
  this->Impl_->files = files;
  for (const v1::Command& command : commands) {
    this->Impl_->EnqueueFiles(command);
  }
  const std::string failure = this->Impl_->TakeSnapshot(initial);
  if (!failure.empty()) {
    throw Error(Error::Kind::Resource, "recording '" + path + "'", failure);
  }
  this->Impl_->thread = std::thread([impl = this->Impl_.get()] { impl->Run(); });
}

RecordingWriter::~RecordingWriter() {
  if (this->Impl_->Forked()) {
    (void)this->Impl_.release(); // its thread and its file are the parent's
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
    this->Impl_->stop = true;
  }
  this->Impl_->news.notify_one();
  this->Impl_->thread.join();
}

std::string RecordingWriter::Add(const v1::Command& accepted, const v1::Reply& reply,
                                 const Ledger& ledger) {
  Impl& impl = *this->Impl_;
  if (impl.Forked()) {
    return std::exchange(impl.told, true) ? std::string() : impl.ForkedError();
  }
  {
    const std::lock_guard<std::mutex> lock(impl.mutex);
    if (!impl.counts.failure.empty()) {
      const std::string failure = impl.told ? std::string() : impl.counts.failure;
      impl.told = true;
      return failure;
    }
  }
  try {
    impl.Put(accepted, reply, ledger);
  } catch (const std::exception& error) { // out of memory, say: what follows is not to be used
    impl.told = true;
    return impl.Fail(std::string("a command could not be stored: ") + error.what());
  }
  return {};
}

std::string RecordingWriter::Flush() {
  Impl& impl = *this->Impl_;
  if (impl.Forked()) {
    return impl.ForkedError();
  }
  std::unique_lock<std::mutex> lock(impl.mutex);
  impl.flush = true;
  impl.news.notify_one();
  impl.room.wait(
      lock, [&impl] { return !impl.counts.failure.empty() || (impl.queue.empty() && impl.idle); });
  impl.flush = false;
  return impl.counts.failure;
}

void RecordingWriter::Resync(const Ledger& ledger, double time_s, const CommandFiles* files) {
  Impl& impl = *this->Impl_;
  if (impl.Forked()) {
    return;
  }
  const std::string number = std::to_string(++impl.seq);
  impl.lost += (impl.lost.empty() ? "" : " ") + number + "-" + number;
  impl.time_s = WithoutMinus0(time_s);
  impl.files = files;
  std::string failure;
  try {
    for (const v1::Command& command : ledger.Commands()) {
      impl.EnqueueFiles(command);
    }
    {
      const std::lock_guard<std::mutex> lock(impl.mutex);
      impl.newLost = impl.lost;
    }
    failure = impl.TakeSnapshot(ledger); // in one transaction with what is lost, or in a later one
  } catch (const std::exception& error) {
    failure = error.what();
  }
  if (!failure.empty()) {
    impl.Fail("after a gap: " + failure);
  }
}

RecordingCounts RecordingWriter::Counts() const {
  if (this->Impl_->Forked()) {
    RecordingCounts none;
    none.failure = this->Impl_->ForkedError();
    return none;
  }
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  return this->Impl_->counts;
}

const std::string& RecordingWriter::Path() const {
  return this->Impl_->path;
}

} // namespace dspace::session
