#include "vtkDspaceRecordingTask.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <unistd.h>

#include "RecordingReplies.h"
#include <dspace/recording/RecordingCheck.h>
#include <dspace/recording/RecordingCut.h>
#include <dspace/recording/RecordingPack.h>
#include <dspace/recording/RecordingSalvage.h>

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkDspaceRecordingTask);

namespace {

using dspace::session::CancelCheck;
using dspace::session::RecordingReader;
using dspace::v1::RecordingReply;

void Put(const dspace::session::SalvageReport& from, dspace::v1::SalvageReport* to) {
  to->set_commands(from.commands);
  to->set_snapshots(from.snapshots);
  to->set_assets(from.assets);
  to->set_last_command(from.lastCommand);
  to->set_last_asset(from.lastAsset);
  to->set_begin(from.begin);
  to->set_begin_lost(from.beginLost);
  for (const auto& [first, last] : from.lost) {
    dspace::v1::RecordedRange* range = to->add_lost();
    range->set_first(first);
    range->set_last(last);
  }
  for (const std::string& path : from.broken) {
    to->add_broken(path);
  }
  to->set_unknown_assets(from.unknownAssets);
}

} // namespace

struct vtkDspaceRecordingTask::Internals {
  using Work = std::function<void(RecordingReply&, const CancelCheck&)>;

  ~Internals() { this->End(); }

  void Begin(Work work) {
    if (this->thread.joinable()) {
      return;
    }
    const auto run = [this, work = std::move(work)] {
      std::string answer = dspace::session::RecordingAnswer([&](RecordingReply& filled) {
        work(filled, [this] {
          if (this->ending) {
            throw dspace::Error(dspace::Error::Kind::Io, "recording", "the work was cancelled");
          }
        });
      });
      const std::lock_guard<std::mutex> lock(this->mutex);
      this->reply = std::move(answer);
      this->over = true;
      this->changed.notify_all();
    };
    const std::lock_guard<std::mutex> lock(this->mutex); // the thread's answer comes after this
    this->reply =
        dspace::session::RecordingAnswer([&](RecordingReply&) { this->thread = std::thread(run); });
    this->over = !this->thread.joinable(); // the system has no thread left, as the reply says
  }

  void End() {
    this->ending = true;
    if (this->thread.joinable()) {
      this->thread.join();
    }
  }

  const pid_t process = getpid(); // that has the thread
  std::thread thread;
  std::atomic<bool> ending{false};
  std::mutex mutex; // of all below
  std::condition_variable changed;
  bool over = false;
  std::string reply;
};

vtkDspaceRecordingTask::vtkDspaceRecordingTask() : Impl(std::make_unique<Internals>()) {}

vtkDspaceRecordingTask::~vtkDspaceRecordingTask() {
  if (this->Impl->process != getpid()) {
    (void)this->Impl.release(); // its thread and its files are the parent's
  }
}

void vtkDspaceRecordingTask::BeginCheck(const std::string& path) {
  this->Impl->Begin([path](RecordingReply&, const CancelCheck& checkCancel) {
    RecordingReader reader(path);
    dspace::session::CheckRecording(reader, checkCancel);
  });
}

void vtkDspaceRecordingTask::BeginCut(const std::string& path, const std::string& out,
                                      unsigned long long first, unsigned long long last) {
  this->Impl->Begin([=](RecordingReply& reply, const CancelCheck& checkCancel) {
    RecordingReader reader(path);
    reply.set_number(dspace::session::CutRecording(reader, out, first, last, checkCancel));
  });
}

void vtkDspaceRecordingTask::BeginPack(const std::string& path, const std::string& out) {
  this->Impl->Begin([=](RecordingReply& reply, const CancelCheck& checkCancel) {
    const dspace::session::PackReport report = dspace::session::PackRecording(
        path, out.empty() ? std::nullopt : std::optional<std::string>(out), checkCancel);
    reply.mutable_pack()->set_files(report.files);
    reply.mutable_pack()->set_bytes(report.bytes);
    for (const std::string& each : report.missing) {
      reply.mutable_pack()->add_missing(each);
    }
  });
}

void vtkDspaceRecordingTask::BeginSalvage(const std::string& path, const std::string& out) {
  this->Impl->Begin([=](RecordingReply& reply, const CancelCheck& checkCancel) {
    Put(dspace::session::SalvageRecording(path, out, checkCancel), reply.mutable_salvage());
  });
}

bool vtkDspaceRecordingTask::Wait(double seconds) {
  Internals& self = *this->Impl;
  std::unique_lock<std::mutex> lock(self.mutex);
  return self.changed.wait_for(lock, std::chrono::duration<double>(std::clamp(seconds, 0.0, 1e6)),
                               [&self] { return self.over || !self.thread.joinable(); });
}

std::string vtkDspaceRecordingTask::TakeReply() {
  const std::lock_guard<std::mutex> lock(this->Impl->mutex);
  return std::exchange(this->Impl->reply, std::string());
}

void vtkDspaceRecordingTask::Cancel() {
  this->Impl->End();
}

void vtkDspaceRecordingTask::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  const std::lock_guard<std::mutex> lock(this->Impl->mutex);
  os << indent << "Over: " << this->Impl->over << "\n";
}
