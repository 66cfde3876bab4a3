#include "vtkDspaceRecorder.h"

#include <utility>

#include <unistd.h>

#include "RecorderThread.h"
#include <dspace/messages/ErrorReply.h>

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkDspaceRecorder);

namespace {

using Lock = std::lock_guard<std::mutex>;

} // namespace

struct vtkDspaceRecorder::Internals : dspace::session::RecorderThread {
  std::string failed;             // the reply that says why there is no connection
  const pid_t process = getpid(); // that has the thread
};

vtkDspaceRecorder::vtkDspaceRecorder() : Impl(new Internals) {}

vtkDspaceRecorder::~vtkDspaceRecorder() {
  if (this->Impl->process != getpid()) {
    (void)this->Impl.release(); // its thread, connection and file are the parent's
    return;
  }
  this->Impl->End();
}

void vtkDspaceRecorder::SetCertificates(const std::string& certificate, const std::string& key,
                                        const std::string& authority) {
  this->Impl->options.security.certificate = certificate;
  this->Impl->options.security.key = key;
  this->Impl->options.security.authority = authority;
}

void vtkDspaceRecorder::SetInsecure(bool insecure) {
  this->Impl->options.security.insecure = insecure;
}

void vtkDspaceRecorder::SetTimeout(double seconds) {
  this->Impl->options.timeout_s = seconds;
}

std::string vtkDspaceRecorder::BeginConnect(const std::string& address, const std::string& name) {
  using dspace::session::Watcher;
  this->Impl->options.address = address;
  this->Impl->options.name = name;
  return dspace::session::Catch([this] {
           this->Impl->watcher =
               std::make_unique<Watcher>(this->Impl->options, Watcher::NonBlocking());
           return dspace::v1::Reply();
         })
      .SerializeAsString();
}

int vtkDspaceRecorder::WaitForConnect(double seconds) {
  bool connected = false;
  const dspace::v1::Reply reply = dspace::session::Catch([&] {
    connected = this->Impl->watcher && this->Impl->watcher->WaitForConnect(seconds);
    return dspace::v1::Reply();
  });
  if (reply.has_error()) {
    this->Impl->watcher.reset();
    this->Impl->failed = reply.SerializeAsString();
    return -1;
  }
  return connected ? 1 : 0;
}

std::string vtkDspaceRecorder::TakeReply() {
  return std::exchange(this->Impl->failed, std::string());
}

void vtkDspaceRecorder::BeginRecord(const std::string& path, double commitEvery, bool pack) {
  Internals& self = *this->Impl;
  if (!self.watcher || self.thread.joinable()) {
    return;
  }
  self.path = path;
  self.commitEvery_s = commitEvery;
  self.pack = pack;
  self.Start();
}

int vtkDspaceRecorder::WaitForRecord(double seconds) {
  Internals& self = *this->Impl;
  self.Wait(seconds, [&self] { return self.recording; });
  const Lock lock(self.mutex);
  return self.recording ? 1 : self.over ? -1 : 0;
}

int vtkDspaceRecorder::WaitFor(long long sequence, double seconds) {
  Internals& self = *this->Impl;
  const auto reached = [&] { return static_cast<long long>(self.sequence) >= sequence; };
  self.Wait(seconds, reached);
  const Lock lock(self.mutex);
  return reached() ? 1 : self.over ? -1 : 0;
}

long long vtkDspaceRecorder::GetSequence() {
  const Lock lock(this->Impl->mutex);
  return static_cast<long long>(this->Impl->sequence);
}

void vtkDspaceRecorder::BeginFlush() {
  const Lock lock(this->Impl->mutex);
  ++this->Impl->flushesWanted;
}

bool vtkDspaceRecorder::WaitForFlush(double seconds) {
  Internals& self = *this->Impl;
  return self.Wait(seconds, [&self] { return self.flushesDone >= self.flushesWanted; });
}

void vtkDspaceRecorder::BeginStop() {
  const Lock lock(this->Impl->mutex);
  this->Impl->ending = true;
}

bool vtkDspaceRecorder::WaitForStop(double seconds) {
  return !this->Impl->thread.joinable() || this->Impl->Wait(seconds, [] { return false; });
}

unsigned long long vtkDspaceRecorder::GetRecordingCount(const std::string& name) {
  const Lock lock(this->Impl->mutex);
  return dspace::session::CountOf(this->Impl->counts, name);
}

std::string vtkDspaceRecorder::GetRecordingFailure() {
  const Lock lock(this->Impl->mutex);
  return this->Impl->counts.failure;
}

std::string vtkDspaceRecorder::GetRecordingMissing() {
  const Lock lock(this->Impl->mutex);
  std::string lines;
  for (const std::string& each : this->Impl->counts.missing) {
    lines += (lines.empty() ? "" : "\n") + each;
  }
  return lines;
}

std::string vtkDspaceRecorder::TakeWarnings() {
  const Lock lock(this->Impl->mutex);
  if (this->Impl->warnings.empty()) {
    return {};
  }
  std::string warning = std::move(this->Impl->warnings.front());
  this->Impl->warnings.pop_front();
  return warning;
}

void vtkDspaceRecorder::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Path: " << this->Impl->path << "\n"
     << indent << "Sequence: " << this->GetSequence() << "\n";
}
