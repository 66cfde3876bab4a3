// Checksums of the rows of a transaction. Not a public header.
#ifndef DSPACE_SESSION_RECORDINGCHECKSUMS_H
#define DSPACE_SESSION_RECORDINGCHECKSUMS_H

#include <atomic>
#include <cstddef>
#include <deque>
#include <string>
#include <thread>
#include <vector>

#include <dspace/recording/RecordingFile.h>

namespace dspace::session {

// Checksums of a transaction's rows. A thread computes them ahead of the writing, because they take
// a third of the time.
class RecordingChecksums {
public:
  explicit RecordingChecksums(const std::deque<RecordingRow>& rows)
      : Rows_(rows), Sums_(rows.size()) {
    std::size_t bytes = 0;
    for (const RecordingRow& row : rows) {
      bytes += row.payload.size();
    }
    if (bytes >= WorthAThread) {
      this->Thread_ = std::thread([this] {
        for (std::size_t i = 0; i < this->Rows_.size() && !this->Stop_; ++i) {
          this->Sums_[i] = RecordingChecksum(this->Sum_, this->Rows_[i]);
          this->Done_.store(i + 1, std::memory_order_release);
        }
      });
    }
  }
  ~RecordingChecksums() {
    this->Stop_ = true;
    if (this->Thread_.joinable()) {
      this->Thread_.join();
    }
  }
  RecordingChecksums(const RecordingChecksums&) = delete;
  RecordingChecksums& operator=(const RecordingChecksums&) = delete;

  // The checksum of row i. Call it in ascending order.
  const std::string& Of(std::size_t i) {
    if (!this->Thread_.joinable()) {
      this->Sums_[i] = RecordingChecksum(this->Sum_, this->Rows_[i]);
    }
    while (this->Thread_.joinable() && this->Done_.load(std::memory_order_acquire) <= i) {
      std::this_thread::yield(); // a few microseconds, at the beginning at most
    }
    return this->Sums_[i];
  }

private:
  static constexpr std::size_t WorthAThread = 1u << 20;
  const std::deque<RecordingRow>& Rows_;
  Sha256 Sum_;
  std::vector<std::string> Sums_;
  std::atomic<std::size_t> Done_{0};
  std::atomic<bool> Stop_{false};
  std::thread Thread_;
};

} // namespace dspace::session

#endif
