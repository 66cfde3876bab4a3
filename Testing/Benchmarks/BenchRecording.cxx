// How fast commands are recorded, against write(2) of the same bytes at the same durability: both
// have handed everything to the operating system when the clock stops, and neither waits for the
// disk.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <dspace/session/RecordingWriter.h>

namespace {

constexpr int Steps = 1000;
constexpr int Pairs = 7;

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

double Record(const std::string& path, const dspace::v1::Command& step) {
  for (const char* end : {"", "-wal", "-shm"}) {
    std::remove((path + end).c_str());
  }
  const dspace::session::Ledger ledger;
  dspace::session::RecordingWriter writer(path, ledger, 0.0);
  writer.Flush();
  const double begin = Now();
  for (int i = 0; i < Steps; ++i) {
    writer.Add(step, {}, ledger);
  }
  writer.Flush();
  return Now() - begin;
}

double Write(const std::string& path, const dspace::v1::Command& step) {
  std::remove(path.c_str());
  const std::string bytes = step.SerializeAsString();
  const int file = open(path.c_str(), O_WRONLY | O_CREAT, 0644);
  const double begin = Now();
  for (int i = 0; i < Steps; ++i) {
    if (write(file, bytes.data(), bytes.size()) != ssize_t(bytes.size())) {
      std::perror("write");
    }
  }
  const double taken = Now() - begin;
  close(file);
  return taken;
}

} // namespace

int main() {
  const char* folder = std::getenv("TMPDIR");
  const std::string base =
      std::string(folder ? folder : "/tmp") + "/bench_recording_" + std::to_string(getpid());
  for (const int frames : {100, 1000}) {
    const dspace::v1::Command step = Step(frames);
    std::vector<double> ratios;
    double seconds = 0.0;
    for (int i = 0; i <= Pairs; ++i) {
      const double recorded = Record(base + ".dspace", step);
      const double written = Write(base + ".bytes", step);
      if (i > 0) { // the first warms up
        ratios.push_back(written / recorded);
        seconds += recorded / Pairs;
      }
    }
    std::sort(ratios.begin(), ratios.end());
    std::printf("recording %d steps of %d poses: %.2f (%.2f..%.2f) of write(2)'s rate, %d pairs; "
                "%.0f MB/s, %.0f steps/s\n",
                Steps, frames, ratios[ratios.size() / 2], ratios.front(), ratios.back(), Pairs,
                double(step.ByteSizeLong()) * Steps / seconds / 1e6, Steps / seconds);
  }
  for (const char* end : {".dspace", ".dspace-wal", ".dspace-shm", ".bytes"}) {
    std::remove((base + end).c_str());
  }
}
