// How fast commands are recorded, against write(2) of the same bytes. What is recorded is in the
// operating system's hands when the clock stops, and on disk up to the last checkpoint, one each
// 128 MiB: at the same durability write(2) is followed by fdatasync(2) each 128 MiB. That ratio is
// the one that counts; the one to write(2) alone, which never waits for the disk, stands beside it.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <dspace/recording/RecordingWriter.h>

namespace {

constexpr int Pairs = 7;
constexpr std::size_t Bytes = 400u << 20; // several checkpoints
constexpr std::size_t SyncedBytes = 128u << 20;

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

dspace::v1::Command Step(int frames) {
  dspace::v1::Command command;
  for (int i = 0; i < frames; ++i) {
    command.mutable_set_poses()->add_frame(std::uint64_t(i + 2));
    for (int k = 0; k < 8; ++k) {
      command.mutable_set_poses()->add_pose(std::sin(0.1 * i + k));
    }
  }
  return command;
}

double Record(const std::string& path, const dspace::v1::Command& step, int steps) {
  for (const char* end : {"", "-wal", "-shm"}) {
    std::remove((path + end).c_str());
  }
  const dspace::session::Ledger ledger;
  dspace::session::RecordingWriter writer(path, ledger, 0.0);
  writer.Flush();
  const double begin = Now();
  for (int i = 0; i < steps; ++i) {
    writer.Add(step, {}, ledger);
  }
  writer.Flush();
  const double taken = Now() - begin;
  if (writer.Counts().written != std::uint64_t(steps)) {
    std::fprintf(stderr, "not all was recorded: %s\n", writer.Counts().failure.c_str());
    std::exit(1);
  }
  return taken;
}

double Write(const std::string& path, const dspace::v1::Command& step, int steps, bool sync) {
  std::remove(path.c_str());
  const std::string bytes = step.SerializeAsString();
  const int file = open(path.c_str(), O_WRONLY | O_CREAT, 0644);
  const double begin = Now();
  std::size_t unsynced = 0;
  for (int i = 0; i < steps; ++i) {
    if (write(file, bytes.data(), bytes.size()) != ssize_t(bytes.size())) {
      std::perror("write");
    }
    unsynced += bytes.size();
    if (sync && unsynced >= SyncedBytes) {
      fdatasync(file);
      unsynced = 0;
    }
  }
  const double taken = Now() - begin;
  close(file);
  return taken;
}

std::string Spread(std::vector<double> ratios) {
  std::sort(ratios.begin(), ratios.end());
  char text[80];
  std::snprintf(text, sizeof text, "%.2f (%.2f..%.2f)", ratios[ratios.size() / 2], ratios.front(),
                ratios.back());
  return text;
}

} // namespace

int main() {
  const char* folder = std::getenv("TMPDIR");
  const std::string base =
      std::string(folder ? folder : "/tmp") + "/bench_recording_" + std::to_string(getpid());
  for (const int frames : {100, 1000}) {
    const dspace::v1::Command step = Step(frames);
    const int steps = int(Bytes / step.ByteSizeLong());
    std::vector<double> synced, alone;
    double seconds = 0.0;
    for (int i = 0; i <= Pairs; ++i) {
      const double recorded = Record(base + ".dspace", step, steps);
      const double withSync = Write(base + ".bytes", step, steps, true);
      const double without = Write(base + ".bytes", step, steps, false);
      if (i > 0) { // the first warms up
        synced.push_back(withSync / recorded);
        alone.push_back(without / recorded);
        seconds += recorded / Pairs;
      }
    }
    std::printf(
        "recording %d steps of %d poses: %s of the rate of write(2) with fdatasync each 128 "
        "MiB, %s of write(2) alone, %d pairs; %.0f MB/s, %.0f steps/s\n",
        steps, frames, Spread(synced).c_str(), Spread(alone).c_str(), Pairs,
        double(step.ByteSizeLong()) * steps / seconds / 1e6, steps / seconds);
  }
  for (const char* end : {".dspace", ".dspace-wal", ".dspace-shm", ".bytes"}) {
    std::remove((base + end).c_str());
  }
}
