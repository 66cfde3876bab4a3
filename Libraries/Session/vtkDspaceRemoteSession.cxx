#include "vtkDspaceRemoteSession.h"

#include <deque>
#include <utility>

#include <dspace/link/client/RemoteClient.h>
#include <dspace/messages/ErrorReply.h>

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkDspaceRemoteSession);

struct vtkDspaceRemoteSession::Internals {
  dspace::session::RemoteClientOptions options;
  std::unique_ptr<dspace::session::RemoteClient> client;
  std::deque<std::string> events;
  std::string failed; // what TakeReply says where there is no client to ask

  template<class Work> std::string With(Work work) {
    if (!this->client) {
      return dspace::session::ErrorReply(dspace::v1::Error::IO, "session",
                                         "session: it is not connected")
          .SerializeAsString();
    }
    return dspace::session::Catch([&] { return work(*this->client); }).SerializeAsString();
  }
};

vtkDspaceRemoteSession::vtkDspaceRemoteSession() : Impl(new Internals) {}
vtkDspaceRemoteSession::~vtkDspaceRemoteSession() = default;

void vtkDspaceRemoteSession::SetCertificates(const std::string& certificate, const std::string& key,
                                             const std::string& authority) {
  this->Impl->options.security.certificate = certificate;
  this->Impl->options.security.key = key;
  this->Impl->options.security.authority = authority;
}

void vtkDspaceRemoteSession::SetInsecure(bool insecure) {
  this->Impl->options.security.insecure = insecure;
}

void vtkDspaceRemoteSession::SetTimeout(double seconds) {
  this->Impl->options.timeout_s = seconds;
}

void vtkDspaceRemoteSession::SetTakeOver(bool takeOver) {
  this->Impl->options.takeOver = takeOver;
}

void vtkDspaceRemoteSession::SetOnlyChanges(bool onlyChanges) {
  this->Impl->options.onlyChanges = onlyChanges;
}

std::string vtkDspaceRemoteSession::SetPace(double rate) {
  return dspace::session::Catch([&] {
           if (this->Impl->client) {
             this->Impl->client->SetPace(rate);
           }
           this->Impl->options.pace = rate;
           return dspace::v1::Reply();
         })
      .error()
      .message();
}

std::string vtkDspaceRemoteSession::Connect(const std::string& address, const std::string& name) {
  std::string reply = this->BeginConnect(address, name);
  int state = 0;
  while (this->Impl->client && (state = this->WaitForConnect(1e6)) == 0) {
  }
  return state < 0 ? this->TakeReply() : reply;
}

std::string vtkDspaceRemoteSession::BeginConnect(const std::string& address,
                                                 const std::string& name) {
  using dspace::session::RemoteClient;
  this->Impl->options.address = address;
  this->Impl->options.name = name;
  return dspace::session::Catch([&] {
           this->Impl->client.reset();
           this->Impl->client =
               std::make_unique<RemoteClient>(this->Impl->options, RemoteClient::NonBlocking());
           return dspace::v1::Reply();
         })
      .SerializeAsString();
}

int vtkDspaceRemoteSession::WaitForConnect(double seconds) {
  bool connected = false;
  const std::string reply = this->Impl->With([&](dspace::session::RemoteClient& client) {
    connected = client.WaitForConnect(seconds);
    return dspace::v1::Reply();
  });
  if (!reply.empty()) {
    this->Impl->client.reset();
    this->Impl->failed = reply;
    return -1;
  }
  return connected ? 1 : 0;
}

std::string vtkDspaceRemoteSession::Execute(const std::string& bytes) {
  return this->Impl->With([&](dspace::session::RemoteClient& client) {
    dspace::v1::Command command;
    return command.ParseFromString(bytes) ? client.Execute(std::move(command))
                                          : dspace::session::NotACommand();
  });
}

std::string vtkDspaceRemoteSession::Send(const std::string& bytes) {
  return this->Impl->With([&](dspace::session::RemoteClient& client) {
    dspace::v1::Command command;
    return command.ParseFromString(bytes) ? client.Send(std::move(command))
                                          : dspace::session::NotACommand();
  });
}

std::string vtkDspaceRemoteSession::Flush() {
  return this->Impl->With([](dspace::session::RemoteClient& client) { return client.Flush(); });
}

void vtkDspaceRemoteSession::Begin(const std::string& bytes, bool reply) {
  this->Impl->failed = this->Impl->With([&](dspace::session::RemoteClient& client) {
    dspace::v1::Command command;
    if (!command.ParseFromString(bytes)) {
      return dspace::session::NotACommand();
    }
    client.Begin(std::move(command), reply);
    return dspace::v1::Reply();
  });
}

void vtkDspaceRemoteSession::BeginFlush() {
  this->Impl->failed = this->Impl->With([&](dspace::session::RemoteClient& client) {
    client.BeginFlush();
    return dspace::v1::Reply();
  });
}

bool vtkDspaceRemoteSession::Wait(double seconds) {
  return !this->Impl->failed.empty() || !this->Impl->client || this->Impl->client->Wait(seconds);
}

std::string vtkDspaceRemoteSession::TakeReply() {
  if (!this->Impl->failed.empty()) {
    return std::exchange(this->Impl->failed, std::string());
  }
  return this->Impl->With([](dspace::session::RemoteClient& client) { return client.Take(); });
}

void vtkDspaceRemoteSession::Abandon() {
  this->Impl->failed.clear();
  if (this->Impl->client) {
    this->Impl->client->Abandon();
  }
}

std::string vtkDspaceRemoteSession::TakeEvent(double wait) {
  auto& events = this->Impl->events;
  if (events.empty() && this->Impl->client) {
    this->Impl->client->TakeEvents(
        [&events](const dspace::v1::ViewerEvent& event) {
          events.push_back(event.SerializeAsString());
        },
        wait);
  }
  if (events.empty()) {
    return {};
  }
  const std::string event = std::move(events.front());
  events.pop_front();
  return event;
}

std::string vtkDspaceRemoteSession::GetBroken() {
  return this->Impl->With([](dspace::session::RemoteClient& client) { return client.Broken(); });
}

long long vtkDspaceRemoteSession::GetPosesLeftOut() {
  return this->Impl->client ? static_cast<long long>(this->Impl->client->GetCounts().posesLeftOut)
                            : 0;
}

int vtkDspaceRemoteSession::GetServerCommandSet() {
  return this->Impl->client ? int(this->Impl->client->GetServer().commandSet) : 0;
}

void vtkDspaceRemoteSession::Close() {
  this->Impl->client.reset();
}

void vtkDspaceRemoteSession::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Address: " << this->Impl->options.address << "\n"
     << indent << "Connected: " << (this->Impl->client ? "yes" : "no") << "\n";
}
