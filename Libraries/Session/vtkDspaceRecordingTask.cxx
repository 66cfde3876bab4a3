#include "vtkDspaceRecordingTask.h"

#include <optional>

#include <unistd.h>

#include "RecordingThread.h"
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

void Put(const dspace::session::ForeignRows& from, dspace::v1::ForeignText* to) {
  to->set_count(from.rows.size());
  for (const std::string& name : from.Names()) {
    to->add_row(name);
  }
}

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
  Put(from.foreign, to->mutable_foreign());
}

} // namespace

struct vtkDspaceRecordingTask::Internals {
  const pid_t process = getpid(); // that has the thread
  dspace::session::RecordingThread thread;
};

vtkDspaceRecordingTask::vtkDspaceRecordingTask() : Impl(std::make_unique<Internals>()) {}

vtkDspaceRecordingTask::~vtkDspaceRecordingTask() {
  if (this->Impl->process != getpid()) {
    (void)this->Impl.release(); // its thread and its files are the parent's
  }
}

void vtkDspaceRecordingTask::BeginCheck(const std::string& path, unsigned long long unpackLimit) {
  this->Impl->thread.Begin([=](RecordingReply& reply, const CancelCheck& checkCancel) {
    RecordingReader reader(path);
    reader.SetUnpackLimit(unpackLimit);
    Put(dspace::session::CheckRecording(reader, checkCancel), reply.mutable_foreign());
  });
}

void vtkDspaceRecordingTask::BeginCut(const std::string& path, const std::string& out,
                                      unsigned long long first, unsigned long long last) {
  this->Impl->thread.Begin([=](RecordingReply& reply, const CancelCheck& checkCancel) {
    RecordingReader reader(path);
    reply.set_number(dspace::session::CutRecording(reader, out, first, last, checkCancel));
  });
}

void vtkDspaceRecordingTask::BeginPack(const std::string& path, const std::string& out) {
  this->Impl->thread.Begin([=](RecordingReply& reply, const CancelCheck& checkCancel) {
    const dspace::session::PackReport report = dspace::session::PackRecording(
        path, out.empty() ? std::nullopt : std::optional<std::string>(out), checkCancel);
    reply.mutable_pack()->set_files(report.files);
    reply.mutable_pack()->set_bytes(report.bytes);
    for (const std::string& each : report.missing) {
      reply.mutable_pack()->add_missing(each);
    }
  });
}

void vtkDspaceRecordingTask::BeginSalvage(const std::string& path, const std::string& out,
                                          unsigned long long unpackLimit) {
  this->Impl->thread.Begin([=](RecordingReply& reply, const CancelCheck& checkCancel) {
    Put(dspace::session::SalvageRecording(path, out, checkCancel, unpackLimit),
        reply.mutable_salvage());
  });
}

bool vtkDspaceRecordingTask::Wait(double seconds) {
  return this->Impl->thread.Wait(seconds);
}

std::string vtkDspaceRecordingTask::TakeReply() {
  return this->Impl->thread.TakeReply();
}

void vtkDspaceRecordingTask::Cancel() {
  this->Impl->thread.End();
}

void vtkDspaceRecordingTask::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Over: " << this->Impl->thread.Wait(0.0) << "\n";
}
