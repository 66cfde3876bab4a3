#include <dspace/recording/RecordingCheckpoints.h>

#include <utility>

#include <sqlite3.h>

namespace dspace::session {
namespace {

constexpr int Most = 4;

} // namespace

RecordingCheckpoints::RecordingCheckpoints(std::string path, int pages)
    : Path_(std::move(path)), Pages_(pages), Thread_([this] { this->Run(); }) {}

RecordingCheckpoints::~RecordingCheckpoints() {
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    this->Stop_ = true;
  }
  this->Changed_.notify_all();
  this->Thread_.join();
}

void RecordingCheckpoints::After(sqlite3* writer, int pagesInLog) {
  std::unique_lock<std::mutex> lock(this->Mutex_);
  if (this->Step_ == Step::Idle && pagesInLog >= this->Pages_) {
    this->Step_ = Step::Asked;
    this->Changed_.notify_all();
  }
  if (pagesInLog >= Most * this->Pages_) { // the disk is behind: it is waited for
    this->Changed_.wait(lock, [this] { return this->Step_ != Step::Asked; });
  }
  if (this->Step_ == Step::Done) {
    this->Step_ = Step::Idle;
    lock.unlock();
    sqlite3_wal_checkpoint_v2(writer, nullptr, SQLITE_CHECKPOINT_PASSIVE, nullptr, nullptr);
  }
}

void RecordingCheckpoints::Run() {
  sqlite3* database = nullptr;
  std::unique_lock<std::mutex> lock(this->Mutex_);
  for (;;) {
    this->Changed_.wait(lock, [this] { return this->Stop_ || this->Step_ == Step::Asked; });
    if (this->Stop_) {
      break;
    }
    lock.unlock();
    if (!database) {
      sqlite3_open_v2(this->Path_.c_str(), &database, SQLITE_OPEN_READWRITE, nullptr);
      sqlite3_exec(database, "PRAGMA synchronous=NORMAL", nullptr, nullptr, nullptr);
    }
    sqlite3_wal_checkpoint_v2(database, nullptr, SQLITE_CHECKPOINT_PASSIVE, nullptr, nullptr);
    lock.lock();
    this->Step_ = Step::Done;
    this->Changed_.notify_all();
  }
  sqlite3_close(database);
}

} // namespace dspace::session
